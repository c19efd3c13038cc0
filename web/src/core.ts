// The tasks, on the WebAssembly instances that run them: in a worker or in the calling thread.

import makeGlue from 'glue';
import type { Coordinates } from './arrays.js';
import { type PlainError, toPlainError } from './errors.js';
import type { Control, CoreInfo, CoreStats, ModuleName, TaskName, Tasks } from './protocol.js';
import type { AdapterInfo, Backend, Output } from './types.js';

/** The shortest time between two progress reports, since each is a message to the page. */
const PROGRESS_MILLISECONDS = 20;

/** The tasks of a module. */
interface ModuleTasks {
  handlers: Handlers;
  memory: WebAssembly.Memory;
  dispose(): void;
}

const TASKS: Record<ModuleName, (module: WebAssembly.Module, gpu?: object) => ModuleTasks> = {
  d3: tasks3d,
  d2: tasks2d,
  tools: toolsTasks,
  derived: derivedTasks,
};

type Handlers = {
  [T in TaskName]?: (args: Tasks[T]['args'], control: Control) => Promise<Tasks[T]['result']>;
};

/** One WebAssembly instance and its tasks. */
export interface Core {
  /** Rejects with a {@link PlainError}. */
  run<T extends TaskName>(
    task: T,
    args: Tasks[T]['args'],
    control: Control,
  ): Promise<Tasks[T]['result']>;
  dispose(): void;
}

export function makeCore(name: ModuleName, module: WebAssembly.Module, gpu?: object): Core {
  const { handlers, memory, dispose } = TASKS[name](module, gpu);
  return {
    async run(task, args, control) {
      let last = -Infinity;
      const throttled: Control = {
        ...control,
        onProgress(progress) {
          const now = performance.now();
          if (now - last < PROGRESS_MILLISECONDS && progress.fraction < 1) return;
          last = now;
          control.onProgress(progress);
        },
      };
      try {
        const handler = handlers[task];
        if (!handler) throw new TypeError(`${name} has no task ${task}`);
        return await handler(args, throttled);
      } catch (thrown) {
        const error = toPlainError(thrown, memory.buffer.byteLength);
        // They go back, since the caller may have given them away.
        throw 'points' in args ? { ...error, points: args.points } : error;
      }
    },
    dispose,
  };
}

interface Gpu {
  /** Whether it stands for a device of the caller's, which is not given back. */
  isGiven?: boolean;
  requestAdapter(options: object): Promise<Adapter | null>;
}

interface Adapter {
  info: {
    vendor: string;
    architecture: string;
    device: string;
    description: string;
    isFallbackAdapter?: boolean;
  };
  limits: { maxStorageBufferBindingSize: number; maxBufferSize: number };
}

/** Returns a global object for wgpu: that of a worker, with `gpu` as its `navigator.gpu`. */
function scopeWith(gpu: object): object {
  const scope: object = Object.create(globalThis);
  const values = { WorkerGlobalScope: Object, navigator: { gpu }, performance };
  for (const [key, value] of Object.entries(values)) Object.defineProperty(scope, key, { value });
  return scope;
}

/** Returns an instance of a module with its own state, or throws a {@link PlainError}. */
function instantiate(
  name: ModuleName,
  module: WebAssembly.Module,
  scope: object = globalThis,
): { glue: any; memory: WebAssembly.Memory } {
  try {
    const glue = makeGlue(name, scope);
    return { glue, memory: glue.initSync({ module }).memory };
  } catch (error) {
    const why = `WebAssembly cannot be started: ${String(error)}`;
    if (error instanceof RangeError) throw { code: 'OUT_OF_MEMORY', message: why, fatal: true };
    const message = `${why}. Deploy all files of one version of gdel-wasm together`;
    throw { code: 'LOAD_FAILED', message, fatal: true } satisfies PlainError;
  }
}

