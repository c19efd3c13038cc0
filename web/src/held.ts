// Buffers of the caller's device: points that come from it, and meshes that stay on it.

import type { Buffer, Device } from './device.js';
import { GdelError } from './errors.js';
import type { Done, MadeResident, Task } from './protocol.js';
import { copyInSlices } from './slices.js';

/** Returns whether a value works as a `GPUBuffer`. */
export function isBuffer(value: unknown): value is Buffer {
  return typeof (value as Buffer | undefined)?.mapAsync === 'function';
}

/**
 * Copies the first bytes of a buffer, of the usage `COPY_SRC`, as they are when this is called, into
 * what `take` returns.
 */
export async function bytesOf(
  device: Device,
  source: Buffer,
  size: number,
  take = (bytes: number): Uint8Array<ArrayBuffer> => new Uint8Array(bytes),
): Promise<Uint8Array<ArrayBuffer>> {
  device.pushErrorScope('validation');
  // MAP_READ and COPY_DST.
  const staging = device.createBuffer({ size, usage: 9 });
  const encoder = device.createCommandEncoder();
  encoder.copyBufferToBuffer(source, 0, staging, 0, size);
  device.queue.submit([encoder.finish()]);
  const error = await device.popErrorScope();
  if (error) throw new GdelError('BAD_INPUT', `the buffer cannot be copied: ${error.message}`);
  try {
    await staging.mapAsync(1);
    const bytes = take(size);
    await copyInSlices(staging.getMappedRange(), bytes);
    return bytes;
  } catch (error) {
    throw new GdelError('DEVICE_LOST', `a buffer could not be read: ${String(error)}`);
  } finally {
    staging.destroy();
  }
}

/** A mesh on the device that lasts until nobody needs it: runs and readers, too. */
export class Held {
  readonly resident: MadeResident;
  readonly #free: Done<Task>['free'];
  readonly device: Device;
  #users = 1;

  constructor({ result, free }: Done<Task>, device: Device) {
    this.resident = result.resident!;
    this.#free = free;
    this.device = device;
  }

  /** Does something with the mesh, which lasts until that is done. */
  async use<R>(work: () => Promise<R>): Promise<R> {
    this.#users++;
    try {
      return await work();
    } finally {
      this.release();
    }
  }

  /** Says that its owner does not need it any more. */
  release(): void {
    if (--this.#users > 0) return;
    for (const buffer of this.resident.buffers) buffer.destroy();
    // Dawn frees the memory at the next submission, which takes 3 ms for a million points.
    this.device.queue.submit([]);
    this.#free!(this.resident.key);
  }
}
