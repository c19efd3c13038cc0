/** A ray in the frame of the drawing. */
export interface Ray {
  origin: readonly [number, number, number];
  direction: readonly [number, number, number];
}

/** The first triangle that the ray meets from its front, or -1. Nine coordinates a triangle. */
export function firstHit(triangles: Float32Array, { origin, direction }: Ray): number {
  const [ox, oy, oz] = origin;
  const [dx, dy, dz] = direction;
  let nearest = Infinity;
  let hit = -1;
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
      hit = i / 9;
    }
  }
  return hit;
}