/** What 3D and 2D tasks share: an instance, its triangulator, and the choice of the backend. */
function instance(name: 'd3' | 'd2', module: WebAssembly.Module, gpu: object | undefined) {
  const { glue, memory } = instantiate(name, module, gpu ? scopeWith(gpu) : globalThis);
  const triangulator = new glue.WasmTriangulator();
  let looking: Promise<AdapterInfo> | undefined;

  /** Looks for an adapter. */
  async function look(): Promise<AdapterInfo> {
    const none = (message: string): PlainError => ({ code: 'NO_ADAPTER', message, fatal: false });
    const api = (gpu ?? globalThis.navigator?.gpu) as Gpu | undefined;
    if (!api) throw none('WebGPU is not available here (there is no navigator.gpu)');
    try {
      const adapter = await api.requestAdapter({ powerPreference: 'high-performance' });
      if (adapter) return describe(adapter);
    } catch (error) {
      throw none(`WebGPU failed to look for an adapter: ${String(error)}`);
    }
    throw none('WebGPU has no adapter here');
  }

  /**
   * Returns what `backend` would use. The Rust library also chooses, but it does not see all names
   * of an adapter.
   */
  async function choose(backend: Backend): Promise<CoreInfo> {
    let adapter: AdapterInfo | null = null;
    try {
      adapter = await (looking ??= look());
      if (backend === 'auto' && adapter.software) {
        const name = [adapter.vendor, adapter.architecture, adapter.description]
          .filter(Boolean)
          .join(' ');
        return {
          backend: 'cpu',
          fallback: `the GPU adapter (${name}) is software, which is slower than the CPU backend`,
          adapter,
        };
      }
      return { backend: 'gpu', fallback: null, adapter };
    } catch (thrown) {
      looking = undefined;
      const error = toPlainError(thrown, memory.buffer.byteLength);
      if (backend === 'gpu' || error.fatal) throw thrown;
      return { backend: 'cpu', fallback: error.message, adapter };
    }
  }

  /** Triangulates, and adds to the mesh what is only known in JavaScript. */
  async function run(
    { points, backend }: { points: Coordinates; backend: Backend },
    minGpuCoordinates: number,
    control: Control,
    triangulate: (
      backend: Backend,
      report: (phase: string, fraction: number) => boolean,
    ) => Promise<any>,
  ): Promise<any> {
    const started = performance.now();
    const isDecided =
      backend === 'cpu' || (backend === 'auto' && points.length < minGpuCoordinates);
    const info = isDecided ? null : await choose(backend);
    if (isDecided || info?.backend === 'cpu') control.onBlocking();
    const mesh = await triangulate(info?.backend === 'cpu' ? 'cpu' : backend, (phase, fraction) => {
      control.onProgress({ phase, fraction });
      return control.isAborted();
    });
    const stats: CoreStats = {
      ...mesh.stats,
      fallback: mesh.stats.fallback ?? info?.fallback ?? null,
      adapter: mesh.stats.backend === 'gpu' ? (info?.adapter ?? null) : null,
      milliseconds: performance.now() - started,
      wasmBytes: memory.buffer.byteLength,
    };
    return { ...mesh, points, stats };
  }

  const dispose = () => {
    if (!(gpu as Gpu | undefined)?.isGiven) void triangulator.close();
  };
  return { glue, memory, triangulator, choose, run, dispose };
}

function tasks3d(module: WebAssembly.Module, gpu?: object): ModuleTasks {
  const { glue, memory, triangulator, choose, run, dispose } = instance('d3', module, gpu);

  const handlers: Handlers = {
    async open({ backend }) {
      const info = await choose(backend);
      if (info.backend === 'cpu') return info;
      try {
        await triangulator.open();
        return info;
      } catch (thrown) {
        const error = toPlainError(thrown, memory.buffer.byteLength);
        if (backend === 'gpu' || error.fatal) throw thrown;
        return { ...info, backend: 'cpu', fallback: error.message };
      }
    },

    async delaunay3d(args, control) {
      const minGpuCoordinates = 3 * glue.min_gpu_points_3d();
      const { points, outputs, resident = false } = args;
      const mesh = await run(args, minGpuCoordinates, control, (backend, report) =>
        triangulator.delaunay3d(points, backend, outputsOf(glue, outputs), resident, report),
      );
      return withEmpty(mesh);
    },
  };
  return { handlers, memory, dispose };
}

function outputsOf(glue: any, outputs: readonly Output[]): any {
  const has = (output: Output) => outputs.includes(output);
  return new glue.Outputs(has('neighbors'), has('hull'), has('duplicateOf'), has('trace'));
}

/** Adds empty arrays for those that were not requested. */
function withEmpty(mesh: any): any {
  mesh.neighbors ??= new Int32Array(0);
  mesh.hull ??= new Uint32Array(0);
  mesh.duplicateOf ??= new Int32Array(0);
  return mesh;
}

function tasks2d(module: WebAssembly.Module, gpu?: object): ModuleTasks {
  const { glue, memory, triangulator, run, dispose } = instance('d2', module, gpu);

  const handlers: Handlers = {
    delaunay2d(args, control) {
      const minGpuCoordinates = 2 * glue.min_gpu_points_2d();
      return run(args, minGpuCoordinates, control, (backend, report) =>
        triangulator.delaunay2d(args.points, backend, args.resident ?? false, report),
      );
    },
  };
  return { handlers, memory, dispose };
}

/** The arrays and the statistics of a triangulation. */
type Blocking<T extends 'delaunay3d' | 'delaunay2d'> = Omit<Tasks[T]['result'], 'points'>;

/**
 * Returns a function that triangulates in 3D with the CPU backend before it returns. It throws a
 * {@link PlainError}, and replaces an instance that broke.
 */
export function createBlocking3d(
  module: WebAssembly.Module,
): (points: Coordinates, outputs: readonly Output[]) => Blocking<'delaunay3d'> {
  const instance = blockingInstance('d3', module);
  return (points, outputs) =>
    instance((glue) => withEmpty(glue.delaunay3d_blocking(points, outputsOf(glue, outputs))));
}

