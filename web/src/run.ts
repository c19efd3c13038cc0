// Runs on points: triangulations from scratch, and updates of meshes whose points have moved.

import { codeEdit, module2d, module3d, moduleEdit } from '#assets';
import { isDetached } from './arrays.js';
import { builtin } from './builtin.js';
import type { Device } from './device.js';
import { GdelError, thrown } from './errors.js';
import type { Extras } from './extras.js';
import { bytesNow, type Held, isBuffer } from './held.js';
import { Host, type Sending } from './host.js';
import { memoryOf } from './memory.js';
import {
  checkArrays,
  checkBoolean,
  checkFunction,
  checkInteger,
  checkOneOf,
  hasConstraints,
  objectOf,
  optionsOf,
  taskOptions,
} from './options.js';
import { coordinatesInSlices, factorsOf, scaled } from './points.js';
import type { Done, Edit, MovedMesh, Task, Tasks } from './protocol.js';
import { loadCode, type ModuleAsset } from './runtime.js';
import type { UpdateStats } from './stats.js';
import { Stop, throwIfAborted } from './stop.js';
import type {
  AccessorOptions,
  Backend,
  ConstraintOptions,
  Output,
  RunOptions,
  Stats,
  TaskOptions,
  UpdateOptions,
} from './types.js';

export const BACKENDS: readonly Backend[] = ['auto', 'gpu', 'cpu'];

/** A dimension. Each constant names its own files alone, so that bundlers leave out the others. */
interface Kind<T extends Task> {
  task: T;
  asset: ModuleAsset;
  dimension: 2 | 3;
}

export const IN_3D: Kind<'delaunay3d'> = {
  task: 'delaunay3d',
  asset: module3d,
  dimension: 3,
};

export const IN_2D: Kind<'delaunay2d'> = {
  task: 'delaunay2d',
  asset: module2d,
  dimension: 2,
};

/** What makes meshes, and updates them later. */
export interface Maker {
  host: Host;
  backend: Backend;
  device?: Device | undefined;
}

let shared: Host | undefined;

/** Returns what all calls of functions share. */
export const sharedMaker = (backend: Backend): Maker => ({
  host: (shared ??= new Host()),
  backend,
});

export type AnyOptions = Omit<RunOptions, 'reuse'> &
  ConstraintOptions & {
    reuse?: object | undefined;
    point?: unknown;
  };

/** Triangulates points. What is small is copied before this returns. */
export async function triangulate<T extends Task>(
  maker: Maker,
  kind: Kind<T>,
  points: unknown,
  options: AnyOptions | undefined,
  outputs: readonly Output[] = [],
): Promise<Done<T>> {
  const job = await prepare(maker, kind, points, options);
  const { factors, weights, segments } = job;
  const { dimension } = kind;
  const { points: coordinates, backend } = job.args;
  const run = <E extends 'regular' | 'constrained'>(task: E, args: Tasks[E]['args']) =>
    maker.host.run(moduleEdit, task, args, job.sending, job.options);
  if (segments) {
    const done = await run('constrained', { points: coordinates, backend, segments });
    const { withConstraints } = await loadCode(codeEdit);
    return { ...done, result: withConstraints(done.result) } as unknown as Done<T>;
  }
  if (!weights) return { ...(await start(maker, kind, job, { outputs })), factors };
  const args = { dimension, points: coordinates, weights, outputs };
  const { result, ...made } = await run('regular', args);
  if (backend !== 'cpu')
    result.stats.fallback = 'the points are weighted, which only the CPU takes';
  // Equal weights have no effect.
  const done = { result, ...made, weights: result.hidden ? weights : null };
  return done as unknown as Done<T>;
}

/** Makes a mesh of points that have moved, or are new, from the mesh before and its statistics. */
export type Update<T extends Task> = {
  (
    points: unknown,
    options: UpdateOptions | undefined,
    moved: MovedMesh | Held,
    stats: Stats,
    edit?: Edit,
  ): Promise<Done<T>>;
  /** By which all points are multiplied, one per axis. */
  factors?: readonly number[] | undefined;
};

