// The interface of the npm package delaunator, on the CPU backend in the calling thread.

import { runtime } from '#runtime';
import type { Triangles } from './core.js';
import { GdelError, type PlainError, toGdelError } from './errors.js';
import { compiled } from './host.js';
import { checkCount, nameOf } from './points.js';

let triangulate: ((points: Float32Array | Float64Array) => Triangles) | undefined;
let loading: Promise<void> | undefined;

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
   * of the triangles. If all points are collinear: the distinct points, sorted by x and then by y.
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
    loading ??= Promise.all([compiled('d2'), runtime.code()]).then(
      ([module, { createBlockingTriangulator }]) => {
        triangulate = createBlockingTriangulator(module);
      },
      (error: unknown) => {
        loading = undefined;
        throw error;
      },
    );
    return loading;
  }

  /** Triangulates points of any form, `[x, y]` by default. */
  static from<P>(
    points: ArrayLike<P>,
    getX: (point: P) => number = (point) => (point as ArrayLike<number>)[0]!,
    getY: (point: P) => number = (point) => (point as ArrayLike<number>)[1]!,
  ): Delaunator<Float64Array> {
    checkCount(points.length);
    const coords = new Float64Array(2 * points.length);
    for (let i = 0; i < points.length; i++) {
      coords[2 * i] = getX(points[i]!);
      coords[2 * i + 1] = getY(points[i]!);
    }
    return new Delaunator(coords);
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
    if (!triangulate)
      throw new GdelError(
        'NOT_LOADED',
        'the WebAssembly module is not loaded yet: await Delaunator.load() first',
      );
    try {
      Object.assign(this, arraysOf(triangulate(numbers(this.coords))));
    } catch (error) {
      throw error instanceof GdelError ? error : toGdelError(error as PlainError);
    }
  }

  /** The length of {@link triangles}. */
  get trianglesLen(): number {
    return this.triangles.length;
  }
}

export default Delaunator;
export { GdelError, type GdelErrorCode } from './errors.js';

function arraysOf({ triangles, halfedges, hull, duplicateOf, dimension }: Triangles): Triangles {
  return { triangles, halfedges, hull, duplicateOf, dimension };
}

/**
 * Returns the coordinates as WebAssembly takes them. Unlike `Float64Array.from`, converts nothing
 * to a number.
 */
function numbers(coords: ArrayLike<number>): Float32Array | Float64Array {
  if (coords instanceof Float32Array || coords instanceof Float64Array) return coords;
  if (typeof coords !== 'object' || coords === null || !Number.isInteger(coords.length)) {
    throw new GdelError(
      'BAD_INPUT',
      `coordinates must be an array of numbers, not ${nameOf(coords)}`,
    );
  }
  checkCount(coords.length / 2);
  const copy = new Float64Array(coords.length);
  for (let i = 0; i < copy.length; i++) {
    const value: unknown = coords[i];
    if (typeof value !== 'number')
      throw new GdelError('BAD_INPUT', `coordinate ${i} is ${nameOf(value)}, not a number`);
    copy[i] = value;
  }
  return copy;
}
