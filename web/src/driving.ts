// Runs on the caller's device: the instance of the calling thread drives it, and that of a worker has the
// points.

import type { Indices } from './arrays.js';
import { PointCarrier, writeInSlices } from './carrier.js';
import { type Handlers, type ReportProgress, reporting } from './core.js';
import type { Engine } from './engine.js';
import { GPU_ERRORS, toPlainError } from './errors.js';
import { Memory } from './memory.js';
import { type Finished, type Made, simplexBytes } from './meshes.js';
import type { Control, CoreStats, Helper } from './protocol.js';
import type { RunArgs } from './running.js';
import type { Output } from './types.js';

export interface DriveOf {
  begin(carrier: PointCarrier, report: ReportProgress): Promise<Made>;
  /** Creates the buffers of a mesh that the caller fills. */
  room(counts: [simplices: number, hull: number], mesh: Finished): Promise<Made>;
}

/** Drives the device while a helper has the points, or has that triangulate them. */
export class Driver {
  readonly #engine: Engine;

  constructor(engine: Engine) {
    this.#engine = engine;
  }

  async run(args: RunArgs, control: Control, helper: Helper, of: DriveOf): Promise<any> {
    const { arrayMemory, kind, choice, memory, queue, speed } = this.#engine;
    const started = performance.now();
    const info = await choice.decide(args.backend, args.points, speed);
    const carrier = new PointCarrier(args.points, kind.dimension, helper, queue);
    const ready = new Memory(args.spare);
    let left: Partial<CoreStats> = {};
    let mesh: Finished | undefined;
    const { length } = args.points;
    if (info?.backend === 'gpu') {
      try {
        const made = await this.#onDevice(
          args,
          { carrier, ready, report: reporting(control) },
          of.begin,
        );
        if ('leftToCpu' in made) left = made.leftToCpu;
        else mesh = made;
      } catch (thrown) {
        const error = toPlainError(carrier.failure ?? thrown, memory.buffer.byteLength);
        // The CPU takes over from a device that failed.
        if (carrier.failure || args.backend === 'gpu' || !GPU_ERRORS.has(error.code))
          throw { ...error, points: carrier.points };
        const { wrongMeshes } = speed;
        left = { fallback: error.message, gpu: null, update: null, wrongMeshes };
      } finally {
        arrayMemory.release(length, simplexBytes(mesh));
      }
    }
    if (!mesh) {
      mesh = await this.#byHelper(args, carrier, helper, of.room);
      const { fallback, gpu, update, wrongMeshes } = { ...mesh.stats, ...left };
      mesh.stats = { ...mesh.stats, fallback, gpu, update, wrongMeshes };
    }
    const { readyBytes } = ready;
    const stats = this.#engine.complete(mesh.stats, { info, started, readyBytes });
    return { ...mesh, points: carrier.points, stats };
  }

  async #onDevice(
    { resident, moved, key, newKey, outputs = [] }: RunArgs,
    { carrier, ready, report }: { carrier: PointCarrier; ready: Memory; report: ReportProgress },
    begin: DriveOf['begin'],
  ): Promise<Finished | { leftToCpu: Partial<CoreStats> }> {
    const { arrayMemory, kind, meshes, triangulator } = this.#engine;
    const before = meshes.get(moved ?? key);
    const large = (outputs as string[]).includes(kind.arrays[1]) ? 2 : 1;
    if (!resident) arrayMemory.serve(ready, large, carrier.points.length);
    if (key === undefined) meshes.drop();
    const made = await carrier.use(() =>
      before ? before.drive(triangulator, carrier, report) : begin(carrier, report),
    );
    if (made.leftToCpu) return { leftToCpu: made.leftToCpu };
    const mesh = meshes.remember(made, newKey);
    if (resident) return mesh;
    const arrays = await meshes.keep(mesh, outputs, ready);
    if (key === undefined) {
      meshes.drop();
      delete arrays.key;
    }
    return arrays;
  }

  /** Has the helper triangulate. */
  async #byHelper(
    { resident = false, outputs = [], newKey }: RunArgs,
    carrier: PointCarrier,
    helper: Helper,
    room: DriveOf['room'],
  ): Promise<Finished> {
    const { arrays, task } = this.#engine.kind;
    const wanted = resident ? [...arrays, 'duplicateOf'] : outputs;
    const { points, ...mesh } = await helper.run(
      task,
      {
        points: carrier.points,
        backend: 'cpu',
        outputs: wanted as Output[],
        spare: [],
        newKey,
        vertexSimplex: resident,
      },
      [carrier.points.buffer],
    );
    carrier.points = points;
    return resident ? this.#upload(mesh as Finished, newKey, room) : (mesh as Finished);
  }

  /** Moves a mesh of the CPU to the device. */
  async #upload(mesh: Finished, key: number, room: DriveOf['room']): Promise<Finished> {
    const { kind, meshes, queue } = this.#engine;
    const arrays = [...kind.arrays, 'vertexSimplex'].map(
      (name) => mesh[name as 'tetrahedra' | 'hull' | 'vertexSimplex']!,
    );
    const [simplices, , hull] = arrays;
    const counts: [number, number] = [
      simplices!.length / kind.corners,
      hull!.length / kind.hullCorners,
    ];
    const { resident } = meshes.remember(await room(counts, mesh), key);
    for (const [i, array] of arrays.entries())
      await writeInSlices(resident!.buffers[i]!, array, queue());
    queue().submit([]);
    return { resident: resident!, stats: mesh.stats };
  }
}

/** The points of a run that another thread drives, in WebAssembly. */
interface Session {
  answer(kind: number, request: Uint32Array[]): Uint32Array[];
  free(): void;
}

/** Returns the tasks of a thread that has the points while another one drives the device. */
export function hosting(
  Session: new (points: object, report: ReportProgress) => Session,
): Handlers {
  let session: Session | undefined;
  return {
    async begin({ points }, control) {
      control.onBlocking();
      session?.free();
      session = undefined;
      session = new Session(points, reporting(control));
      return { points };
    },
    async answer({ kind, request }, control) {
      control.onBlocking();
      return { answer: session!.answer(kind, request) as Indices[] };
    },
    async end() {
      session?.free();
      session = undefined;
      return {};
    },
  };
}
