// What 3D and 2D runs share: an instance, its triangulator, and the meshes on the device.

import { BackendChoice, type Gpu } from './adapter.js';
import type { Uses } from './core.js';
import type { Device, Queue } from './device.js';
import { GpuStandIn } from './gpu-stand-in.js';
import { type Instance, instantiate } from './instance.js';
import { ArrayMemory } from './memory.js';
import { ResidentMeshes } from './meshes.js';
import type { CoreInfo, CoreStats, Task } from './protocol.js';
import { COMPILES_MEANWHILE, Speed, type SpeedOf } from './speed.js';

/** What the dimensions differ in. */
export interface Kind<Glue extends AnyGlue = any> {
  task: Task;
  speed(triangulator: InstanceType<Glue['WasmTriangulator']>): SpeedOf;
  dimension: 3 | 2;
  /** The arrays of a mesh on the device, by their numbers. */
  arrays: readonly [string, string, string];
  /** The corners of a simplex, and the numbers of a facet of the hull. */
  corners: number;
  hullCorners: number;
  /** The bytes of the simplices per coordinate, about. */
  bytesPerCoordinate: number;
}

/** What the glue of both dimensions has. */
interface AnyGlue {
  WasmTriangulator: new (
    compilesMeanwhile: boolean,
    selfTest: boolean | undefined,
  ) => { close(): Promise<void> };
  initSync(module: { module: WebAssembly.Module }): object;
}

/** Returns a global object for wgpu: that of a worker, with `gpu` as its `navigator.gpu`. */
function scopeWith(gpu: object): object {
  const scope: object = Object.create(globalThis);
  const values = { WorkerGlobalScope: Object, navigator: { gpu }, performance };
  for (const [key, value] of Object.entries(values)) Object.defineProperty(scope, key, { value });
  return scope;
}

/** An instance that triangulates. */
export class Engine<Glue extends AnyGlue = AnyGlue> {
  readonly kind: Kind;
  readonly glue: Glue;
  readonly memory: WebAssembly.Memory;
  readonly triangulator: InstanceType<Glue['WasmTriangulator']>;
  readonly choice: BackendChoice;
  readonly speed: Speed;
  readonly meshes: ResidentMeshes;
  readonly arrayMemory: ArrayMemory;
  readonly device: Device | undefined;
  readonly #gpu: Gpu | undefined;
  readonly #standIn: GpuStandIn | undefined;

  constructor(kind: Kind, makeGlue: MakeGlue<Glue>, module: WebAssembly.Module, uses: Uses) {
    const { gpu, device, selfTest } = uses;
    this.kind = kind;
    this.arrayMemory = new ArrayMemory(kind.bytesPerCoordinate);
    this.device = device;
    this.#gpu = (gpu ?? globalThis.navigator?.gpu) as Gpu | undefined;
    // Nothing is to hold up the thread of a caller whose worker computes.
    this.#standIn = this.#gpu && new GpuStandIn(this.#gpu, !device);
    const scope = this.#standIn && scopeWith(this.#standIn);
    const instance: Instance<Glue> = instantiate(makeGlue, module, scope);
    this.glue = instance.glue;
    this.memory = instance.memory;
    // Outside of browsers nothing is remembered, so that everybody would wait for the test.
    this.triangulator = new this.glue.WasmTriangulator(
      COMPILES_MEANWHILE,
      selfTest ?? (COMPILES_MEANWHILE && !device ? undefined : false),
    ) as typeof this.triangulator;
    this.speed = new Speed(kind.dimension, kind.speed(this.triangulator));
    this.choice = new BackendChoice(this.#gpu, this.memory);
    this.meshes = new ResidentMeshes(kind.arrays, device);
  }

  /** The queue of the caller's device, by the way in which wgpu writes to it. */
  readonly queue = (): Queue => this.#standIn?.queue ?? this.device!.queue;

  /** Returns the statistics of a run with what is only known in JavaScript. */
  complete(
    stats: CoreStats,
    { info, started, readyBytes }: { info: CoreInfo | null; started: number; readyBytes: number },
  ): CoreStats {
    this.speed.keep();
    return {
      ...stats,
      threads: 1,
      fallback: stats.fallback ?? info?.fallback ?? null,
      adapter: stats.backend === 'gpu' ? (info?.adapter ?? null) : null,
      milliseconds: performance.now() - started,
      wasmBytes: this.memory.buffer.byteLength,
      readyBytes,
    };
  }

  dispose(): void {
    this.meshes.drop();
    this.arrayMemory.end();
    this.#standIn?.end();
    if (!this.#gpu?.isGiven) void this.triangulator.close();
  }
}
