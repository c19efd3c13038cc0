import type { Measures } from './measures';
import { paint } from './skin';
import type { Surface } from './surface';

/** A 2D triangulation as the drawing code sees it. */
export interface Triangulation {
  /** Three coordinates a point, the third 0: moved and scaled into the unit circle. */
  positions: Float32Array;
  /** Three point indices a triangle, clockwise with y up. */
  triangles: Uint32Array;
  /**
   * Three a triangle: the half-edge that runs against the one from vertex k to the next, -1 on the
   * hull.
   */
  halfedges: Int32Array;
  /**
   * The vertices of the hull in order, clockwise with y up; the distinct points in order where all
   * are collinear.
   */
  hull: Uint32Array;
}

/**
 * Area (in the place of the volume), circumradius, and radius ratio 2 · inradius / circumradius of
 * every triangle, in double precision.
 */
export function measureTriangles(points: ArrayLike<number>, triangles: Uint32Array): Measures {
  const count = triangles.length / 3;
  const volume = new Float32Array(count);
  const circumradius = new Float32Array(count);
  const radiusRatio = new Float32Array(count);
  for (let t = 0; t < count; t++) {
    const a = 2 * triangles[3 * t];
    const b = 2 * triangles[3 * t + 1];
    const c = 2 * triangles[3 * t + 2];
    const ux = points[b] - points[a],
      uy = points[b + 1] - points[a + 1];
    const vx = points[c] - points[a],
      vy = points[c + 1] - points[a + 1];
    const twice = Math.abs(ux * vy - uy * vx);
    const [ab, ac, bc] = [Math.hypot(ux, uy), Math.hypot(vx, vy), Math.hypot(ux - vx, uy - vy)];
    volume[t] = twice / 2;
    circumradius[t] = twice > 0 ? (ab * ac * bc) / (2 * twice) : Infinity;
    radiusRatio[t] = twice > 0 ? (2 * twice) / (ab + ac + bc) / circumradius[t] : 0;
  }
  return { volume, circumradius, radiusRatio };
}

/**
 * The given triangles as the GPU needs them, counter-clockwise with y up; in the colours of their
 * points, if these are given.
 */
export function flatSurface(
  { positions, triangles }: Triangulation,
  owners: Uint32Array,
  value: (t: number) => number,
  colors: Uint8Array | null,
): Surface {
  const corners = new Float32Array(9 * owners.length);
  const values = new Float32Array(3 * owners.length);
  const skin = new Uint8Array(12 * owners.length);
  for (let i = 0; i < owners.length; i++) {
    const t = owners[i];
    for (let j = 0; j < 3; j++) {
      const vertex = triangles[3 * t + 2 - j];
      const p = 3 * vertex;
      if (colors) paint(skin, 3 * i + j, colors, vertex);
      corners[9 * i + 3 * j] = positions[p];
      corners[9 * i + 3 * j + 1] = positions[p + 1];
    }
    values.fill(value(t), 3 * i, 3 * i + 3);
  }
  return { positions: corners, values, skin, owners };
}
