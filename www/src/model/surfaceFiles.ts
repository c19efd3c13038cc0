/** A surface in the units of the input: triangles of point indices, counter-clockwise from outside. */
export interface SurfaceMesh {
  points: Float32Array | Float64Array;
  /** Red, green and blue once a point; null if they have no colours. */
  colors: Uint8Array | null;
  triangles: Uint32Array;
}

export const SURFACE_FORMATS = ['PLY', 'OBJ', 'STL'] as const;
export type SurfaceFormat = (typeof SURFACE_FORMATS)[number];

/** The surface as a file. Points that it does not use are left out. */
export function surfaceFile(surface: SurfaceMesh, format: SurfaceFormat): Uint8Array {
  const write = { PLY: toPLY, OBJ: toOBJ, STL: toSTL }[format];
  return write(compact(surface));
}

/** Numbers the points that the triangles use anew, in the order in which they are used. */
function compact({ points, colors, triangles }: SurfaceMesh): SurfaceMesh {
  const numbers = new Int32Array(points.length / 3).fill(-1);
  const used: number[] = [];
  const renumbered = triangles.map((point) => {
    if (numbers[point] < 0) numbers[point] = used.push(point) - 1;
    return numbers[point];
  });
  const own =
    points instanceof Float32Array
      ? new Float32Array(3 * used.length)
      : new Float64Array(3 * used.length);
  const ownColors = colors && new Uint8Array(3 * used.length);
  for (const [i, point] of used.entries()) {
    own.set(points.subarray(3 * point, 3 * point + 3), 3 * i);
    if (colors) ownColors!.set(colors.subarray(3 * point, 3 * point + 3), 3 * i);
  }
  return { points: own, colors: ownColors, triangles: renumbered };
}

/** Binary, in the precision of the input. */
function toPLY({ points, colors, triangles }: SurfaceMesh): Uint8Array {
  const single = points instanceof Float32Array;
  const type = single ? 'float' : 'double';
  const count = triangles.length / 3;
  const header = new TextEncoder().encode(
    `ply\nformat binary_little_endian 1.0\nelement vertex ${points.length / 3}\n` +
      `property ${type} x\nproperty ${type} y\nproperty ${type} z\n` +
      (colors ? 'property uchar red\nproperty uchar green\nproperty uchar blue\n' : '') +
      `element face ${count}\nproperty list uchar int vertex_indices\nend_header\n`,
  );
  const size = single ? 4 : 8;
  const file = new Uint8Array(
    header.length + size * points.length + (colors?.length ?? 0) + 13 * count,
  );
  file.set(header);
  const view = new DataView(file.buffer);
  let at = header.length;
  for (let i = 0; i < points.length; i += 3) {
    for (let axis = 0; axis < 3; axis++) {
      if (single) view.setFloat32(at, points[i + axis], true);
      else view.setFloat64(at, points[i + axis], true);
      at += size;
    }
    if (!colors) continue;
    file.set(colors.subarray(i, i + 3), at);
    at += 3;
  }
  for (let i = 0; i < triangles.length; i += 3) {
    view.setUint8(at, 3);
    for (let k = 0; k < 3; k++) view.setInt32(at + 1 + 4 * k, triangles[i + k], true);
    at += 13;
  }
  return file;
}

function toOBJ({ points, colors, triangles }: SurfaceMesh): Uint8Array {
  const lines: string[] = [];
  for (let i = 0; i < points.length; i += 3) {
    const [r, g, b] = colors ? [0, 1, 2].map((k) => Number((colors[i + k] / 255).toFixed(4))) : [];
    lines.push(
      `v ${points[i]} ${points[i + 1]} ${points[i + 2]}${colors ? ` ${r} ${g} ${b}` : ''}`,
    );
  }
  for (let i = 0; i < triangles.length; i += 3)
    lines.push(`f ${triangles[i] + 1} ${triangles[i + 1] + 1} ${triangles[i + 2] + 1}`);
  return new TextEncoder().encode(`${lines.join('\n')}\n`);
}

/** Binary, which has single precision. */
function toSTL({ points, triangles }: SurfaceMesh): Uint8Array {
  const count = triangles.length / 3;
  const file = new Uint8Array(84 + 50 * count);
  const view = new DataView(file.buffer);
  view.setUint32(80, count, true);
  for (let t = 0; t < count; t++) {
    const corners = [0, 1, 2].map((k) => 3 * triangles[3 * t + k]);
    const [u, v] = [corners[1], corners[2]].map((corner) =>
      [0, 1, 2].map((axis) => points[corner + axis] - points[corners[0] + axis]),
    );
    const normal = [
      u[1] * v[2] - u[2] * v[1],
      u[2] * v[0] - u[0] * v[2],
      u[0] * v[1] - u[1] * v[0],
    ];
    const length = Math.hypot(...normal) || 1;
    const at = 84 + 50 * t;
    for (let axis = 0; axis < 3; axis++) {
      view.setFloat32(at + 4 * axis, normal[axis] / length, true);
      for (let k = 0; k < 3; k++)
        view.setFloat32(at + 12 + 12 * k + 4 * axis, points[corners[k] + axis], true);
    }
  }
  return file;
}
