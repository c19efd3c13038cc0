// Terrain: triangles between a few of many points, in a worker.

import type { TinArrays } from './answers.js';
import type { Bytes } from './arrays.js';
import type { TriangleFormat } from './files.js';
import { runTin, Triangles, write } from './index.js';
import type { ConstraintOptions, Points, TaskOptions } from './types.js';

export type { TinArrays };

/** Options of {@link tin}. One of `maxError` and `maxPoints` is needed. */
export interface TinOptions
  extends TaskOptions,
    Pick<ConstraintOptions, 'edges' | 'rings' | 'holes' | 'fill' | 'crossings'> {
  /**
   * How far points may be above or below the surface, in the unit of their heights. Default: 0, with which all points
   * become vertices but those that the surface meets anyway.
   */
  maxError?: number | undefined;
  /**
   * The largest number of vertices. The corners of the hull and the ends of `edges` and `rings` always are some.
   * Default: as many as are needed.
   */
  maxPoints?: number | undefined;
}

export interface Tin extends TinArrays {}
/** Terrain: the surface over some of the points that is near to all of them. */
// biome-ignore lint/suspicious/noUnsafeDeclarationMerging: the constructor assigns what the interface has.
export class Tin extends Triangles {
  /** @internal */
  constructor(arrays: TinArrays) {
    super();
    Object.assign(this, arrays);
  }

  /** @internal */
  async _write(format: TriangleFormat, options: TaskOptions | undefined): Promise<Bytes> {
    const mesh = { tetrahedra: new Uint32Array(0), hull: this.triangles };
    return (await write('write', { points: this.vertices, mesh, format }, options))[format]!;
  }
}

/**
 * Makes terrain of points with heights: triangles between as few of them as it takes for all to be near to the surface,
 * above or below. It begins with the corners of the convex hull, as seen from above, and with the ends of `edges`, which
 * become edges: breaklines. Then the point that is farthest from it becomes a vertex, until none is farther than
 * `maxError`. As seen from above, it is always the constrained Delaunay triangulation of its vertices, exactly. Of points
 * with the same x and y, one counts: the end of an edge, else the lowest. Works in a worker.
 *
 * ```js
 * import { tin } from 'gdel-wasm/tin';
 *
 * const terrain = await tin(points, { maxError: 0.1, edges: [[17, 4], [4, 25]] });
 * console.log(terrain.vertices.length / 3, 'of', points.length / 3, 'points are within', terrain.maxError);
 * await writeFile('terrain.glb', await terrain.toGLB());
 * ```
 *
 * @param points x, y and z of each point, as for `delaunay3d`.
 * @throws `GdelError` `NOT_FINITE`, `BAD_INPUT`, `CROSSING_CONSTRAINTS`, `ABORTED`.
 */
export async function tin(points: Points, options: TinOptions): Promise<Tin> {
  return new Tin(await runTin(points, options));
}

export default tin;
