// The interface of the npm package earcut, on the CPU backend in the calling thread.

import { delaunay2dSync, loadConstraints } from './index.js';

/** A polygon in one array. */
export interface Flat {
  vertices: number[];
  /** The index of the first vertex of each hole. */
  holes: number[];
  dimensions: number;
}

/** Returns the rings of vertices, the outer one first. */
function ringsOf(count: number, holes: ArrayLike<number> | null | undefined): number[][] {
  const starts = [0, ...Array.from(holes ?? [])];
  return starts.map((start, i) => {
    const length = Math.max(0, (starts[i + 1] ?? count) - start);
    return Array.from({ length }, (_, k) => start + k);
  });
}

/**
 * Returns the triangles of a polygon with holes, three vertices each, with the interface of the npm package `earcut`:
 * synchronous, in the calling thread. They are Delaunay, and counter-clockwise if the y axis points up, and no vertex is
 * on an edge of another triangle. Of vertices with equal x and y, the first is used for all.
 *
 * ```js
 * import earcut from 'gdel-wasm/earcut';
 * await earcut.load(); // once
 * const triangles = earcut(vertices, holes);
 * ```
 *
 * @throws `GdelError` `NOT_LOADED` before `earcut.load()` is done, `CROSSING_CONSTRAINTS` if sides cross, and what
 * `delaunay2d` is rejected with.
 */
export function earcut(
  vertices: ArrayLike<number>,
  holes?: ArrayLike<number> | null,
  dimensions = 2,
): number[] {
  const count = Math.floor(vertices.length / dimensions);
  const points = new Float64Array(2 * count);
  for (let i = 0; i < count; i++) {
    points[2 * i] = vertices[dimensions * i]!;
    points[2 * i + 1] = vertices[dimensions * i + 1]!;
  }
  const mesh = delaunay2dSync(points, { rings: ringsOf(count, holes) });
  return Array.from(mesh.insideTriangles()).reverse();
}

/** Loads the WebAssembly module that {@link earcut} needs. Later calls do nothing. */
earcut.load = (): Promise<void> => loadConstraints();

/** Does nothing: the triangles are Delaunay. */
export function refine(
  _triangles: ArrayLike<number>,
  _vertices: ArrayLike<number>,
  _dimensions = 2,
): void {}

/** Converts rings of positions, as those of a GeoJSON polygon, to one array. A repeated last position is kept. */
export function flatten(data: ArrayLike<ArrayLike<ArrayLike<number>>>): Flat {
  const rings = Array.from(data);
  const dimensions = rings[0]?.[0]?.length ?? 2;
  const holes: number[] = [];
  const vertices: number[] = [];
  rings.forEach((ring, i) => {
    if (i > 0) holes.push(vertices.length / dimensions);
    for (const position of Array.from(ring))
      for (let k = 0; k < dimensions; k++) vertices.push(position[k]!);
  });
  return { vertices, holes, dimensions };
}

/** Returns by which share the area of triangles differs from that of the polygon. */
export function deviation(
  vertices: ArrayLike<number>,
  holes: ArrayLike<number> | null | undefined,
  dimensions: number,
  triangles: ArrayLike<number>,
): number {
  const x = (i: number) => vertices[dimensions * i]!;
  const y = (i: number) => vertices[dimensions * i + 1]!;
  const doubled = (ring: number[]) =>
    ring.reduce((sum, v, i) => {
      const before = ring.at(i - 1)!;
      return sum + (x(before) - x(v)) * (y(v) + y(before));
    }, 0);
  const [outer = 0, ...others] = ringsOf(vertices.length / dimensions, holes).map((ring) =>
    Math.abs(doubled(ring)),
  );
  const polygon = others.reduce((sum, hole) => sum - hole, outer);
  let covered = 0;
  for (let t = 0; t < triangles.length; t += 3)
    covered += Math.abs(doubled([triangles[t]!, triangles[t + 1]!, triangles[t + 2]!]));
  return polygon === 0 && covered === 0 ? 0 : Math.abs((covered - polygon) / polygon);
}

export default earcut;
