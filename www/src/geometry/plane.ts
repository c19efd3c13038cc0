import type { Tetrahedralisation } from './mesh';
import { Sample } from './range';

/**
 * The cutting plane in the frame of the drawing: what lies on the side of its normal is cut away.
 */
export interface Plane {
  /** Of length 1. */
  normal: readonly [number, number, number];
  /**
   * How much of the points' extent along the normal stays: 1 is everything, 0 nothing. Null for a
   * cut that leaves half of the points.
   */
  keep: number | null;
}

/**
 * A mesh measured along one direction, so that moving the plane along it needs no look at most of
 * the neighbours: 50 million memory accesses fewer at a million points.
 */
export interface Heights {
  /** Of each tetrahedron's centroid. */
  height: Float32Array;
  /** The highest centroid among each tetrahedron's neighbours. */
  reach: Float32Array;
}

/** How the points of a mesh are spread along a direction. */
export interface Spread {
  normal: Plane['normal'];
  /** The lowest and the highest point that is no outlier. */
  extent: [number, number];
  /** The height below which half of the points lie. */
  middle: number;
}

/** Measures points along a direction. */
export function spreadAlong(normal: Plane['normal'], positions: Float32Array): Spread {
  const [nx, ny, nz] = normal;
  const at = (i: number) =>
    nx * positions[3 * i] + ny * positions[3 * i + 1] + nz * positions[3 * i + 2];
  const sample = positions.length > 0 ? new Sample(positions.length / 3, at) : null;
  return { normal, extent: sample?.range ?? [0, 1], middle: sample?.quantile(0.5) ?? 0.5 };
}

/** Measures the tetrahedra of a mesh along a direction. */
export function heightsAlong(
  normal: Plane['normal'],
  { positions, tetrahedra, neighbors }: Tetrahedralisation,
): Heights {
  const [nx, ny, nz] = normal;
  const points = new Float32Array(positions.length / 3);
  for (let i = 0, p = 0; i < points.length; i++, p += 3) {
    points[i] = nx * positions[p] + ny * positions[p + 1] + nz * positions[p + 2];
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
  return { height, reach };
}

/**
 * A cut that halves the points is at least so far from either end: half of the points may lie on
 * one wall.
 */
const OFF = 0.35;

/** How much of the extent a plane leaves. */
export function keepOf(
  { keep }: Plane,
  { extent: [low, high], middle }: Pick<Spread, 'extent' | 'middle'>,
): number {
  if (keep !== null) return keep;
  return high > low ? Math.min(1 - OFF, Math.max(OFF, (middle - low) / (high - low))) : 1;
}

/** How high the plane lies. Infinite where it cuts nothing, or everything. */
export function levelOf(plane: Plane, spread: Pick<Spread, 'extent' | 'middle'>): number {
  const keep = keepOf(plane, spread);
  const [low, high] = spread.extent;
  if (keep >= 1) return Infinity;
  return keep <= 0 ? -Infinity : low + (high - low) * keep;
}
