/** A ray in the frame of the drawing. */
export interface Ray {
  origin: readonly [number, number, number];
  direction: readonly [number, number, number];
}

/** Where a ray meets a triangle. */
export interface Hit {
  triangle: number;
  /** How much of each corner there is in the place: not below 0, and 1 in all. */
  weights: [number, number, number];
}

/** The place of a hit. Nine coordinates a triangle. */
export function placeOf(triangles: Float32Array, { triangle, weights }: Hit): number[] {
  return [0, 1, 2].map((axis) =>
    weights.reduce((sum, w, corner) => sum + w * triangles[9 * triangle + 3 * corner + axis], 0),
  );
}

/** Where the ray first meets a triangle from its front, or null. Nine coordinates a triangle. */
export function firstHit(triangles: Float32Array, { origin, direction }: Ray): Hit | null {
  const [ox, oy, oz] = origin;
  const [dx, dy, dz] = direction;
  let nearest = Infinity;
  let hit: Hit | null = null;
  for (let i = 0; i < triangles.length; i += 9) {
    // Möller and Trumbore's test.
    const ax = triangles[i],
      ay = triangles[i + 1],
      az = triangles[i + 2];
    const ux = triangles[i + 3] - ax,
      uy = triangles[i + 4] - ay,
      uz = triangles[i + 5] - az;
    const vx = triangles[i + 6] - ax,
      vy = triangles[i + 7] - ay,
      vz = triangles[i + 8] - az;
    const px = dy * vz - dz * vy,
      py = dz * vx - dx * vz,
      pz = dx * vy - dy * vx;
    const determinant = ux * px + uy * py + uz * pz;
    if (determinant <= 0) continue;
    const sx = ox - ax,
      sy = oy - ay,
      sz = oz - az;
    const u = sx * px + sy * py + sz * pz;
    if (u < 0 || u > determinant) continue;
    const qx = sy * uz - sz * uy,
      qy = sz * ux - sx * uz,
      qz = sx * uy - sy * ux;
    const v = dx * qx + dy * qy + dz * qz;
    if (v < 0 || u + v > determinant) continue;
    const distance = (vx * qx + vy * qy + vz * qz) / determinant;
    if (distance > 0 && distance < nearest) {
      nearest = distance;
      const [second, third] = [u / determinant, v / determinant];
      hit = { triangle: i / 9, weights: [1 - second - third, second, third] };
    }
  }
  return hit;
}