/**
 * Does in 2D what {@link createBlocking3d} does in 3D, for callers that need the statistics and for
 * those that do not.
 */
export function createBlocking2d(module: WebAssembly.Module) {
  const instance = blockingInstance('d2', module);
  return {
    mesh: (points: Coordinates): Blocking<'delaunay2d'> =>
      instance((glue) => glue.delaunay2d_blocking(points, true)),
    arrays: (points: Coordinates): Omit<Blocking<'delaunay2d'>, 'stats'> =>
      instance((glue) => glue.delaunay2d_blocking(points, false)),
  };
}

function blockingInstance(name: 'd3' | 'd2', module: WebAssembly.Module) {
  const open = () => instantiate(name, module);
  let instance: ReturnType<typeof open> | undefined = open();
  return (triangulate: (glue: any) => any) => {
    const started = performance.now();
    const { glue, memory } = (instance ??= open());
    try {
      const mesh = triangulate(glue);
      if (mesh.stats) {
        mesh.stats.adapter = null;
        mesh.stats.milliseconds = performance.now() - started;
        mesh.stats.wasmBytes = memory.buffer.byteLength;
      }
      return mesh;
    } catch (thrown) {
      const error = toPlainError(thrown, memory.buffer.byteLength);
      if (error.fatal) instance = undefined;
      throw error;
    }
  };
}

/**
 * Describes an adapter. Chromium sets `isFallbackAdapter`; the names are those of the software
 * rasterisers of browsers, Mesa and Windows.
 */
function describe({ info, limits }: Adapter): AdapterInfo {
  const { vendor, architecture, device, description } = info;
  const software = /swiftshader|llvmpipe|lavapipe|softpipe|warp|basic render/i;
  return {
    vendor,
    architecture,
    device,
    description,
    software:
      info.isFallbackAdapter === true ||
      software.test([vendor, architecture, device, description].join(' ')),
    maxStorageBufferBindingSize: Math.min(limits.maxStorageBufferBindingSize, limits.maxBufferSize),
  };
}

function toolsTasks(module: WebAssembly.Module): ModuleTasks {
  const { glue, memory } = instantiate('tools', module);

  const tasks: { [T in TaskName]?: (args: Tasks[T]['args']) => Tasks[T]['result'] } = {
    readPoints: ({ bytes, extension }) => glue.read_points(bytes, extension),
    generate: ({ kind, count, seed }) => glue.generate3d(kind, count, seed),
    write: ({ points, mesh, format }) => glue.write3d(points, mesh, format),
    verify: ({ points, mesh }) => glue.verify3d(points, mesh),
    generate2d: ({ kind, count, seed }) => glue.generate2d(kind, count, seed),
    write2d: ({ points, mesh, format }) => glue.write2d(points, mesh, format),
    verify2d: ({ points, mesh }) => glue.verify2d(points, mesh),
  };
  const handlers = Object.entries(tasks).map(([name, task]) => [
    name,
    async (args: never, control: Control) => {
      control.onBlocking();
      return task(args);
    },
  ]);
  return { handlers: Object.fromEntries(handlers), memory, dispose() {} };
}

function derivedTasks(module: WebAssembly.Module): ModuleTasks {
  const { glue, memory } = instantiate('derived', module);
  type Report = (phase: string, fraction: number) => boolean;

  const tasks: {
    [T in TaskName]?: (args: Tasks[T]['args'], report: Report) => Tasks[T]['result'];
  } = {
    locate: ({ dimension, points, mesh, queries }, report) =>
      glue.locate(dimension, points, mesh, queries, report),
    nearest: ({ dimension, points, mesh, queries }, report) =>
      glue.nearest(dimension, points, mesh, queries, report),
    interpolate: ({ dimension, points, mesh, values, queries, method }, report) =>
      glue.interpolate(dimension, points, mesh, values, queries, method, report),
    voronoi: ({ dimension, points, mesh, clip, bounds }, report) =>
      glue.voronoi(dimension, points, mesh, clip, bounds, report),
    alphaShape: ({ dimension, points, mesh, alpha, components, criticalValues }, report) =>
      glue.alpha_shape(dimension, points, mesh, alpha, components, criticalValues, report),
    spanningTree: ({ dimension, points, mesh }, report) =>
      glue.spanning_tree(dimension, points, mesh, report),
  };
  const handlers = Object.entries(tasks).map(([name, task]) => [
    name,
    async (args: never, control: Control) => {
      control.onBlocking();
      let last = '';
      const result = task(args, (phase, fraction) => {
        last = phase;
        control.onProgress({ phase, fraction });
        return control.isAborted();
      });
      control.onProgress({ phase: last, fraction: 1 });
      return result;
    },
  ]);
  return { handlers: Object.fromEntries(handlers), memory, dispose() {} };
}
