// The tasks, on the WebAssembly instances that carry them out: in a worker or in the calling thread.

import makeEngineGlue from 'glue:engine';
import makePlaneGlue from 'glue:plane';
import makeToolsGlue from 'glue:tools';
import { type PlainError, toPlainError } from './errors.js';
import type {
  Control,
  Coordinates,
  CoreInfo,
  CoreStats,
  ModuleName,
  TaskName,
  Tasks,
} from './protocol.js';
import type { AdapterInfo, EngineName, Output } from './types.js';

/** Progress is told at most so often: a message costs the page more than a phase is worth. */
const PROGRESS_MILLISECONDS = 20;

/** What a module is able to do. */
interface ModuleTasks {
  handlers: Handlers;
  memory: WebAssembly.Memory;
  dispose(): void;
}

const TASKS: Record<ModuleName, (module: WebAssembly.Module, gpu?: object) => ModuleTasks> = {
  engine: engineTasks,
  plane: planeTasks,
  tools: toolsTasks,
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
        throw toPlainError(thrown, memory.buffer.byteLength);
      }
    },
    dispose,
  };
}

interface Gpu {
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

/** The global object as wgpu wants to see it: that of a worker, with `gpu` as its `navigator.gpu`. */
function scopeWith(gpu: object): object {
  const scope: object = Object.create(globalThis);
  const values = { WorkerGlobalScope: Object, navigator: { gpu }, performance };
  for (const [key, value] of Object.entries(values)) Object.defineProperty(scope, key, { value });
  return scope;
}

/** The choice between the engines of one module. */
function chooser(memory: WebAssembly.Memory, gpu: object | undefined) {
  let looking: Promise<AdapterInfo> | undefined;

  /** The adapter, as far as there is one. */
  async function look(): Promise<AdapterInfo> {
    const none = (message: string): PlainError => ({ code: 'NO_ADAPTER', message, fatal: false });
    const api = (gpu ?? globalThis.navigator?.gpu) as Gpu | undefined;
    if (!api) throw none('WebGPU is not available here (there is no navigator.gpu)');
    const adapter = await api.requestAdapter({ powerPreference: 'high-performance' });
    if (!adapter) throw none('WebGPU has no adapter here');
    return describe(adapter);
  }

  /** What `engine` would use. The crate makes the choice, but knows less of adapters: their names are not all told to it. */
  async function choose(engine: EngineName): Promise<CoreInfo> {
    let adapter: AdapterInfo | null = null;
    try {
      adapter = await (looking ??= look());
      if (engine === 'auto' && adapter.software) {
        const name = [adapter.vendor, adapter.architecture, adapter.description]
          .filter(Boolean)
          .join(' ');
        return {
          engine: 'cpu',
          why: `the adapter (${name}) is software, slower than the CPU engine`,
          adapter,
        };
      }
      return { engine: 'gpu', why: null, adapter };
    } catch (thrown) {
      looking = undefined;
      const error = toPlainError(thrown, memory.buffer.byteLength);
      if (engine === 'gpu' || error.fatal) throw thrown;
      return { engine: 'cpu', why: error.message, adapter };
    }
  }

  /** Chooses an engine if that is not decided, triangulates, and adds to the mesh what only this side knows. */
  async function run(
    points: Coordinates,
    engine: EngineName,
    isDecided: boolean,
    control: Control,
    triangulate: (
      engine: EngineName,
      report: (phase: string, fraction: number) => boolean,
    ) => Promise<any>,
  ): Promise<any> {
    const started = performance.now();
    const info = isDecided ? null : await choose(engine);
    const mesh = await triangulate(info?.engine === 'cpu' ? 'cpu' : engine, (phase, fraction) => {
      control.onProgress({ phase, fraction });
      return control.isAborted();
    });
    const stats: CoreStats = {
      ...mesh.stats,
      why: mesh.stats.why ?? info?.why ?? null,
      adapter: mesh.stats.engine === 'gpu' ? (info?.adapter ?? null) : null,
      milliseconds: performance.now() - started,
      wasmBytes: memory.buffer.byteLength,
    };
    return { ...mesh, points, stats };
  }

  return { choose, run };
}

function engineTasks(module: WebAssembly.Module, gpu?: object): ModuleTasks {
  const glue = makeEngineGlue(gpu ? scopeWith(gpu) : globalThis);
  const { memory } = glue.initSync({ module });
  const engines = new glue.WasmEngines();
  const leastGpuPoints: number = glue.least_gpu_points();
  const { choose, run } = chooser(memory, gpu);

  const handlers: Handlers = {
    async open({ engine }) {
      const info = await choose(engine);
      if (info.engine === 'cpu') return info;
      try {
        await engines.open();
        return info;
      } catch (thrown) {
        const error = toPlainError(thrown, memory.buffer.byteLength);
        if (engine === 'gpu' || error.fatal) throw thrown;
        return { ...info, engine: 'cpu', why: error.message };
      }
    },

    async delaunay3d({ points, engine, outputs }, control) {
      const has = (output: Output) => outputs.includes(output);
      const wanted = new glue.Outputs(
        has('neighbors'),
        has('hull'),
        has('duplicateOf'),
        has('trace'),
      );
      const isDecided =
        engine === 'cpu' || (engine === 'auto' && points.length < 3 * leastGpuPoints);
      const mesh = await run(points, engine, isDecided, control, (chosen, report) =>
        engines.delaunay3d(points, chosen, wanted, report),
      );
      const {
        neighbors = new Int32Array(0),
        hull = new Uint32Array(0),
        duplicateOf = new Int32Array(0),
      } = mesh;
      return { ...mesh, neighbors, hull, duplicateOf };
    },
  };
  return { handlers, memory, dispose: () => void engines.close() };
}

function planeTasks(module: WebAssembly.Module, gpu?: object): ModuleTasks {
  const glue = makePlaneGlue(gpu ? scopeWith(gpu) : globalThis);
  const { memory } = glue.initSync({ module });
  const engines = new glue.PlaneEngines();
  const leastGpuPoints: number = glue.least_gpu_points();
  const { run } = chooser(memory, gpu);

  const handlers: Handlers = {
    delaunay2d({ points, engine }, control) {
      const isDecided =
        engine === 'cpu' || (engine === 'auto' && points.length < 2 * leastGpuPoints);
      return run(points, engine, isDecided, control, (chosen, report) =>
        engines.delaunay2d(points, chosen, report),
      );
    },
  };
  return { handlers, memory, dispose: () => void engines.close() };
}

/** The arrays of a triangulation of the plane. */
export type Triangles = Pick<
  Tasks['delaunay2d']['result'],
  'triangles' | 'halfedges' | 'hull' | 'duplicateOf' | 'dimension'
>;

/** The CPU engine of the plane as a function that returns with the result. Throws a {@link PlainError}; a new instance takes
 * the place of one that broke. */
export function makeTriangulator(module: WebAssembly.Module): (points: Coordinates) => Triangles {
  let glue: any;
  let memory: WebAssembly.Memory | undefined;
  return (points) => {
    try {
      if (!glue) {
        glue = makePlaneGlue(globalThis);
        ({ memory } = glue.initSync({ module }));
      }
      return glue.delaunay2d_at_once(points);
    } catch (thrown) {
      const error = toPlainError(thrown, memory?.buffer.byteLength ?? 0);
      if (error.fatal) glue = undefined;
      throw error;
    }
  };
}

/** Chromium says `isFallbackAdapter`; the names are those of the software rasterisers that browsers and Mesa have. */
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
  const glue = makeToolsGlue(globalThis);
  const { memory } = glue.initSync({ module });

