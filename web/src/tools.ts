// Files, verification and synthetic points, in a WebAssembly module of their own.

import { moduleTools } from '#assets';
import {
  type Bytes,
  type Doubles,
  inThisRealm,
  isArrayBuffer,
  isDetached,
  kindOf,
} from './arrays.js';
import { GdelError } from './errors.js';
import { bad, checkArrays, checkInteger, objectOf, optionsOf, taskOptions } from './options.js';
import { copyOf } from './points.js';
import type { TaskName, Tasks } from './protocol.js';
import { runShared } from './shared.js';
import type {
  Distribution,
  Distribution2,
  MeshView,
  MeshView2,
  PointCloud,
  Points,
  Report,
  Report2,
  Shapes,
  TaskOptions,
} from './types.js';

/** Runs a task with options that are checked. */
const run = <T extends TaskName>(
  task: T,
  args: Tasks[T]['args'],
  options: TaskOptions,
  transfer: ArrayBuffer[] = [],
) => runShared(moduleTools, task, args, options, transfer);

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
  options?: GenerateOptions,
): Promise<Doubles> {
  return run('generate', cloud(kind, count, options), taskOptions(optionsOf(options)));
}

/**
 * Generates points in 2D, as the command line's `gdel generate --dim 2` does; see {@link generate}.
 *
 * @returns x, y, x, y, …
 */
export async function generate2d(
  kind: Distribution2,
  count: number,
  options?: GenerateOptions,
): Promise<Doubles> {
  return run('generate2d', cloud(kind, count, options), taskOptions(optionsOf(options)));
}

/** Returns the checked arguments of the generators. */
function cloud(kind: string, count: number, options: GenerateOptions | undefined) {
  const { seed = 1 } = optionsOf(options);
  if (typeof kind !== 'string') throw bad('the distribution', 'a name', kind);
  checkInteger('the number of points', count, 0, 2 ** 27);
  checkInteger('the seed', seed, 0, Number.MAX_SAFE_INTEGER);
  return { kind, count, seed: BigInt(seed) };
}

/** Options for reading a file. */
export interface ReadOptions extends TaskOptions {
  /** The name of the file, whose extension tells the format. Default: that of a `File`. */
  name?: string | undefined;
  /** The extension, such as `'ply'`, if there is no name. */
  format?: string | undefined;
}

/** Options of `readPoints`. */
export interface ReadPointsOptions extends ReadOptions {
  /**
   * 2 for points in the plane, of which *x* and *y* are read; a *z* is left out. Default: 3, where a file that has no *z*
   * is an error.
   */
  dimension?: 2 | 3 | undefined;
}

/**
 * Reads the points of a file: PLY, OBJ, STL, XYZ, TXT, ASC, PTS, CSV, TSV, PCD, LAS, LAZ, E57, NPY,
 * and raw little-endian `f32` and `f64`.
 *
 * @throws {@link GdelError} `UNKNOWN_FORMAT`; `BAD_FILE`, which says where the file is broken.
 */
export async function readPoints(
  data: Blob | ArrayBuffer | Uint8Array,
  options?: ReadPointsOptions,
): Promise<PointCloud> {
  const { dimension = 3 } = optionsOf(options);
  if (dimension !== 2 && dimension !== 3) throw bad('the option dimension', '2 or 3', dimension);
  return readFile('readPoints', data, options, { dimension });
}

/**
 * Reads the shapes of a file: GeoJSON, SVG, whose curves become lines that are at most 1/5000 of the larger side of the
 * drawing away and whose *y* becomes −*y*, or Triangle's `.poly` with its points.
 *
 * ```ts
 * const shapes = await readShapes(file);
 * const mesh = await delaunay2d(shapes.points, shapes);
 * mesh.insideTriangles(); // Uint32Array [ … ]
 * ```
 *
 * @throws {@link GdelError} as {@link readPoints}.
 */
export async function readShapes(
  data: Blob | ArrayBuffer | Uint8Array,
  options?: ReadOptions,
): Promise<Shapes> {
  return readFile('readShapes', data, options, {});
}

async function readFile<T extends 'readPoints' | 'readShapes'>(
  kind: T,
  data: Blob | ArrayBuffer | Uint8Array,
  options: ReadOptions | undefined,
  more: Omit<Tasks[T]['args'], 'bytes' | 'extension'>,
): Promise<Tasks[T]['result']> {
  const { name, format } = optionsOf(options);
  for (const [option, value] of Object.entries({ name, format }))
    if (value !== undefined && typeof value !== 'string')
      throw bad(`the option ${option}`, 'a string', value);
  const task = taskOptions(optionsOf(options));
  const ownName = (data as Partial<File> | null)?.name;
  const from = name ?? (typeof ownName === 'string' ? ownName : undefined);
  const extension = format ?? from?.match(/\.([^./\\]+)$/)?.[1];
  if (extension === undefined) {
    throw new GdelError(
      'UNKNOWN_FORMAT',
      'the format of the file is unknown: pass the option name or format',
    );
  }
  const bytes = await bytesOf(data);
  const args = { bytes, extension: extension.replace(/^\./, ''), ...more } as Tasks[T]['args'];
  return run(kind, args, task, [bytes.buffer]);
}

