// Converts points of any form to one typed array that nobody else uses.

import { GdelError } from './errors.js';
import { throwIfAborted } from './host.js';
import type { Coordinates } from './protocol.js';

/** The largest number of points that can be triangulated. */
const MAX_POINTS = 2 ** 27;

/** How long a conversion or a copy may block the thread before it yields. */
const SLICE_MILLISECONDS = 8;

/** Longer arrays are copied in slices of this length. */
const SLICE_LENGTH = 2 ** 18;

export interface Own {
  coordinates: Coordinates;
  transfer: ArrayBuffer[];
}

interface Conversion {
  dimension: number;
  transfer: boolean;
  point: ((item: any, index: number) => ArrayLike<number>) | undefined;
  signal: AbortSignal | undefined;
}

/** Returns the coordinates as an array that nobody else uses. */
export function ownCoordinates(points: unknown, conversion: Conversion): Own | Promise<Own> {
  const { dimension, transfer, point } = conversion;
  if ((points instanceof Float32Array || points instanceof Float64Array) && !point) {
    checkTyped(points, dimension);
    if (transfer && points.buffer instanceof ArrayBuffer) return own(moved(points));
    return points.length <= SLICE_LENGTH ? own(points.slice()) : copied(points, conversion.signal);
  }
  if (ArrayBuffer.isView(points) && !point) {
    throw new GdelError(
      'BAD_INPUT',
      `points in one typed array must be a Float32Array or a Float64Array, not ${nameOf(points)}`,
    );
  }
  if (!isArrayLike(points)) {
    throw new GdelError(
      'BAD_INPUT',
      `points must be a typed array or an array of rows, not ${nameOf(points)}`,
    );
  }
  checkCount(points.length);
  return fromRows(points, conversion);
}

function own(coordinates: Coordinates): Own {
  return { coordinates, transfer: [coordinates.buffer as ArrayBuffer] };
}

/** Takes the array's buffer from the caller. */
function moved(points: Coordinates): Coordinates {
  return structuredClone(points, { transfer: [points.buffer as ArrayBuffer] });
}

/** Copies in slices, yielding in between: fresh memory alone takes 10 ms for a million points. */
async function copied(points: Coordinates, signal: AbortSignal | undefined): Promise<Own> {
  const { length } = points;
  const copy = points instanceof Float32Array ? new Float32Array(length) : new Float64Array(length);
  let since = performance.now();
  for (let at = 0; at < length; at += SLICE_LENGTH) {
    if (performance.now() - since > SLICE_MILLISECONDS) {
      await yieldToEvents();
      throwIfAborted(signal);
      since = performance.now();
    }
    if (points.length !== length)
      throw new GdelError('BAD_INPUT', 'the buffer of the points was detached while it was copied');
    copy.set(points.subarray(at, at + SLICE_LENGTH), at);
  }
  return own(copy);
}

function checkTyped(points: Coordinates, dimension: number): void {
  try {
    // Throws if the buffer is detached. Its length would be 0, as of no points.
    new Uint8Array(points.buffer);
  } catch {
    throw new GdelError(
      'BAD_INPUT',
      'the buffer of the points is detached, because it was transferred',
    );
  }
  if (points.length % dimension !== 0) {
    throw new GdelError(
      'BAD_INPUT',
      `${points.length} coordinates are not a whole number of points: the length must be a multiple of ${dimension}`,
    );
  }
  checkCount(points.length / dimension);
}

export function checkCount(count: number): void {
  if (count > MAX_POINTS) {
    throw new GdelError(
      'TOO_MANY_POINTS',
      `${count} points are too many: at most ${MAX_POINTS} can be triangulated`,
    );
  }
}

async function fromRows(
  rows: ArrayLike<unknown>,
  { dimension, point, signal }: Conversion,
): Promise<Own> {
  let coordinates: Float64Array;
  try {
    coordinates = new Float64Array(dimension * rows.length);
  } catch (cause) {
    throw new GdelError('OUT_OF_MEMORY', `there is not enough memory for ${rows.length} points`, {
      cause,
    });
  }
  let since = performance.now();
  for (let i = 0; i < rows.length; i++) {
    if (i % 4096 === 4095 && performance.now() - since > SLICE_MILLISECONDS) {
      await yieldToEvents();
      throwIfAborted(signal);
      since = performance.now();
    }
    const row = point ? point(rows[i], i) : rows[i];
    if (!isArrayLike(row) || row.length < dimension) {
      throw new GdelError(
        'BAD_INPUT',
        `point ${i} is ${nameOf(row)}, not an array of ${dimension} numbers`,
        { index: i },
      );
    }
    for (let axis = 0; axis < dimension; axis++) {
      const value = row[axis];
      if (typeof value !== 'number') {
        throw new GdelError(
          'BAD_INPUT',
          `point ${i}: coordinate ${axis} is ${nameOf(value)}, not a number`,
          { index: i },
        );
      }
      coordinates[dimension * i + axis] = value;
    }
  }
  return own(coordinates);
}

/** Yields to waiting events. Continues sooner than a timer, which browsers delay. */
function yieldToEvents(): Promise<void> {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resolve();
    };
    port2.postMessage(null);
  });
}

function isArrayLike(value: unknown): value is ArrayLike<unknown> {
  if (typeof value !== 'object' || value === null) return false;
  const { length } = value as { length?: unknown };
  return typeof length === 'number' && Number.isInteger(length) && length >= 0;
}

export function nameOf(value: unknown): string {
  if (typeof value === 'object' && value !== null) {
    const length = isArrayLike(value) ? ` of length ${value.length}` : '';
    return `${value.constructor?.name ?? 'an object'}${length}`;
  }
  return typeof value === 'string' ? JSON.stringify(value.slice(0, 40)) : String(value);
}
