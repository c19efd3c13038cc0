import type { Tetrahedralisation } from './mesh';

/** The cutting plane in the frame of the drawing: what lies on the side of its normal is cut away. */
export interface Plane {
  /** Of length 1. */
  normal: readonly [number, number, number];
  /** How much of the points' extent along the normal stays: 1 is everything, 0 nothing. */
  keep: number;
}

/**
 * A mesh measured along one direction, so that moving the plane along it needs no look at most of the neighbours: 50 million
 * memory accesses fewer at a million points.
 */
export interface Heights {
  normal: readonly [number, number, number];
  /** The lowest and the highest point. */
  extent: [number, number];
  /** Of each tetrahedron's centroid. */
  height: Float32Array;
  /** The highest centroid among each tetrahedron's neighbours. */
  reach: Float32Array;
}

/** Measures a mesh along a direction. */
export function heightsAlong(
  normal: readonly [number, number, number],
  { positions, tetrahedra, neighbors }: Tetrahedralisation,
): Heights {
  const [nx, ny, nz] = normal;
  const points = new Float32Array(positions.length / 3);
  let low = Infinity;
  let high = -Infinity;
  for (let i = 0, p = 0; i < points.length; i++, p += 3) {
    const h = nx * positions[p] + ny * positions[p + 1] + nz * positions[p + 2];
    points[i] = h;
    if (h < low) low = h;
    if (h > high) high = h;
  }
  const count = tetrahedra.length / 4;
  const height = new Float32Array(count);
  for (let t = 0, v = 0; t < count; t++, v += 4) {
    height[t] =
      0.25 *
      (points[tetrahedra[v]] +
        points[tetrahedra[v + 1]] +
        points[tetrahedra[v + 2]] +
        points[tetrahedra[v + 3]]);
  }
  const reach = new Float32Array(count);
  for (let t = 0; t < count; t++) {
    let highest = -Infinity;
    for (let f = 4 * t; f < 4 * t + 4; f++) {
      const u = neighbors[f];
      if (u >= 0 && height[u] > highest) highest = height[u];
    }
    reach[t] = highest;
  }
  return { normal, extent: [low, high], height, reach };
}

/** How high the plane lies. Infinite where it cuts nothing. */
export function levelOf({ keep }: Plane, { extent: [low, high] }: Heights): number {
  return keep >= 1 ? Infinity : low + (high - low) * keep;
}
