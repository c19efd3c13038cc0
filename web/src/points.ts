// Converts points of any form to one typed array that nobody else uses.

import { type Coordinates, inThisRealm, isArrayBuffer, isDetached, kindOf } from './arrays.js';
import { GdelError } from './errors.js';
import { bad, nameOf } from './options.js';
import { Slice } from './slices.js';
import { throwIfAborted } from './stop.js';
import type { AccessorOptions, Points, TaskOptions } from './types.js';

/** The largest number of points that can be triangulated. */
const MAX_POINTS = 2 ** 27;

/** The number of coordinates after which a conversion or a copy can yield. */
const SLICE_LENGTH = 2 ** 18;

/** The same for rows and plain arrays, which take longer. */
const SLICE_ROWS = 2 ** 12;

interface Conversion {
  dimension: number;
  /** Whether to take the buffer of the caller's array. */
  transfer: boolean;
  point: ((item: any, index: number) => ArrayLike<number>) | undefined;
}

/** Returns the coordinates, without giving way to other events. */
export function coordinatesNow(points: unknown, conversion: Conversion): Coordinates {
  const steps = conversionOf(points, conversion);
  for (;;) {
    const { done, value } = steps.next();
    if (done) return value;
  }
}

/**
 * Returns the coordinates, giving way to other events after each slice. What is small is
 * copied before this returns.
 */
export async function coordinatesInSlices(
  points: unknown,
  conversion: Conversion,
  throwIfAborted: () => void,
): Promise<Coordinates> {
  const steps = conversionOf(points, conversion);
  const slice = new Slice();
  for (;;) {
    const { done, value } = steps.next();
    if (done) return value;
    if (!slice.isOver) continue;
    await slice.next();
    throwIfAborted();
  }
}

/** Returns a copy of points, which nobody else uses. */
export function copyOf(
  points: Points | ArrayLike<unknown>,
  dimension: number,
  { signal, point }: TaskOptions & { point?: AccessorOptions<unknown>['point'] | undefined },
): Promise<Coordinates> {
  const conversion = { dimension, transfer: false, point };
  return coordinatesInSlices(points, conversion, () => throwIfAborted(signal));
}

/** Returns the factors of the axes that an option asks for. */
export function factorsOf(
  rescale: unknown,
  points: Coordinates,
  dimension: number,
): readonly number[] | undefined {
  if (rescale === undefined || rescale === false) return undefined;
  if (rescale === true) {
    return Array.from({ length: dimension }, (_, axis) => {
      let [low, high] = [Infinity, -Infinity];
      for (let i = axis; i < points.length; i += dimension) {
        low = Math.min(low, points[i]!);
        high = Math.max(high, points[i]!);
      }
      return high > low ? 1 / (high - low) : 1;
    });
  }
  const isFactor = (x: unknown) => typeof x === 'number' && x > 0 && x < Infinity;
  if (!Array.isArray(rescale) || rescale.length !== dimension || !rescale.every(isFactor))
    throw bad('the option rescale', `true, false or ${dimension} positive numbers`, rescale);
  return [...rescale];
}

/** Returns points, multiplied by factors if there are any. */
export const scaled = (points: Coordinates, factors: readonly number[] | undefined): Coordinates =>
  factors ? Float64Array.from(points, (x, i) => x * factors[i % factors.length]!) : points;

/** Converts in steps, between which other events can be handled. */
type Steps = Generator<void, Coordinates, void>;

/** Returns the conversion for this form of points. */
function conversionOf(points: unknown, { dimension, transfer, point }: Conversion): Steps {
  if (!point) {
    const kind = kindOf(points);
    if (kind !== undefined) {
      const array = inThisRealm(points as Coordinates);
      checkTyped(array, dimension);
      const canMove =
        transfer &&
        isFloat(array) &&
        isArrayBuffer(array.buffer) &&
        typeof structuredClone === 'function';
      return canMove ? moved(array) : copied(array, kind);
    }
    if (ArrayBuffer.isView(points)) throw bad('points', 'an array', points);
  }
  if (!isArrayLike(points))
    throw bad('points', 'a typed array, or an array of rows or numbers', points);
  if (!point && points.length > 0 && typeof points[0] === 'number') {
    checkWhole(points.length, dimension);
    checkCount(points.length / dimension);
    return fromNumbers(points, dimension);
  }
  checkCount(points.length);
  return fromRows(points, dimension, point);
}