  function withMesh<R>({ points, mesh }: Tasks['verify']['args'], body: (mesh: any) => R): R {
    const copy = new glue.Mesh(
      points,
      mesh.tetrahedra,
      mesh.neighbors,
      mesh.hull,
      mesh.duplicateOf,
      mesh.dimension,
    );
    return freed(copy, body);
  }

  function withPlaneMesh<R>(
    { points, mesh }: Tasks['verify2d']['args'],
    body: (mesh: any) => R,
  ): R {
    const copy = new glue.PlaneMesh(
      points,
      mesh.triangles,
      mesh.halfedges,
      mesh.hull,
      mesh.duplicateOf,
      mesh.dimension,
    );
    return freed(copy, body);
  }

  function freed<R>(copy: { free(): void }, body: (mesh: any) => R): R {
    try {
      return body(copy);
    } finally {
      copy.free();
    }
  }

  const handlers: Handlers = {
    generate: async ({ kind, count, seed }) => glue.generate(kind, count, seed),
    readPoints: async ({ bytes, extension }) => glue.read_points(bytes, extension),
    write: async (args) => withMesh(args, (mesh) => mesh.write(args.format)),
    verify: async (args) => withMesh(args, (mesh) => mesh.verify()),
    generate2d: async ({ kind, count, seed }) => glue.generate2d(kind, count, seed),
    write2d: async (args) => withPlaneMesh(args, (mesh) => mesh.write(args.format)),
    verify2d: async (args) => withPlaneMesh(args, (mesh) => mesh.verify()),
  };
  return { handlers, memory, dispose() {} };
}

/** The buffers of a result that can change hands. */
export function buffersOf(value: unknown): ArrayBuffer[] {
  const found = new Set<ArrayBuffer>();
  const visit = (value: unknown) => {
    if (ArrayBuffer.isView(value)) {
      if (value.buffer instanceof ArrayBuffer) found.add(value.buffer);
    } else if (typeof value === 'object' && value) {
      Object.values(value).forEach(visit);
    }
  };
  visit(value);
  return [...found];
}
