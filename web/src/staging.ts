// Large arrays on their way to the device, through a buffer that stays mapped between runs. A device may
// allocate memory for each `writeBuffer`, and free it when it is done: for a million points both take
// longer than their ordering.

import type { Buffer, Device, Queue } from './device.js';

/** The fewest bytes that are large, and the most that are kept for them. */
const LEAST_BYTES = 2 ** 16;
const MOST_BYTES = 2 ** 26;

/** MAP_WRITE and COPY_SRC. */
const USAGE = 6;

/** The writes, each of a whole array, and the submissions of a device's queue. */
export class Staging implements Queue {
  readonly queue: Queue;
  #device: Device;
  #buffer: Buffer | undefined;
  /** The memory of the buffer, while it is mapped. */
  #mapped: Uint8Array | undefined;
  #used = 0;
  #copies: [from: Buffer, start: number, to: object, at: number, size: number][] = [];
  /** The large bytes since the last submission, and about the most that one submission had. */
  #wanted = 0;
  #most = 0;

  constructor(device: Device) {
    this.queue = device.queue;
    this.#device = device;
  }

  writeBuffer(to: object, at: number, bytes: Uint8Array): void {
    const size = bytes.length;
    if (size >= LEAST_BYTES) {
      this.#wanted += size;
      if (this.#mapped && this.#used + size <= this.#mapped.length) {
        this.#mapped.set(bytes, this.#used);
        this.#copies.push([this.#buffer!, this.#used, to, at, size]);
        this.#used += size;
        return;
      }
    }
    this.#flush();
    this.queue.writeBuffer(to, at, bytes, 0, size);
  }

  submit(commands: object[]): void {
    this.#flush();
    this.queue.submit(commands);
    const wanted = Math.min(this.#wanted, MOST_BYTES);
    this.#wanted = 0;
    if (wanted <= (this.#buffer?.size ?? 0)) return;
    // A single run would gain nothing, and most of its submissions write less than its first.
    if (this.#most > 0 && 2 * wanted > this.#most) this.#allocate(wanted);
    this.#most = Math.max(wanted, this.#most / 2);
  }

  /** Frees the buffer. */
  end(): void {
    this.#mapped = undefined;
    this.#buffer?.destroy();
  }

  /** Submits what was written, which comes before what is written or submitted next. */
  #flush(): void {
    if (this.#copies.length === 0) return;
    this.#mapped = undefined;
    this.#buffer!.unmap();
    const encoder = this.#device.createCommandEncoder();
    for (const copy of this.#copies) encoder.copyBufferToBuffer(...copy);
    this.queue.submit([encoder.finish()]);
    this.#copies = [];
    this.#map(this.#buffer!);
  }

  #allocate(size: number): void {
    this.end();
    // Nothing fails if there is no memory for it.
    for (const filter of ['validation', 'out-of-memory']) this.#device.pushErrorScope(filter);
    this.#buffer = this.#device.createBuffer({ size, usage: USAGE });
    this.#map(this.#buffer);
    for (let i = 0; i < 2; i++) this.#device.popErrorScope().catch(() => null);
  }

  #map(buffer: Buffer): void {
    buffer.mapAsync(2).then(
      () => {
        if (buffer !== this.#buffer) return;
        this.#mapped = new Uint8Array(buffer.getMappedRange());
        this.#used = 0;
      },
      // The device is lost, or has no memory.
      () => {},
    );
  }
}
