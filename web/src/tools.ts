// Files, verification, and synthetic points: in a second wasm module with a worker of its own.

import { GdelError } from './errors.js';
import { Host } from './host.js';
import type { Coordinates, MeshArrays } from './protocol.js';
import { ownCoordinates } from './points.js';
import type { Distribution, MeshStatement, PointCloud, Points, Report, TaskOptions } from './types.js';

let shared: Host | undefined;

function host(): Host {
  return (shared ??= new Host('tools'));
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
  options: TaskOptions & { /** 0 to 2⁵³ − 1, default 1. */ seed?: number } = {},
): Promise<Float64Array> {
  const { seed = 1 } = options;
  const isCount = (n: unknown, most: number) => Number.isInteger(n) && (n as number) >= 0 && (n as number) <= most;
  if (!isCount(count, 2 ** 27)) throw new GdelError('BAD_INPUT', `${count} is no number of points from 0 to 2²⁷`);
  if (!isCount(seed, Number.MAX_SAFE_INTEGER)) throw new GdelError('BAD_INPUT', `${seed} is no seed from 0 to 2⁵³ − 1`);
  return host().run('generate', { kind, count, seed: BigInt(seed) }, [], options);
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
export async function readPoints(data: Blob | ArrayBuffer | Uint8Array, options: ReadOptions = {}): Promise<PointCloud> {
  const name = options.name ?? (data instanceof Blob && 'name' in data ? String(data.name) : undefined);
  const extension = options.format ?? name?.match(/\.([^./\\]+)$/)?.[1];
  if (extension === undefined) {
    throw new GdelError('UNKNOWN_FORMAT', 'the file’s format is not known: give its name or format');
  }
  let bytes: Uint8Array;
  if (data instanceof Blob) bytes = new Uint8Array(await data.arrayBuffer());
  else if (data instanceof ArrayBuffer || data instanceof Uint8Array) bytes = new Uint8Array(data).slice();
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
export async function verify(points: Points, mesh: MeshStatement, options: TaskOptions = {}): Promise<Report> {
  const { coordinates } = await ownCoordinates(points, {
    dimension: 3,
    transfer: false,
    point: undefined,
    signal: options.signal,
  });
  const { tetrahedra, neighbors, hull, duplicateOf, dimension } = mesh;
  if (!(tetrahedra instanceof Uint32Array)) throw new GdelError('BAD_INPUT', 'tetrahedra are a Uint32Array');
  const args = { points: coordinates, mesh: { tetrahedra, neighbors, hull, duplicateOf, dimension } };
  const { thread: _, whyThread: __, ...report } = await host().run('verify', args, [], options);
  return report;
}

/** The files of a format, by extension. */
export async function write(
  points: Coordinates,
  mesh: MeshArrays,
  format: string,
  options: TaskOptions,
): Promise<Record<string, Uint8Array>> {
  return host().run('write', { points, mesh, format }, [], options);
}
