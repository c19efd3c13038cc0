/** A tetrahedralisation as the drawing code sees it. */
export interface Tetrahedralisation {
  /** Three coordinates a point, moved and scaled into the unit ball: what is drawn. */
  positions: Float32Array;
  /** Four point indices a tetrahedron, positively oriented. */
  tetrahedra: Uint32Array;
  /** Four a tetrahedron: entry k is the tetrahedron across the facet opposite vertex k, -1 outside the hull. */
  neighbors: Int32Array;
}

/**
 * The corners of the facet opposite vertex k, counter-clockwise as seen from outside the tetrahedron: entries 3k … 3k + 2.
 */
export const FACETS = Uint8Array.of(1, 2, 3, 0, 3, 2, 0, 1, 3, 0, 2, 1);

/** Where the input lies: drawn = (input − center) · scale. */
export interface Frame {
  center: [number, number, number];
  scale: number;
}

/** The frame that moves the points' bounding box into the unit ball. */
export function frameOf(points: ArrayLike<number>): Frame {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; i += 3) {
    for (let axis = 0; axis < 3; axis++) {
      const x = points[i + axis];
      if (x < low[axis]) low[axis] = x;
      if (x > high[axis]) high[axis] = x;
    }
  }
  if (points.length === 0) return { center: [0, 0, 0], scale: 1 };
  // Halves first: the sum of two large coordinates could overflow.
  const center = low.map((l, axis) => l / 2 + high[axis] / 2) as [number, number, number];
  const radius = Math.hypot(...high.map((h, axis) => h / 2 - low[axis] / 2));
  return { center, scale: radius > 0 ? 1 / radius : 1 };
}

/** The points in the frame. The difference is taken in double precision, so large offsets do no harm. */
export function toFrame(points: ArrayLike<number>, { center, scale }: Frame): Float32Array {
  const positions = new Float32Array(points.length);
  for (let i = 0; i < points.length; i += 3) {
    positions[i] = (points[i] - center[0]) * scale;
    positions[i + 1] = (points[i + 1] - center[1]) * scale;
    positions[i + 2] = (points[i + 2] - center[2]) * scale;
  }
  return positions;
}
