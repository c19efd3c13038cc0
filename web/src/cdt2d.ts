// The interface of the npm package cdt2d, on the CPU backend in the calling thread.

import { delaunay2dSync, loadConstraints, type Mesh2 } from './index.js';

/** Options of {@link cdt2d}. */
export interface Cdt2dOptions {
  /** Accepted for cdt2d's sake: the triangulation is always Delaunay. */
  delaunay?: boolean | undefined;
  /** Whether to return the triangles inside the edges. Default: true. */
  interior?: boolean | undefined;
  /** Whether to return those outside. Default: true. */
  exterior?: boolean | undefined;
  /** Whether to return with those outside one triangle per edge of the hull, with −1 for infinity. Default: false. */
  infinity?: boolean | undefined;
}

type Pairs = ArrayLike<ArrayLike<number>>;

/**
 * Returns the triangles of the constrained Delaunay triangulation, with the interface of the npm package `cdt2d`:
 * synchronous, in the calling thread. Points may be equal, lie on edges, or be in a line. Edges may overlap; those that
 * cross are an error.
 *
 * A triangle is inside if the way out that crosses the fewest edges crosses an odd number of them. Triangles are
 * counter-clockwise if the y axis points up, begin with their lowest vertex, and ascend.
 *
 * ```js
 * import cdt2d from 'gdel-wasm/cdt2d';
 * await cdt2d.load(); // once
 * const triangles = cdt2d(points, edges, { exterior: false });
 * ```
 *
 * @throws `GdelError` `NOT_LOADED` before `cdt2d.load()` is done, `CROSSING_CONSTRAINTS`, and what `delaunay2d` is
 * rejected with.
 */
export function cdt2d(points: Pairs, options?: Cdt2dOptions): number[][];
export function cdt2d(points: Pairs, edges?: Pairs, options?: Cdt2dOptions): number[][];
export function cdt2d(
  points: Pairs,
  edges?: Pairs | Cdt2dOptions,
  options?: Cdt2dOptions,
): number[][] {
  const hasEdges = Array.isArray(edges);
  const given = (hasEdges ? options : (edges as Cdt2dOptions | undefined)) ?? {};
  const { interior = true, exterior = true, infinity = false } = given;
  const mesh = delaunay2dSync(points, { edges: hasEdges ? edges : [] });
  const { triangles, halfedges } = mesh;
  const crossings = interior && exterior ? undefined : crossingsOf(mesh);
  const isWanted = (t: number) => !crossings || (crossings[t]! % 2 === 1 ? interior : exterior);
  const found: number[][] = [];
  for (let t = 0; t < triangles.length / 3; t++) {
    const [a, b, c] = triangles.subarray(3 * t, 3 * t + 3) as unknown as [number, number, number];
    // The other way round.
    if (isWanted(t)) found.push(a < b && a < c ? [a, c, b] : b < c ? [b, a, c] : [c, b, a]);
  }
  found.sort(([a, b, c], [x, y, z]) => a! - x! || b! - y! || c! - z!);
  if (infinity && exterior)
    halfedges.forEach((opposite, e) => {
      if (opposite === -1) found.push([triangles[e]!, triangles[next(e)]!, -1]);
    });
  return found;
}

/** Loads the WebAssembly module that {@link cdt2d} needs. Later calls do nothing. */
cdt2d.load = (): Promise<void> => loadConstraints();

const next = (e: number) => (e % 3 === 2 ? e - 2 : e + 1);

/** Returns for each triangle how many edges the way out crosses that crosses the fewest. */
function crossingsOf(mesh: Mesh2): Int32Array {
  const { triangles, halfedges } = mesh;
  const isEdge = (e: number) => mesh.constraints!.isEdge(triangles[e]!, triangles[next(e)]!);
  const crossings = new Int32Array(triangles.length / 3).fill(-1);
  let [pending, behind]: [number[], number[]] = [[], []];
  halfedges.forEach((opposite, e) => {
    if (opposite === -1) (isEdge(e) ? behind : pending).push(Math.floor(e / 3));
  });
  for (let count = 0; pending.length > 0 || behind.length > 0; count++) {
    for (let t = pending.pop(); t !== undefined; t = pending.pop()) {
      if (crossings[t] !== -1) continue;
      crossings[t] = count;
      for (let e = 3 * t; e < 3 * t + 3; e++) {
        const opposite = halfedges[e]!;
        if (opposite !== -1) (isEdge(e) ? behind : pending).push(Math.floor(opposite / 3));
      }
    }
    [pending, behind] = [behind, []];
  }
  return crossings;
}

export default cdt2d;