const isFloat = (array: unknown): array is Coordinates =>
  array instanceof Float32Array || array instanceof Float64Array;

/** Takes the array's buffer from the caller. */
// biome-ignore lint/correctness/useYield: this takes one step.
function* moved(points: Coordinates): Steps {
  try {
    return inThisRealm(structuredClone(points, { transfer: [points.buffer] }));
  } catch (cause) {
    throw new GdelError('BAD_INPUT', 'the buffer of the points cannot be transferred', { cause });
  }
}

/** The classes to which others are converted without loss. Those that are missing have none. */
const CONVERTED: Readonly<Record<string, new (length: number) => Coordinates>> = {
  Float32Array,
  Float64Array,
  Float16Array: Float32Array,
  Int8Array: Float32Array,
  Uint8Array: Float32Array,
  Uint8ClampedArray: Float32Array,
  Int16Array: Float32Array,
  Uint16Array: Float32Array,
  Int32Array: Float64Array,
  Uint32Array: Float64Array,
};

/** Copies in slices: fresh memory alone takes 10 ms for a million points. */
function* copied(points: Coordinates, kind: string): Steps {
  const Class = CONVERTED[kind];
  if (!Class) throw bad('points in a typed array', 'numbers', points);
  const { length } = points;
  const copy = allocate(Class, length);
  for (let at = 0; at < length; at += SLICE_LENGTH) {
    if (at > 0) yield;
    if (points.length !== length)
      throw new GdelError('BAD_INPUT', 'the buffer of the points was detached while it was copied');
    copy.set(points.subarray(at, at + SLICE_LENGTH), at);
  }
  return copy;
}

function checkTyped(points: Coordinates, dimension: number): void {
  // Its length would be 0, as of no points.
  if (isDetached(points)) {
    throw new GdelError(
      'BAD_INPUT',
      'the buffer of the points is detached, because it was transferred',
    );
  }
  checkWhole(points.length, dimension);
  checkCount(points.length / dimension);
}

function checkWhole(length: number, dimension: number): void {
  if (length % dimension !== 0) {
    throw new GdelError(
      'BAD_INPUT',
      `${length} coordinates are not a whole number of points: the length must be a multiple of ${dimension}`,
    );
  }
}

export function checkCount(count: number): void {
  if (count > MAX_POINTS) {
    throw new GdelError(
      'TOO_MANY_POINTS',
      `${count} points are too many: at most ${MAX_POINTS} can be triangulated`,
    );
  }
}

/** Returns an array of zeros, or throws that memory does not suffice. */
function allocate<T>(Class: new (length: number) => T, length: number): T {
  try {
    return new Class(length);
  } catch (cause) {
    throw new GdelError('OUT_OF_MEMORY', `there is not enough memory for ${length} coordinates`, {
      cause,
    });
  }
}

function* fromNumbers(numbers: ArrayLike<unknown>, dimension: number): Steps {
  const { length } = numbers;
  const coordinates = allocate(Float64Array, length);
  for (let i = 0; i < length; i++) {
    if (i % SLICE_ROWS === SLICE_ROWS - 1) yield;
    const value = numbers[i];
    if (typeof value !== 'number') {
      const index = Math.floor(i / dimension);
      throw new GdelError(
        'BAD_INPUT',
        `coordinate ${i}, of point ${index}, is ${nameOf(value)}, not a number`,
        { index },
      );
    }
    coordinates[i] = value;
  }
  return coordinates;
}

function* fromRows(rows: ArrayLike<unknown>, dimension: number, point: Conversion['point']): Steps {
  const { length } = rows;
  const coordinates = allocate(Float64Array, dimension * length);
  for (let i = 0; i < length; i++) {
    if (i % SLICE_ROWS === SLICE_ROWS - 1) yield;
    const row: unknown = point ? point(rows[i], i) : rows[i];
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
  return coordinates;
}

function isArrayLike(value: unknown): value is ArrayLike<unknown> {
  if (typeof value !== 'object' || value === null) return false;
  const { length } = value as { length?: unknown };
  return typeof length === 'number' && Number.isInteger(length) && length >= 0;
}