/** Returns the content of a file as an array that nobody else uses. */
async function bytesOf(data: unknown): Promise<Bytes> {
  const isBytes = kindOf(data) === 'Uint8Array';
  if (isBytes || isArrayBuffer(data)) {
    const view = isBytes ? (data as Uint8Array) : undefined;
    if (isDetached(view ?? { buffer: data as ArrayBuffer, byteLength: 0, byteOffset: 0 }))
      throw new GdelError('BAD_INPUT', 'the buffer of the file is detached');
    return new Uint8Array(view ?? (data as ArrayBuffer)).slice();
  }
  if (typeof (data as Partial<Blob> | null)?.arrayBuffer !== 'function')
    throw bad('a file', 'a Blob, an ArrayBuffer or a Uint8Array', data);
  return new Uint8Array(await (data as Blob).arrayBuffer());
}

/**
 * Proves that a mesh is the Delaunay triangulation of the points, or tells what is wrong with it:
 * exactly, and whoever computed the mesh. A wrong mesh is no error: the report describes it.
 */
export async function verify(
  points: Points,
  mesh: MeshView,
  options?: TaskOptions,
): Promise<Report> {
  const view = viewOf(mesh, 'tetrahedra', 'neighbors') as MeshView;
  const task = taskOptions(optionsOf(options));
  return run('verify', { points: await copyOf(points, 3, task), mesh: view }, task);
}

/** Does for a 2D mesh what {@link verify} does in 3D. */
export async function verify2d(
  points: Points,
  mesh: MeshView2,
  options?: TaskOptions,
): Promise<Report2> {
  const view = viewOf(mesh, 'triangles', 'halfedges') as MeshView2;
  const task = taskOptions(optionsOf(options));
  return run('verify2d', { points: await copyOf(points, 2, task), mesh: view }, task);
}

/** Returns the arrays of a mesh that the verifier looks at, checked. */
function viewOf(mesh: MeshView | MeshView2, simplices: string, neighbors: string): object {
  objectOf('the mesh', mesh);
  return {
    [simplices]: required(mesh, simplices, 'Uint32Array'),
    [neighbors]: optional(mesh, neighbors, 'Int32Array'),
    hull: optional(mesh, 'hull', 'Uint32Array'),
    duplicateOf: optional(mesh, 'duplicateOf', 'Int32Array'),
    dimension: dimensionOf(mesh.dimension),
    weights: optional({ weights: mesh.weights ?? undefined }, 'weights', 'Float64Array'),
    hidden: optional(mesh, 'hidden', 'Uint32Array'),
    constraints: constraintsOf(mesh as MeshView2),
  };
}

/** Returns the constraints of a mesh in 2D that the verifier looks at, checked. */
function constraintsOf({ constraints }: Pick<MeshView2, 'constraints'>) {
  if (!constraints) return undefined;
  objectOf('the constraints', constraints);
  const edges = required(constraints, 'edges', 'Uint32Array');
  return { edges, segments: optional(constraints, 'segments', 'Uint32Array') };
}

interface Kinds {
  Uint32Array: Uint32Array;
  Int32Array: Int32Array;
  Float64Array: Float64Array;
}

/** Returns an array of a mesh, checked. */
function required<K extends keyof Kinds>(mesh: object, name: string, kind: K): Kinds[K] {
  const array = (mesh as Record<string, unknown>)[name];
  if (kindOf(array) !== kind) throw bad(name, `a ${kind}`, array);
  const own = inThisRealm(array as Kinds[K]);
  if (isDetached(own))
    throw new GdelError('BAD_INPUT', `${name} is detached: its buffer was transferred`);
  return own;
}

/** Returns an array of a mesh, checked, or undefined if the mesh does not state it. */
function optional<K extends keyof Kinds>(
  mesh: object,
  name: string,
  kind: K,
): Kinds[K] | undefined {
  const array = (mesh as Record<string, unknown>)[name];
  return array === undefined ? undefined : required(mesh, name, kind);
}

function dimensionOf(dimension: unknown): number | undefined {
  if (dimension !== undefined && ![0, 1, 2, 3].includes(dimension as number))
    throw bad('dimension', '0, 1, 2 or 3', dimension);
  return dimension as number | undefined;
}

/** Returns what files hold of the weights of points, if they have any. */
export const weighted = ({ weights, hidden }: Pick<MeshView, 'weights' | 'hidden'>) =>
  weights ? { weights, hidden } : {};

/** Returns a mesh as files of a format, by extension. */
export async function write<T extends 'write' | 'write2d'>(
  task: T,
  args: Tasks[T]['args'],
  options: TaskOptions | undefined,
): Promise<Record<string, Bytes>> {
  checkArrays({ points: args.points, ...args.mesh });
  return run(task, args, taskOptions(optionsOf(options)));
}
