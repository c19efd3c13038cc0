/** What is measured of each tetrahedron, in the units of the input. */
export interface Measures {
  /** In cubic units of the input. */
  volume: Float32Array;
  /** In units of the input; infinite where the volume underflows. */
  circumradius: Float32Array;
  /** 3 · inradius / circumradius: 1 for a regular tetrahedron, towards 0 for a flat one. */
  radiusRatio: Float32Array;
}

/** Volume, circumradius and radius ratio of every tetrahedron, in double precision. */
export function measure(points: ArrayLike<number>, tetrahedra: Uint32Array): Measures {
  const count = tetrahedra.length / 4;
  const volume = new Float32Array(count);
  const circumradius = new Float32Array(count);
  const radiusRatio = new Float32Array(count);
  for (let t = 0; t < count; t++) {
    const a = 3 * tetrahedra[4 * t];
    const b = 3 * tetrahedra[4 * t + 1];
    const c = 3 * tetrahedra[4 * t + 2];
    const d = 3 * tetrahedra[4 * t + 3];
    const ax = points[a],
      ay = points[a + 1],
      az = points[a + 2];
    const ux = points[b] - ax,
      uy = points[b + 1] - ay,
      uz = points[b + 2] - az;
    const vx = points[c] - ax,
      vy = points[c + 1] - ay,
      vz = points[c + 2] - az;
    const wx = points[d] - ax,
      wy = points[d + 1] - ay,
      wz = points[d + 2] - az;
    // The cross products of the edges at a: twice the areas of its facets.
    const vwx = vy * wz - vz * wy,
      vwy = vz * wx - vx * wz,
      vwz = vx * wy - vy * wx;
    const wux = wy * uz - wz * uy,
      wuy = wz * ux - wx * uz,
      wuz = wx * uy - wy * ux;
    const uvx = uy * vz - uz * vy,
      uvy = uz * vx - ux * vz,
      uvz = ux * vy - uy * vx;
    const six = Math.abs(ux * vwx + uy * vwy + uz * vwz);
    const uu = ux * ux + uy * uy + uz * uz;
    const vv = vx * vx + vy * vy + vz * vz;
    const ww = wx * wx + wy * wy + wz * wz;
    const radius =
      length(
        uu * vwx + vv * wux + ww * uvx,
        uu * vwy + vv * wuy + ww * uvy,
        uu * vwz + vv * wuz + ww * uvz,
      ) /
      (2 * six);
    const twiceArea =
      length(vwx, vwy, vwz) +
      length(wux, wuy, wuz) +
      length(uvx, uvy, uvz) +
      length(vwx + wux + uvx, vwy + wuy + uvy, vwz + wuz + uvz);
    volume[t] = six / 6;
    circumradius[t] = six > 0 ? radius : Infinity;
    radiusRatio[t] = six > 0 ? (3 * six) / (twiceArea * radius) : 0;
  }
  return { volume, circumradius, radiusRatio };
}

/** The square of a triangle's circumradius; infinite where its corners are collinear. */
export function facetCircumradiusSquared(
  points: ArrayLike<number>,
  p: number,
  q: number,
  r: number,
): number {
  const ux = points[3 * q] - points[3 * p];
  const uy = points[3 * q + 1] - points[3 * p + 1];
  const uz = points[3 * q + 2] - points[3 * p + 2];
  const vx = points[3 * r] - points[3 * p];
  const vy = points[3 * r + 1] - points[3 * p + 1];
  const vz = points[3 * r + 2] - points[3 * p + 2];
  const uu = ux * ux + uy * uy + uz * uz;
  const vv = vx * vx + vy * vy + vz * vz;
  const uv = ux * vx + uy * vy + uz * vz;
  const fourAreaSquared = uu * vv - uv * uv;
  return fourAreaSquared > 0 ? (uu * vv * (uu + vv - 2 * uv)) / (4 * fourAreaSquared) : Infinity;
}

/** The centre of the sphere through four points of three coordinates each; not finite if flat. */
export function circumcenter(corners: ArrayLike<number>): [number, number, number] {
  const [u, v, w] = [3, 6, 9].map((p) =>
    [0, 1, 2].map((axis) => corners[p + axis] - corners[axis]),
  );
  const cross = (a: number[], b: number[]) => [
    a[1] * b[2] - a[2] * b[1],
    a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0],
  ];
  const dot = (a: number[], b: number[]) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const [vw, wu, uv] = [cross(v, w), cross(w, u), cross(u, v)];
  const twelve = 2 * dot(u, vw);
  return [0, 1, 2].map(
    (axis) =>
      corners[axis] + (dot(u, u) * vw[axis] + dot(v, v) * wu[axis] + dot(w, w) * uv[axis]) / twelve,
  ) as [number, number, number];
}

// Math.hypot guards against overflow and takes several times as long.
function length(x: number, y: number, z: number): number {
  return Math.sqrt(x * x + y * y + z * z);
}
