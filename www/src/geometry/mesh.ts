import { rangeAlong, wholeRange } from './range';

/** A tetrahedralisation as the drawing code sees it. */
export interface Tetrahedralisation {
  /** Three coordinates a point, moved and scaled into the unit ball: what is drawn. */
  positions: Float32Array;
  /** Four point indices a tetrahedron, positively oriented. */
  tetrahedra: Uint32Array;
  /**
   * Four a tetrahedron: entry k is the tetrahedron across the facet opposite vertex k, -1 outside
   * the hull.
   */
  neighbors: Int32Array;
}

/**
 * The corners of the facet opposite vertex k, counter-clockwise as seen from outside the
 * tetrahedron: entries 3k … 3k + 2.
 */
export const FACETS = Uint8Array.of(1, 2, 3, 0, 3, 2, 0, 1, 3, 0, 2, 1);

/** Where the input lies: drawn = (input − center) · scale. */
export interface Frame {
  center: [number, number, number];
  scale: number;
}

/**
 * The frame that moves the box around points, of two or three coordinates each, into the unit ball.
 * Outliers may be outside.
 */
export function frameOf(points: ArrayLike<number>, dimension: 2 | 3 = 3): Frame {
  // Without points, the unit cube or square.
  const along = (axis: number) =>
    points.length > 0 ? rangeAlong(points, axis, dimension) : ([0, 1] as [number, number]);
  let ranges = Array.from({ length: dimension }, (_, axis) => along(axis));
  // Where nearly all points coincide, all that there is.
  if (ranges.every(([low, high]) => low === high))
    ranges = ranges.map((_, axis) => wholeRange(points, axis, dimension));
  if (dimension === 2) ranges.push([0, 0]);
  // Halves first: the sum of two large coordinates could overflow.
  const center = ranges.map(([low, high]) => low / 2 + high / 2) as [number, number, number];
  const radius = Math.hypot(...ranges.map(([low, high]) => high / 2 - low / 2));
  return { center, scale: radius > 0 ? 1 / radius : 1 };
}

/**
 * The points in the frame, three coordinates each. The difference is taken in double precision, so
 * large offsets do no harm.
 */
export function toFrame(
  points: ArrayLike<number>,
  { center, scale }: Frame,
  dimension: 2 | 3 = 3,
): Float32Array {
  const positions = new Float32Array((points.length / dimension) * 3);
  for (let i = 0, p = 0; i < points.length; i += dimension, p += 3) {
    for (let axis = 0; axis < dimension; axis++)
      positions[p + axis] = (points[i + axis] - center[axis]) * scale;
  }
  return positions;
}
