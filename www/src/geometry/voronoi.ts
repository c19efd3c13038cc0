import type { Frame } from './mesh';
import type { Triangulation } from './triangles';

/** The rectangle to which the diagram is cut. */
export interface Box {
  low: readonly [number, number];
  high: readonly [number, number];
}

/** The diagram as drawn. */
export interface Voronoi {
  /** Two ends an edge, of three coordinates each. */
  ends: Float32Array;
  box: Box;
}

/**
 * The edges of the Voronoi diagram within a box; the third coordinate of their ends is 0.
 *
 * Each lies on the bisector of a Delaunay edge, from the circumcentre of the triangle on one side to that of the other; on the
 * hull it goes on outwards without end, also where that circumcentre lies outside of the hull. Circumcentres are not computed:
 * those of thin triangles are too far away for numbers. What is, is their place on the bisector. It errs only along it.
 *
 * 1. Where all points are collinear: the bisectors of neighbouring points.
 * 2. Else, of each pair of half-edges the first: from middle + s · normal, s = cot(angle opposite) / 2, to the same with the other
 *    side's -s, or to infinity.
 */
export function voronoiEdges(
  points: ArrayLike<number>,
  { center, scale }: Frame,
  mesh: Triangulation,
  box: Box,
): Voronoi {
  const { low, high } = box;
  const { triangles, halfedges, hull } = mesh;
  let lines = new Float32Array(6 * Math.max(16, triangles.length));
  let end = 0;
  let from = 0;
  let to = 0;
  // Liang and Barsky's clipping, one axis.
  const within = (at: number, by: number, least: number, most: number) => {
    if (by === 0) return at >= least && at <= most;
    const s = (least - at) / by;
    const t = (most - at) / by;
    from = Math.max(from, Math.min(s, t));
    to = Math.min(to, Math.max(s, t));
    return from < to;
  };
  /** The bisector of p and q, from a place on it to another, 0 between the two and 1 as far to the left of p → q as q is. */
  const add = (p: number, q: number, start: number, stop: number) => {
    const px = (points[2 * p] - center[0]) * scale;
    const py = (points[2 * p + 1] - center[1]) * scale;
    const qx = (points[2 * q] - center[0]) * scale;
    const qy = (points[2 * q + 1] - center[1]) * scale;
    const [x, y] = [(px + qx) / 2, (py + qy) / 2];
    const [dx, dy] = [py - qy, qx - px];
    from = start;
    to = stop;
    if (!within(x, dx, low[0], high[0]) || !within(y, dy, low[1], high[1])) return;
    if (end === lines.length) {
      const larger = new Float32Array(2 * end);
      larger.set(lines);
      lines = larger;
    }
    lines[end] = x + from * dx;
    lines[end + 1] = y + from * dy;
    lines[end + 3] = x + to * dx;
    lines[end + 4] = y + to * dy;
    end += 6;
  };

  if (triangles.length === 0) {
    for (let i = 1; i < hull.length; i++) add(hull[i - 1], hull[i], -Infinity, Infinity);
  }
  for (let e = 0; e < triangles.length; e++) {
    const twin = halfedges[e];
    if (twin >= 0 && twin < e) continue;
    // Triangles are clockwise: e's own lies to the right, its twin's to the left.
    const right = -halfCotangent(points, triangles, e);
    const left = twin < 0 ? Infinity : halfCotangent(points, triangles, twin);
    if (left > right) add(triangles[e], triangles[next(e)], right, left);
  }
  return { ends: lines.slice(0, end), box };
}

/** Half the cotangent of the angle opposite a half-edge: the circumcentre's distance from it, in lengths of the edge. */
function halfCotangent(points: ArrayLike<number>, triangles: Uint32Array, e: number): number {
  const [a, b, c] = [2 * triangles[e], 2 * triangles[next(e)], 2 * triangles[next(next(e))]];
  const ux = points[a] - points[c],
    uy = points[a + 1] - points[c + 1];
  const vx = points[b] - points[c],
    vy = points[b + 1] - points[c + 1];
  const dot = ux * vx + uy * vy;
  const cross = Math.abs(ux * vy - uy * vx);
  // Where the area underflows, the angle is 0 or flat.
  return cross > 0 ? dot / cross / 2 : dot * Infinity;
}

const next = (e: number) => (e % 3 === 2 ? e - 2 : e + 1);
