// The interface of the npm package delaunator, on the CPU backend in the calling thread.

import { type Coordinates, inThisRealm, isDetached, kindOf } from './arrays.js';
import { GdelError } from './errors.js';
import { nameOf, objectOf } from './options.js';
import { checkCount } from './points.js';
import { startOf } from './start.js';
import { load2d, triangulate2dNow } from './sync.js';

/**
 * A 2D Delaunay triangulation with the interface of the npm package `delaunator`: synchronous, in
 * the calling thread, with the CPU backend. The result is exact, and the same as that of
 * `delaunay2d`, which does not block and is therefore better for large inputs on a page.
 *
 * ```js
 * import { Delaunator } from 'gdel-wasm/delaunator';
 * await Delaunator.load(); // once
 * const { triangles, halfedges, hull } = new Delaunator(coords);
 * ```
 *
 * @typeParam T The type of the coordinate array.
 */
export class Delaunator<T extends ArrayLike<number> = Float64Array> {
  /** The coordinates x, y, x, y, …: the array that was passed, not a copy. */
  readonly coords: T;
  /**
   * Three vertices per triangle, counter-clockwise if the y axis points down: det(b − a, c − a) <
   * 0. No triangle is flat.
   */
  triangles!: Uint32Array;
  /**
   * Three per triangle: the opposite of the half-edge from vertex *k* to the next one, or −1 on the
   * hull.
   */
  halfedges!: Int32Array;
  /**
   * The vertices on the convex hull, including those in the middle of its edges, in the orientation
   * of the triangles, beginning where delaunator does. If all points are collinear: the distinct
   * points, sorted by x and then by y.
   */
  hull!: Uint32Array;
  /**
   * One per point: −1, or the lowest index of a point with the same coordinates, which represents
   * this one in the mesh.
   */
  duplicateOf!: Int32Array;
  /**
   * The affine dimension of the points: 2, or 1 if they are collinear, or 0 if they are coincident
   * or there are none. Below 2 there are no triangles.
   */
  dimension!: 0 | 1 | 2;

  /** Loads the WebAssembly module that the constructor needs. Later calls do nothing. */
  static load(): Promise<void> {
    return load2d();
  }

  /** Triangulates points of any form, `[x, y]` by default. */
  static from<P>(
    points: ArrayLike<P>,
    getX: (point: P) => number = (point) => (point as ArrayLike<number>)[0]!,
    getY: (point: P) => number = (point) => (point as ArrayLike<number>)[1]!,
  ): Delaunator<Float64Array> {
    const length = lengthOf('points', points);
    checkCount(length);
    const coords = new Float64Array(2 * length);
    for (let i = 0; i < length; i++) {
      coords[2 * i] = getX(points[i]!);
      coords[2 * i + 1] = getY(points[i]!);
    }
    return triangulated(coords);
  }

  /**
   * Triangulates `coords`.
   *
   * @throws {@link GdelError} `NOT_LOADED` before {@link Delaunator.load} is done, `NOT_FINITE`,
   * `BAD_INPUT`, `TOO_MANY_POINTS`, `OUT_OF_MEMORY`.
   */
  constructor(coords: T) {
    this.coords = coords;
    this.update();
  }

  /** Triangulates again after the values in {@link coords} were changed. */
  update(): void {
    const coordinates = numbers(this.coords);
    const { triangles, halfedges, hull, duplicateOf, dimension } = triangulate2dNow(coordinates);
    const start = dimension < 2 ? undefined : startOf(coordinates, duplicateOf);
    if (start) {
      const { seed, last } = start;
      // delaunator begins with the vertex before its last one. A triangle alone is the seed.
      const second = last < 0 ? seed[1] : last;
      startAt(hull, hull.indexOf(second) - 1);
      if (triangles.length === 3) startAt(triangles, triangles.indexOf(seed[0]));
    }
    Object.assign(this, { triangles, halfedges, hull, duplicateOf, dimension });
  }

  /** The length of {@link triangles}. */
  get trianglesLen(): number {
    return this.triangles.length;
  }
}

export default Delaunator;

/** Not in the class: a class that names itself is renamed when it is bundled. */
function triangulated(coords: Float64Array): Delaunator<Float64Array> {
  return new Delaunator(coords);
}

export { GdelError, type GdelErrorCode } from './errors.js';

/** Lets a cyclic array start at an index, which may be −1 for the last one; −2 changes nothing. */
function startAt(array: Uint32Array, index: number): void {
  if (index < -1) return;
  const start = (index + array.length) % array.length;
  const before = array.slice(0, start);
  array.copyWithin(0, start);
  array.set(before, array.length - start);
}

function lengthOf(what: string, array: ArrayLike<unknown>): number {
  const { length } = objectOf(what, array);
  // The words of what delaunator throws here.
  if (!Number.isInteger(length) || length < 0)
    throw new GdelError('BAD_INPUT', `${what}: Invalid typed array length: ${nameOf(length)}`);
  return length;
}

/**
 * Returns the coordinates as WebAssembly takes them. Unlike `Float64Array.from`, converts nothing
 * to a number. A last x without a y does not count.
 */
function numbers(coords: ArrayLike<number>): Coordinates {
  const length = 2 * Math.floor(lengthOf('coords', coords) / 2);
  checkCount(length / 2);
  const kind = kindOf(coords);
  if (kind === 'Float64Array' || kind === 'Float32Array') {
    const own = inThisRealm(coords as Coordinates);
    if (isDetached(own))
      throw new GdelError('BAD_INPUT', 'the buffer of coords is detached: it was transferred');
    return own.length === length ? own : own.subarray(0, length);
  }
  const copy = new Float64Array(length);
  for (let i = 0; i < length; i++) {
    const value: unknown = coords[i];
    if (typeof value !== 'number') {
      const what = `coordinate ${i} is ${nameOf(value)}`;
      throw new GdelError('BAD_INPUT', `Expected coords to contain numbers: ${what}`);
    }
    copy[i] = value;
  }
  return copy;
}