/** The statistics of an update from scratch, since the mesh is not on the GPU. */
const NOT_RESIDENT: UpdateStats = {
  inverted: 0,
  notLocallyDelaunay: 0,
  flips: 0,
  stars: 0,
  removed: 0,
  inserted: 0,
  onHost: false,
  restarted: 'not-resident',
};

/**
 * Returns what changes a mesh that a run with these options has made. A resident mesh is updated on
 * the device. The arrays of the CPU are made anew by an update, and edited by insertions and removals.
 * Arrays of the GPU are made anew by the first update; the device keeps their mesh for the next one.
 */
export function updating<T extends Task>(
  maker: Maker,
  kind: Kind<T>,
  made: AnyOptions | undefined,
  outputs: readonly Output[] = [],
  factors?: readonly number[],
): Update<T> {
  const { backend, resident, threads } = optionsOf(made);
  let key = 0;
  const update: Update<T> = async (points, given, moved, stats, edit) => {
    const { weights, radii } = optionsOf(given) as RunOptions;
    if (weights ?? radii)
      throw new GdelError('BAD_INPUT', 'this takes no weights: triangulate anew');
    const all = {
      ...optionsOf(given),
      backend,
      resident,
      threads,
      reuse: undefined,
      rescale: factors,
    };
    if (resident) {
      const job = await prepare(maker, kind, points, all);
      const done = await start(maker, kind, job, { outputs, moved: (moved as Held).resident.key });
      done.result.stats.update ??= NOT_RESIDENT;
      return done;
    }
    checkArrays({ ...moved, points: edit?.before });
    const job = await prepare(maker, kind, points, all);
    const { duplicateOf } = moved as MovedMesh;
    const { dimension } = kind;
    const count = job.args.points.length / dimension;
    if (!edit && Number.isInteger(count) && count !== duplicateOf.length)
      throw new GdelError('BAD_INPUT', `the mesh has ${duplicateOf.length} points, not ${count}`);
    // Only the module for edits knows about points that were removed.
    if (edit || duplicateOf.some((first, i) => first === i)) {
      const { points } = job.args;
      const args = { ...edit, dimension, points, mesh: moved as MovedMesh, outputs };
      const done = await maker.host.run(moduleEdit, 'change', args, job.sending, job.options);
      return done as unknown as Done<T>;
    }
    const done = await start(
      maker,
      kind,
      job,
      stats.backend === 'gpu' ? { outputs, key } : { outputs },
    );
    done.result.stats.update ??= NOT_RESIDENT;
    key = done.result.key ?? 0;
    return done;
  };
  update.factors = factors;
  return update;
}

/** A run whose arguments are checked. */
interface Job extends Extras {
  args: Tasks['delaunay2d']['args'];
  sending: Sending;
  options: TaskOptions;
  /** By which the points were multiplied. */
  factors: readonly number[] | undefined;
  /** The number of workers for a run by the CPU. */
  threads: number;
}

/** With fewer points for each worker, they take as long to start as they save. */
const POINTS_PER_WORKER = 50_000;
const MAX_WORKERS = 64;

/** Returns the number of workers for a run on so many points. */
function workersFor({ hasWorkers }: Host, points: number, wanted: number | undefined): number {
  if (wanted !== undefined) checkInteger('the option threads', wanted, 1, MAX_WORKERS);
  if (!hasWorkers) return 1;
  if (wanted !== undefined) return wanted;
  const processors =
    globalThis.navigator?.hardwareConcurrency ?? builtin('node:os')?.availableParallelism() ?? 1;
  return Math.max(1, Math.min(processors, MAX_WORKERS, Math.floor(points / POINTS_PER_WORKER)));
}

/** The last key of a mesh: meshes of instances that were replaced have keys of their own, too. */
let lastKey = 0;

/** Returns a key that no mesh has. */
export const nextKey = (): number => ++lastKey;

