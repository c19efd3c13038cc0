// Triangulations in the calling thread, done when the function returns.

import { code2d, code3d, codeEdit, wasm2d, wasm3d, wasmEdit } from '#assets';
import type { Coordinates } from './arrays.js';
import type { createBlocking as createBlocking2d } from './core-2d.js';
import type { createBlocking as createBlocking3d } from './core-3d.js';
import type { createBlocking as createConstraining } from './core-edit.js';
import { GdelError, thrown } from './errors.js';
import { coordinatesOf } from './given.js';
import { Mesh3 } from './mesh.js';
import { Mesh2 } from './mesh2.js';
import { compiled } from './modules.js';
import { hasConstraints, optionsOf, outputsOf } from './options.js';
import type { Tasks } from './protocol.js';
import { IN_2D, IN_3D, sharedMaker, updating } from './run.js';
import { loadCode, type WasmAsset } from './runtime.js';
import type { AccessorOptions, ConstraintOptions, Place, Points, SyncOptions } from './types.js';

/** Something that is loaded once, for functions that cannot wait for it. */
export interface Loadable<T> {
  readonly start: () => Promise<T>;
  loading?: Promise<void>;
  value?: T;
}

/** Loads something, unless it is or is being loaded. */
export function load<T>(it: Loadable<T>): Promise<void> {
  it.loading ??= it.start().then(
    (value) => {
      it.value = value;
    },
    (error: unknown) => {
      delete it.loading;
      throw error;
    },
  );
  return it.loading;
}

export function loaded<T>({ value }: Loadable<T>, loader: string): T {
  if (value) return value;
  const message = `the WebAssembly module is not loaded yet: await ${loader}() first`;
  throw new GdelError('NOT_LOADED', message);
}

/** What runs in the calling thread, and where that came from. */
export interface Blocking<F> {
  triangulate: F;
  place: Place;
}

/** The code of a module that triangulates in the calling thread. */
interface BlockingCode<F> {
  createBlocking(module: WebAssembly.Module): F;
}

export async function blocking<F>(
  asset: WasmAsset,
  code: () => Promise<BlockingCode<F>>,
): Promise<Blocking<F>> {
  const [{ value, whyInlined }, { createBlocking }] = await Promise.all([
    compiled(asset),
    loadCode(code),
  ]);
  const triangulate = thrown(() => createBlocking(value));
  const whyThread = 'the function is synchronous';
  return { triangulate, place: { thread: 'caller', whyThread, whyInlined } };
}

// Plain objects: bundlers leave them out where they are not used, unlike what a call returns.
const loadable3d: Loadable<Blocking<ReturnType<typeof createBlocking3d>>> = {
  start: () => blocking(wasm3d, code3d),
};
const loadable2d: Loadable<Blocking<ReturnType<typeof createBlocking2d>>> = {
  start: () => blocking(wasm2d, code2d),
};

const loadableConstraints: Loadable<Blocking<ReturnType<typeof createConstraining>>> = {
  start: () => blocking(wasmEdit, codeEdit),
};

/** Loads what {@link delaunay3dSync} needs. Later calls do nothing. */
export function load3d(): Promise<void> {
  return load(loadable3d);
}

/** Loads what {@link delaunay2dSync} and `Delaunator` need. Later calls do nothing. */
export function load2d(): Promise<void> {
  return load(loadable2d);
}

/** Loads what {@link delaunay2dSync} needs for constraints. Later calls do nothing. */
export function loadConstraints(): Promise<void> {
  return load(loadableConstraints);
}

/**
 * Returns the same as `delaunay3d`, computed in the calling thread by the CPU backend. For small
 * inputs, of which it saves the way to the worker and back, and for code that is in a worker anyway.
 *
 * ```ts
 * await load3d(); // once
 * const mesh = delaunay3dSync([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]);
 * ```
 *
 * @throws {@link GdelError} `NOT_LOADED` before the promise of {@link load3d} is fulfilled, and what
 * `delaunay3d` is rejected with.
 */
export function delaunay3dSync(points: Points, options?: SyncOptions): Mesh3;
export function delaunay3dSync<T>(
  points: ArrayLike<T>,
  options: SyncOptions & Pick<AccessorOptions<T>, 'point'>,
): Mesh3;
export function delaunay3dSync(points: unknown, options?: SyncOptions): Mesh3 {
  const { triangulate, place } = loaded(loadable3d, 'load3d');
  const outputs = outputsOf(optionsOf(options));
  const coordinates = coordinatesOf(points, 3, options);
  const arrays = thrown(() => triangulate(coordinates, outputs));
  const result = { ...arrays, points: coordinates };
  return new Mesh3({ result, place }, outputs, updating(sharedMaker('cpu'), IN_3D, {}, outputs));
}

/**
 * Returns the same as `delaunay2d`; see {@link delaunay3dSync}. Needs {@link load2d}, or with constraints
 * {@link loadConstraints}.
 */
export function delaunay2dSync(points: Points, options?: ConstraintOptions): Mesh2;
export function delaunay2dSync<T>(
  points: ArrayLike<T>,
  options: ConstraintOptions & Pick<AccessorOptions<T>, 'point'>,
): Mesh2;
export function delaunay2dSync(points: unknown, options?: object): Mesh2 {
  const update = updating(sharedMaker('cpu'), IN_2D, {});
  if (hasConstraints(optionsOf(options))) {
    const { triangulate, place } = loaded(loadableConstraints, 'loadConstraints');
    return new Mesh2({ result: thrown(() => triangulate(points, options!)), place }, update);
  }
  const { triangulate, place } = loaded(loadable2d, 'load2d');
  const coordinates = coordinatesOf(points, 2, options);
  const arrays = thrown(() => triangulate.mesh(coordinates));
  return new Mesh2({ result: { ...arrays, points: coordinates }, place }, update);
}

/** Returns the arrays alone, for coordinates that are not copied. */
export function triangulate2dNow(
  coordinates: Coordinates,
): Omit<Tasks['delaunay2d']['result'], 'points' | 'stats'> {
  const { triangulate } = loaded(loadable2d, 'Delaunator.load');
  return thrown(() => triangulate.arrays(coordinates));
}
