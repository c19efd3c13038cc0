// Runs of an instance that has the points.

import { type ReportProgress, reporting } from './core.js';
import type { Engine } from './engine.js';
import { GPU_ERRORS, type PlainError } from './errors.js';
import { Memory } from './memory.js';
import { type Finished, type Made, simplexBytes } from './meshes.js';
import type { Control, Tasks } from './protocol.js';

/** What runs have in common. */
export type RunArgs = Tasks['delaunay2d']['args'];

/** What a triangulation is to do. */
export interface Wanted {
  backend: string;
  /** Whether the mesh stays on the device. */
  onDevice: boolean;
  /** Returns memory for an array. */
  take: Memory['take'];
  report: ReportProgress;
}

export interface RunOf {
  /** How many of the large arrays are wanted: simplices and neighbours. */
  large: number;
  triangulate(wanted: Wanted): Promise<Made>;
}

/** Triangulates, and adds to the meshes what is only known in JavaScript. */
export class Runner {
  readonly #engine: Engine;

  constructor(engine: Engine) {
    this.#engine = engine;
  }

  async run(args: RunArgs, control: Control, of: RunOf): Promise<any> {
    const { choice, meshes, arrayMemory, speed } = this.#engine;
    const started = performance.now();
    const { points, backend, resident = false, spare, key } = args;
    const info = await choice.decide(backend, points, speed);
    const isOnGpu = info?.backend === 'gpu';
    if (!isOnGpu && args.leavesToWorkers)
      return { points, isLeft: true, stats: { fallback: info?.fallback ?? null } };
    if (!isOnGpu) control.onBlocking();
    const ready = new Memory(spare);
    if (isOnGpu && !resident) arrayMemory.serve(ready, of.large, points.length);
    const wanted: Wanted = {
      backend: info?.backend === 'cpu' ? 'cpu' : backend,
      onDevice: resident,
      take: ready.take,
      report: reporting(control),
    };
    let mesh: Finished | undefined;
    try {
      if (isOnGpu && key !== undefined) {
        mesh = await this.#updateArrays(args, wanted, of, ready);
      } else {
        meshes.drop();
        mesh = await this.#runOrUpdate(args, wanted, of);
      }
    } finally {
      arrayMemory.release(points.length, isOnGpu && !resident ? simplexBytes(mesh) : undefined);
    }
    const { readyBytes } = ready;
    const stats = this.#engine.complete(mesh.stats, { info, started, readyBytes });
    return { ...mesh, points, stats };
  }

  /** Returns a mesh from scratch, or from the one before. */
  async #runOrUpdate(args: RunArgs, wanted: Wanted, of: RunOf): Promise<Finished> {
    const { meshes, triangulator } = this.#engine;
    const { backend, report } = wanted;
    const before = meshes.get(args.moved ?? args.key);
    const made = await (before?.update(triangulator, args.points, backend, report) ??
      of.triangulate(wanted));
    return meshes.remember(made, args.newKey);
  }

  /** Returns the arrays of a mesh of which the device keeps a copy for the next update. */
  async #updateArrays(args: RunArgs, wanted: Wanted, of: RunOf, ready: Memory): Promise<Finished> {
    const { meshes } = this.#engine;
    try {
      const made = await this.#runOrUpdate(args, { ...wanted, onDevice: true }, of);
      return await meshes.keep(made, args.outputs!, ready);
    } catch (error) {
      // The CPU takes over from a device that failed, without which nothing can be kept.
      if (args.backend === 'gpu' || !GPU_ERRORS.has((error as PlainError).code)) throw error;
      return meshes.remember(await of.triangulate({ ...wanted, onDevice: false }), args.newKey);
    }
  }
}