async function start<T extends Task>(
  maker: Maker,
  kind: Kind<T>,
  job: Job,
  more: { outputs?: readonly Output[]; moved?: number; key?: number },
): Promise<Done<T>> {
  const { args, sending, options, threads } = job;
  const isAlone =
    threads === 1 || args.resident || args.backend === 'gpu' || more.outputs?.includes('trace');
  const run = (leavesToWorkers: boolean) => {
    const all = { ...args, ...more, leavesToWorkers } as Tasks[T]['args'];
    return maker.host.run(kind.asset, kind.task, all, sending, options);
  };
  if (isAlone) return run(false);
  if (args.backend === 'auto') {
    const done = await run(true);
    if (!done.result.isLeft) return done;
    args.points = done.result.points;
    sending.transfer = [args.points.buffer, ...args.spare!.filter(({ byteLength }) => byteLength)];
    const joined = await together(maker, kind, job, more.outputs ?? []);
    const { fallback } = done.result.stats;
    if (joined) joined.result.stats.fallback = fallback;
    return joined ?? run(false);
  }
  return (await together(maker, kind, job, more.outputs ?? [])) ?? run(false);
}

/** Triangulates by several workers, or returns null and leaves the points to one if that is as fast. */
async function together<T extends Task>(
  { host }: Maker,
  kind: Kind<T>,
  job: Job,
  outputs: readonly Output[],
): Promise<Done<T> | null> {
  const { inWorkers } = await loadCode(codeEdit);
  const stop = new Stop(job.options);
  try {
    stop.throwIfStopped();
    const work = (hosts: readonly Host[]) =>
      inWorkers(hosts, moduleEdit, { ...kind, ...job, outputs }, stop);
    return (await host.together(job.threads, work)) as Done<T> | null;
  } catch (error) {
    // One needs less memory.
    if ((error as GdelError).code === 'OUT_OF_MEMORY' && !isDetached(job.args.points)) return null;
    throw error;
  } finally {
    stop.release();
  }
}

/** Returns the checked arguments of a run. What is small is copied before this returns. */
async function prepare(
  { host, backend: defaultBackend, device }: Maker,
  { dimension }: Kind<Task>,
  points: unknown,
  options: AnyOptions | undefined,
): Promise<Job> {
  const checked = optionsOf(options);
  const { backend = defaultBackend } = checked;
  let { transfer = false } = checked;
  const { resident = false, reuse, rescale } = checked;
  const task = taskOptions(checked);
  throwIfAborted(task.signal);
  checkOneOf('backend', backend, BACKENDS);
  checkBoolean('transfer', transfer);
  checkBoolean('resident', resident);
  if (resident && !device)
    throw new GdelError('BAD_INPUT', 'the option resident needs a triangulator with a device');
  const {
    points: _,
    coords: __,
    ...arrays
  } = objectOf<{ points?: unknown; coords?: unknown }>('the option reuse', reuse ?? {});
  checkFunction('point', checked.point);
  const point = checked.point as AccessorOptions<unknown>['point'] | undefined;
  if (device && isBuffer(points)) {
    const { buffer } = await bytesNow(device, points);
    points = new Float32Array(buffer);
    transfer = true;
  }
  transfer &&= !rescale;
  const given = await coordinatesInSlices(points, { dimension, transfer, point }, () =>
    throwIfAborted(task.signal),
  );
  let extras: Extras = { points: given };
  if (hasConstraints(checked) || (checked.weights ?? checked.radii) !== undefined) {
    const { extrasOf } = await loadCode(codeEdit);
    extras = thrown(() => extrasOf(checked, given, dimension));
  }
  const factors = factorsOf(rescale, given, dimension);
  const coordinates = scaled(extras.points, factors);
  const spare = resident ? [] : memoryOf(arrays);
  const sending: Sending = { transfer: [coordinates.buffer, ...spare], isGiven: transfer };
  const threads = workersFor(host, coordinates.length / dimension, checked.threads);
  const args = { points: coordinates, backend, resident, spare, newKey: nextKey() };
  return { ...extras, args, sending, options: task, factors, threads };
}
