// Files, verification and synthetic points, in a WebAssembly module with a worker of its own.

import { GdelError } from './errors.js';
import { Host } from './host.js';
import { ownCoordinates } from './points.js';
import type { Coordinates } from './protocol.js';
import type {
  Distribution,
  Distribution2,
  MeshView,
  MeshView2,
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

/** Options for synthetic points. */
export interface GenerateOptions extends TaskOptions {
  /** The seed, 0 to 2⁵³ − 1, default 1. */
  seed?: number | undefined;
}

/**
 * Generates points of the distributions of the gDel3D paper's §5.1. The same name, number and seed
 * give the same points, bit for bit, on every machine and in the command line's `gdel generate`.
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
 * Generates points in 2D, as the command line's `gdel generate --dim 2` does; see {@link generate}.
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

/** Returns the number of points and the seed, checked. */
function cloud(count: number, { seed = 1 }: GenerateOptions): { count: number; seed: bigint } {
  const isCount = (n: unknown, max: number) =>
    Number.isInteger(n) && (n as number) >= 0 && (n as number) <= max;
  if (!isCount(count, 2 ** 27))
    throw new GdelError(
      'BAD_INPUT',
      `the number of points must be an integer from 0 to 2²⁷, not ${count}`,
    );
  if (!isCount(seed, Number.MAX_SAFE_INTEGER))
    throw new GdelError('BAD_INPUT', `the seed must be an integer from 0 to 2⁵³ − 1, not ${seed}`);
  return { count, seed: BigInt(seed) };
}

/** Options for reading a file. */
export interface ReadOptions extends TaskOptions {
  /** The name of the file, whose extension tells the format. Default: that of a `File`. */
  name?: string | undefined;
  /** The extension, such as `'ply'`, if there is no name. */
  format?: string | undefined;
}

/**
 * Reads the points of a file: PLY, OBJ, STL, XYZ, TXT, ASC, PTS, CSV, TSV, PCD, LAS, LAZ, NPY, and
 * raw little-endian `f32` and `f64`.
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
      'the format of the file is unknown: pass the option name or format',
    );
  }
  let bytes: Uint8Array;
  if (data instanceof Blob) bytes = new Uint8Array(await data.arrayBuffer());
  else if (data instanceof ArrayBuffer || data instanceof Uint8Array)
    bytes = new Uint8Array(data).slice();
  else throw new GdelError('BAD_INPUT', 'a file must be a Blob, an ArrayBuffer or a Uint8Array');
  const { points, noReturn } = await host().run(
    'readPoints',
    { bytes, extension: extension.replace(/^\./, '') },
    [bytes.buffer as ArrayBuffer],
    options,
  );
  return { points, noReturn };
}

/**
 * Proves that a mesh is the Delaunay triangulation of the points, or tells what is wrong with it:
 * exactly, and whoever computed the mesh. A wrong mesh is no error: the report describes it.
 */
export async function verify(
  points: Points,
  mesh: MeshView,
  options: TaskOptions = {},
): Promise<Report> {
  const { tetrahedra, neighbors, hull, duplicateOf, dimension } = mesh;
  if (!(tetrahedra instanceof Uint32Array))
    throw new GdelError('BAD_INPUT', 'tetrahedra must be a Uint32Array');
  const view = { tetrahedra, neighbors, hull, duplicateOf, dimension };
  const args = { points: await coordinatesOf(points, 3, options), mesh: view };
  const { thread: _, whyThread: __, ...report } = await host().run('verify', args, [], options);
  return report;
}

/** Does for a 2D mesh what {@link verify} does in 3D. */
export async function verify2d(
  points: Points,
  mesh: MeshView2,
  options: TaskOptions = {},
): Promise<Report2> {
  const { triangles, halfedges, hull, duplicateOf, dimension } = mesh;
  if (!(triangles instanceof Uint32Array))
    throw new GdelError('BAD_INPUT', 'triangles must be a Uint32Array');
  const view = { triangles, halfedges, hull, duplicateOf, dimension };
  const args = { points: await coordinatesOf(points, 2, options), mesh: view };
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

/** Returns a 3D mesh as files of a format, by extension. */
export async function write(
  points: Coordinates,
  mesh: MeshView,
  format: string,
  options: TaskOptions,
): Promise<Record<string, Uint8Array>> {
  return host().run('write', { points, mesh, format }, [], options);
}

/** Returns a 2D mesh as files of a format, by extension. */
export async function write2d(
  points: Coordinates,
  mesh: MeshView2,
  format: string,
  options: TaskOptions,
): Promise<Record<string, Uint8Array>> {
  return host().run('write2d', { points, mesh, format }, [], options);
}
