// What the thread that has the device sends to the worker that has the points.

import type { Coordinates, Indices } from './arrays.js';
import type { Buffer, Queue } from './device.js';
import type { Helper } from './protocol.js';
import { Slice, STEP_BYTES } from './slices.js';

/** Writes an array to a buffer of the device, giving way to other events after each slice. */
export async function writeInSlices(
  buffer: Buffer,
  array: ArrayBufferView,
  queue: Queue,
): Promise<void> {
  const slice = new Slice();
  const { byteOffset, byteLength } = array;
  for (let at = 0; at < byteLength; at += STEP_BYTES) {
    if (slice.isOver) await slice.next();
    const size = Math.min(STEP_BYTES, byteLength - at);
    queue.writeBuffer(buffer, at, new Uint8Array(array.buffer, byteOffset + at, size), 0, size);
  }
}

/** Carries the requests of one run to a worker. */
export class PointCarrier {
  readonly pointCount: number;
  /** The coordinates: here, except while the worker copies them. */
  points: Coordinates;
  /** Why the worker did not answer. */
  failure: unknown;
  readonly #helper: Helper;
  readonly #queue: () => Queue;
  #slice = new Slice();

  /** The device's queue is asked for when there is something to write. */
  constructor(points: Coordinates, dimension: number, helper: Helper, queue: () => Queue) {
    this.points = points;
    this.pointCount = points.length / dimension;
    this.#helper = helper;
    this.#queue = queue;
  }

  /** Does something while the worker has a copy of the points. */
  async use<R>(work: () => Promise<R>): Promise<R> {
    await this.#ask('begin', { points: this.points }, [this.points.buffer]).then(({ points }) => {
      this.points = points;
    });
    this.#slice = new Slice();
    try {
      return await work();
    } finally {
      if (!this.failure) await this.#ask('end', {}, []);
    }
  }

  async send(kind: number, request: Indices[]): Promise<Indices[]> {
    const transfer = request.map(({ buffer }) => buffer);
    const { answer } = await this.#ask('answer', { kind, request }, transfer);
    this.#slice = new Slice();
    return answer;
  }

  async upload(buffer: Buffer): Promise<void> {
    await writeInSlices(buffer, this.points, this.#queue());
    this.#slice = new Slice();
  }

  /** Returns a promise if the thread has been busy for long. */
  pause(): Promise<void> | undefined {
    return this.#slice.isOver ? this.#slice.next() : undefined;
  }

  readonly #ask: Helper['run'] = async (...task) => {
    try {
      return await this.#helper.run(...task);
    } catch (error) {
      this.failure = error;
      throw error;
    }
  };
}
