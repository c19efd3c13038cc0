// Files, verification, and synthetic points: in a second wasm module with a worker of its own.

import { GdelError } from './errors.js';
import { Host } from './host.js';
import { ownCoordinates } from './points.js';
import type { Coordinates } from './protocol.js';
import type {
  Distribution,
  Distribution2,
  MeshStatement,
  MeshStatement2,
  PointCloud,
  Points,
  Report,
  Report2,
  TaskOptions,
} from './types.js';

let shared: Host | undefined;

function host(): Host {
  return (shared ??= new Host());
}

/** How to generate points. */
export interface GenerateOptions extends TaskOptions {
  /** 0 to 2⁵³ − 1, default 1. */
  seed?: number | undefined;
}

/**
 * Synthetic points: the distributions of the gDel3D paper's §5.1. The same name, number and seed give the same points,
 * bit for bit, on every machine and in the command line's `gdel generate`.
 *
 * @returns x, y, z, x, y, z, …
 */
export async function generate(
  kind: Distribution,
  count: number,
  options: GenerateOptions = {},
): Promise<Float64Array> {
  return host().run('generate', { kind, ...cloud(count, options) }, [], options);
}

/**
 * Synthetic points of the plane, as {@link generate}: `gdel generate --dim 2`.
 *
 * @returns x, y, x, y, …
 */
export async function generate2d(
  kind: Distribution2,
  count: number,
  options: GenerateOptions = {},
): Promise<Float64Array> {
  return host().run('generate2d', { kind, ...cloud(count, options) }, [], options);
}

/** How many points of which seed, checked. */
function cloud(count: number, { seed = 1 }: GenerateOptions): { count: number; seed: bigint } {
  const isCount = (n: unknown, most: number) =>
    Number.isInteger(n) && (n as number) >= 0 && (n as number) <= most;
  if (!isCount(count, 2 ** 27))
    throw new GdelError('BAD_INPUT', `${count} is no number of points from 0 to 2²⁷`);
  if (!isCount(seed, Number.MAX_SAFE_INTEGER))
    throw new GdelError('BAD_INPUT', `${seed} is no seed from 0 to 2⁵³ − 1`);
  return { count, seed: BigInt(seed) };
}

/** How to read a file. */
export interface ReadOptions extends TaskOptions {
  /** The file's name, whose extension says the format. Default: that of a `File`. */
  name?: string | undefined;
  /** The extension itself, such as `'ply'`, where there is no name. */
  format?: string | undefined;
}

/**
 * Reads the points of a file: PLY, OBJ, STL, XYZ, TXT, ASC, PTS, CSV, TSV, PCD, LAS, LAZ, NPY, and raw little-endian
 * `f32` and `f64`.
 *
 * @throws {@link GdelError} `UNKNOWN_FORMAT`; `BAD_FILE`, which says where the file is broken.
 */
export async function readPoints(
  data: Blob | ArrayBuffer | Uint8Array,
  options: ReadOptions = {},
): Promise<PointCloud> {
  const name =
    options.name ?? (data instanceof Blob && 'name' in data ? String(data.name) : undefined);
  const extension = options.format ?? name?.match(/\.([^./\\]+)$/)?.[1];
  if (extension === undefined) {
    throw new GdelError(
      'UNKNOWN_FORMAT',
      'the file’s format is not known: give its name or format',
    );
  }
  let bytes: Uint8Array;
  if (data instanceof Blob) bytes = new Uint8Array(await data.arrayBuffer());
  else if (data instanceof ArrayBuffer || data instanceof Uint8Array)
    bytes = new Uint8Array(data).slice();
  else throw new GdelError('BAD_INPUT', 'a file is a Blob, an ArrayBuffer or a Uint8Array');
  const { points, noReturn } = await host().run(
    'readPoints',
    { bytes, extension: extension.replace(/^\./, '') },
    [bytes.buffer as ArrayBuffer],
    options,
  );
  return { points, noReturn };
}

/**
 * Proves that a mesh is the Delaunay triangulation of the points, or says what is wrong with it: exactly, and without
 * knowing how the mesh was made. A defect is no error but part of the report.
 */
export async function verify(
  points: Points,
  mesh: MeshStatement,
  options: TaskOptions = {},
): Promise<Report> {
  const { tetrahedra, neighbors, hull, duplicateOf, dimension } = mesh;
  if (!(tetrahedra instanceof Uint32Array))
    throw new GdelError('BAD_INPUT', 'tetrahedra are a Uint32Array');
  const statement = { tetrahedra, neighbors, hull, duplicateOf, dimension };
  const args = { points: await coordinatesOf(points, 3, options), mesh: statement };
  const { thread: _, whyThread: __, ...report } = await host().run('verify', args, [], options);
  return report;
}

/** As {@link verify}, in the plane. */
export async function verify2d(
  points: Points,
  mesh: MeshStatement2,
  options: TaskOptions = {},
): Promise<Report2> {
  const { triangles, halfedges, hull, duplicateOf, dimension } = mesh;
  if (!(triangles instanceof Uint32Array))
    throw new GdelError('BAD_INPUT', 'triangles are a Uint32Array');
  const statement = { triangles, halfedges, hull, duplicateOf, dimension };
  const args = { points: await coordinatesOf(points, 2, options), mesh: statement };
  const { thread: _, whyThread: __, ...report } = await host().run('verify2d', args, [], options);
  return report;
}

async function coordinatesOf(
  points: Points,
  dimension: number,
  { signal }: TaskOptions,
): Promise<Coordinates> {
  return (await ownCoordinates(points, { dimension, transfer: false, point: undefined, signal }))
    .coordinates;
}

/** The files of a format, by extension. */
export async function write(
  points: Coordinates,
  mesh: MeshStatement,
  format: string,
  options: TaskOptions,
): Promise<Record<string, Uint8Array>> {
  return host().run('write', { points, mesh, format }, [], options);
}

/** As {@link write}, in the plane. */
export async function write2d(
  points: Coordinates,
  mesh: MeshStatement2,
  format: string,
  options: TaskOptions,
): Promise<Record<string, Uint8Array>> {
  return host().run('write2d', { points, mesh, format }, [], options);
}
