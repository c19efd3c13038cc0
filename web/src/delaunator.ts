// The class of the npm package delaunator, on the CPU engine in the calling thread.

import { runtime } from '#runtime';
import type { Triangles } from './core.js';
import { GdelError, type PlainError, toGdelError } from './errors.js';
import { compiled } from './host.js';
import { checkCount, nameOf } from './points.js';

let triangulate: ((points: Float32Array | Float64Array) => Triangles) | undefined;
let loading: Promise<void> | undefined;

/**
 * The 2D Delaunay triangulation in the form of the npm package `delaunator`: at once, in the calling thread, by the CPU
 * engine. Its answer is exact, and the same as that of {@link delaunay2d}, which is better for large inputs on a page, since
 * it does not block.
 *
 * ```js
 * import { Delaunator } from 'gdel-wasm';
 * await Delaunator.load(); // once
 * const { triangles, halfedges, hull } = new Delaunator(coords);
 * ```
 *
 * @typeParam T The coordinates' array.
 */
export class Delaunator<T extends ArrayLike<number> = Float64Array> {
  /** x, y, x, y, …: the array itself, not a copy. */
  readonly coords: T;
  /** Three vertices a triangle, counter-clockwise where the y axis points down: det(b − a, c − a) < 0. Never flat. */
  triangles!: Uint32Array;
  /** Three a triangle: the half-edge that runs against the one from vertex *k* to the next, −1 on the hull. */
  halfedges!: Int32Array;
  /** The vertices of the convex hull, those in the middle of its edges included, in the triangles' sense. The distinct
   * points in order, by x and then by y, if all are collinear. */
  hull!: Uint32Array;
  /** One a point: −1, or the lowest index of a point with the same coordinates, which stands for this one. */
  duplicateOf!: Int32Array;
  /** 2; or 1, 0 where all points are collinear, equal: then there are no triangles. 0 for no points. */
  dimension!: 0 | 1 | 2;

  /** Loads what the constructor needs. Once; later calls do nothing. */
  static load(): Promise<void> {
    loading ??= Promise.all([compiled('plane'), runtime.code()]).then(
      ([module, { makeTriangulator }]) => {
        triangulate = makeTriangulator(module);
      },
      (error: unknown) => {
        loading = undefined;
        throw error;
      },
    );
    return loading;
  }

  /** From points of any form, `[x, y]` by default. */
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
   * @throws {@link GdelError} `NOT_LOADED` before {@link Delaunator.load} is done, `NOT_FINITE`, `BAD_INPUT`,
   * `TOO_MANY_POINTS`, `OUT_OF_MEMORY`.
   */
  constructor(coords: T) {
    this.coords = coords;
    this.update();
  }

  /** Triangulates anew, after the values in {@link coords} were changed. */
  update(): void {
    if (!triangulate)
      throw new GdelError('NOT_LOADED', 'before the first triangulation: await Delaunator.load()');
    try {
      Object.assign(this, arraysOf(triangulate(numbers(this.coords))));
    } catch (error) {
      throw error instanceof GdelError ? error : toGdelError(error as PlainError);
    }
  }

  /** The number of entries of {@link triangles}. */
  get trianglesLen(): number {
    return this.triangles.length;
  }
}

function arraysOf({ triangles, halfedges, hull, duplicateOf, dimension }: Triangles): Triangles {
  return { triangles, halfedges, hull, duplicateOf, dimension };
}

/** What wasm can take: nothing that is not a number is made one. */
function numbers(coords: ArrayLike<number>): Float32Array | Float64Array {
  if (coords instanceof Float32Array || coords instanceof Float64Array) return coords;
  if (typeof coords !== 'object' || coords === null || !Number.isInteger(coords.length)) {
    throw new GdelError('BAD_INPUT', `coordinates are an array of numbers, not ${nameOf(coords)}`);
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
