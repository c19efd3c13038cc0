// Buffers of the caller's device: points that come from it, and meshes that stay on it.

import type { Buffer, Device } from './device.js';
import { GdelError } from './errors.js';
import type { Done, MadeResident, Task } from './protocol.js';
import { copyInSlices } from './slices.js';

/** Returns whether a value works as a `GPUBuffer`. */
export function isBuffer(value: unknown): value is Buffer {
  return typeof (value as Buffer | undefined)?.mapAsync === 'function';
}

/** The bytes of a piece: copying them takes few milliseconds. */
const PIECE_BYTES = 2 ** 23;

/** The pieces that are on their way at a time: one is copied while the device sends the others. */
const PIECES_AHEAD = 4;

/** Buffers for pieces that are not in use. Fresh ones take longer than what they carry. */
const idle = new WeakMap<Device, Buffer[]>();

/** A piece that is on its way. */
interface Piece {
  at: number;
  size: number;
  staging: Buffer;
  mapped: Promise<void>;
}

/** Copies bytes of a buffer to the start of another one. */
function submitCopy(device: Device, from: Buffer, at: number, to: Buffer, size: number): void {
  const encoder = device.createCommandEncoder();
  encoder.copyBufferToBuffer(from, at, to, 0, size);
  device.queue.submit([encoder.finish()]);
}

/** Returns what `work` does once the device has no objections to the copies in it. */
async function checked<R>(device: Device, work: () => R): Promise<R> {
  device.pushErrorScope('validation');
  const result = work();
  const error = await device.popErrorScope();
  if (error) throw new GdelError('BAD_INPUT', `the buffer cannot be copied: ${error.message}`);
  return result;
}

/** Sends a piece of a buffer on its way. */
function send(device: Device, source: Buffer, at: number, size: number): Piece {
  const isWhole = size === PIECE_BYTES;
  // MAP_READ and COPY_DST.
  const staging = (isWhole && idle.get(device)?.pop()) || device.createBuffer({ size, usage: 9 });
  submitCopy(device, source, at, staging, size);
  const mapped = staging.mapAsync(1);
  // It is not awaited where an earlier piece has failed.
  mapped.catch(() => {});
  return { at, size, staging, mapped };
}

/**
 * Copies the first bytes of a buffer, of the usage `COPY_SRC`, into what `take` returns. The buffer must not
 * change until that is done.
 */
export async function bytesOf(
  device: Device,
  source: Buffer,
  size: number,
  take = (bytes: number): Uint8Array<ArrayBuffer> => new Uint8Array(bytes),
): Promise<Uint8Array<ArrayBuffer>> {
  const pieces: Piece[] = [];
  let sent = 0;
  const sendMore = () => {
    while (pieces.length < PIECES_AHEAD && sent < size) {
      const piece = send(device, source, sent, Math.min(PIECE_BYTES, size - sent));
      pieces.push(piece);
      sent += piece.size;
    }
  };
  try {
    await checked(device, sendMore);
    const bytes = take(size);
    for (let piece = pieces[0]; piece; piece = pieces[0]) {
      await piece.mapped;
      const { at, size, staging } = piece;
      await copyInSlices(staging.getMappedRange(), bytes.subarray(at, at + size));
      pieces.shift();
      staging.unmap();
      keep(device, staging);
      sendMore();
    }
    return bytes;
  } catch (error) {
    if (error instanceof GdelError) throw error;
    throw new GdelError('DEVICE_LOST', `a buffer could not be read: ${String(error)}`);
  } finally {
    for (const { staging } of pieces) staging.destroy();
  }
}

/** Keeps a buffer for later pieces, if it is large enough and there are few. */
function keep(device: Device, staging: Buffer): void {
  const buffers = idle.get(device) ?? [];
  idle.set(device, buffers);
  if (staging.size === PIECE_BYTES && buffers.length < 2 * PIECES_AHEAD) buffers.push(staging);
  else staging.destroy();
}

/** Does the same as {@link bytesOf} with a buffer that may change afterwards. */
export async function bytesNow(device: Device, source: Buffer): Promise<Uint8Array<ArrayBuffer>> {
  const { size } = source;
  const copy = await checked(device, () => {
    // COPY_SRC and COPY_DST.
    const copy = device.createBuffer({ size, usage: 12 });
    submitCopy(device, source, 0, copy, size);
    return copy;
  });
  try {
    return await bytesOf(device, copy, size);
  } finally {
    copy.destroy();
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
