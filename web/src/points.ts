// From the forms in which points come to one typed array of one's own.

import { GdelError } from './errors.js';
import { throwIfAborted } from './host.js';
import type { Coordinates } from './protocol.js';

/** The most points that the engines can number. */
const MOST_POINTS = 2 ** 27;

/** How long a conversion or a copy may keep the thread before it lets others have it. */
const SLICE_MILLISECONDS = 8;

/** Longer arrays are copied in slices of this length. */
const COPIED_AT_ONCE = 2 ** 18;

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

/** The coordinates as an array that belongs to nobody else. */
export function ownCoordinates(points: unknown, conversion: Conversion): Own | Promise<Own> {
  const { dimension, transfer, point } = conversion;
  if ((points instanceof Float32Array || points instanceof Float64Array) && !point) {
    checkTyped(points, dimension);
    if (transfer && points.buffer instanceof ArrayBuffer) return own(moved(points));
    return points.length <= COPIED_AT_ONCE
      ? own(points.slice())
      : copied(points, conversion.signal);
  }
  if (ArrayBuffer.isView(points) && !point) {
    throw new GdelError(
      'BAD_INPUT',
      `points in one typed array are a Float32Array or a Float64Array, not ${nameOf(points)}`,
    );
  }
  if (!isArrayLike(points)) {
    throw new GdelError(
      'BAD_INPUT',
      `points are a typed array or an array of rows, not ${nameOf(points)}`,
    );
  }
  checkCount(points.length);
  return fromRows(points, conversion);
}

function own(coordinates: Coordinates): Own {
  return { coordinates, transfer: [coordinates.buffer as ArrayBuffer] };
}

/** The array itself, taken away from the caller. */
function moved(points: Coordinates): Coordinates {
  return structuredClone(points, { transfer: [points.buffer as ArrayBuffer] });
}

/** A copy that lets others have the thread in between: fresh memory alone takes 10 ms for a million points. */
async function copied(points: Coordinates, signal: AbortSignal | undefined): Promise<Own> {
  const { length } = points;
  const copy = points instanceof Float32Array ? new Float32Array(length) : new Float64Array(length);
  let since = performance.now();
  for (let at = 0; at < length; at += COPIED_AT_ONCE) {
    if (performance.now() - since > SLICE_MILLISECONDS) {
      await othersTurn();
      throwIfAborted(signal);
      since = performance.now();
    }
    if (points.length !== length)
      throw new GdelError('BAD_INPUT', 'the points’ buffer was detached while it was copied');
    copy.set(points.subarray(at, at + COPIED_AT_ONCE), at);
  }
  return own(copy);
}

function checkTyped(points: Coordinates, dimension: number): void {
  try {
    // Throws if the buffer was detached, which then has no length left to tell.
    new Uint8Array(points.buffer);
  } catch {
    throw new GdelError(
      'BAD_INPUT',
      'the points’ buffer is detached: it was transferred to someone else',
    );
  }
  if (points.length % dimension !== 0) {
    throw new GdelError(
      'BAD_INPUT',
      `${points.length} coordinates are not a multiple of ${dimension}`,
    );
  }
  checkCount(points.length / dimension);
}

export function checkCount(count: number): void {
  if (count > MOST_POINTS) {
    throw new GdelError(
      'TOO_MANY_POINTS',
      `${count} points are too many: at most ${MOST_POINTS} can be numbered`,
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
    throw new GdelError('OUT_OF_MEMORY', `there is no room for ${rows.length} points`, { cause });
  }
  let since = performance.now();
  for (let i = 0; i < rows.length; i++) {
    if (i % 4096 === 4095 && performance.now() - since > SLICE_MILLISECONDS) {
      await othersTurn();
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

/** Lets waiting events be handled: sooner than a timer, which browsers hold back. */
function othersTurn(): Promise<void> {
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
