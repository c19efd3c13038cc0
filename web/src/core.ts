// The tasks, on the WebAssembly instances that carry them out: in a worker or in the calling thread.

import makeEngineGlue from 'glue:engine';
import makeToolsGlue from 'glue:tools';
import { toPlainError, type PlainError } from './errors.js';
import type { Control, CoreInfo, ModuleName, TaskName, Tasks } from './protocol.js';
import type { AdapterInfo, EngineName } from './types.js';

/** Below so many points, a device takes longer to start than the CPU engine to finish. */
export const FEW_POINTS = 20_000;

/** Progress is told at most so often: a message costs the page more than a phase is worth. */
const PROGRESS_MILLISECONDS = 20;

type Handlers = { [T in TaskName]?: (args: Tasks[T]['args'], control: Control) => Promise<Tasks[T]['result']> };

/** One WebAssembly instance and its tasks. */
export interface Core {
  /** Rejects with a {@link PlainError}. */
  run<T extends TaskName>(task: T, args: Tasks[T]['args'], control: Control): Promise<Tasks[T]['result']>;
  dispose(): void;
}

export function makeCore(name: ModuleName, module: WebAssembly.Module, gpu?: object): Core {
  const { handlers, memory, dispose } = name === 'engine' ? engineTasks(module, gpu) : toolsTasks(module);
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
  info: { vendor: string; architecture: string; device: string; description: string; isFallbackAdapter?: boolean };
  limits: { maxStorageBufferBindingSize: number; maxBufferSize: number };
}

/** The global object as wgpu wants to see it: that of a worker, with `gpu` as its `navigator.gpu`. */
function scopeWith(gpu: object): object {
  const scope: object = Object.create(globalThis);
  const values = { WorkerGlobalScope: Object, navigator: { gpu }, performance };
  for (const [key, value] of Object.entries(values)) Object.defineProperty(scope, key, { value });
  return scope;
}

function engineTasks(module: WebAssembly.Module, gpu: object | undefined) {
  const glue = makeEngineGlue(gpu ? scopeWith(gpu) : globalThis);
  const { memory } = glue.initSync({ module });

  type GpuEngine = InstanceType<typeof glue.GpuEngine>;
  let opening: Promise<GpuEngine> | undefined;

  /** The adapter, as far as there is one. */
  async function look(): Promise<AdapterInfo> {
    const none = (message: string): PlainError => ({ code: 'NO_ADAPTER', message, fatal: false });
    const api = (gpu ?? globalThis.navigator?.gpu) as Gpu | undefined;
    if (!api) throw none('WebGPU is not available here (there is no navigator.gpu)');
    const adapter = await api.requestAdapter({ powerPreference: 'high-performance' });
    if (!adapter) throw none('WebGPU has no adapter here');
    return describe(adapter);
  }

  /** The device with its kernels, which are compiled once, and again after it was lost. */
  function device(): Promise<GpuEngine> {
    opening ??= glue.GpuEngine.open().catch((thrown: unknown) => {
      opening = undefined;
      throw thrown;
    });
    return opening!;
  }

  function close(): void {
    void opening?.then((gpuEngine) => gpuEngine.destroy(), () => {});
    opening = undefined;
  }

  /** What `engine` would use. `auto` takes no adapter that is only software, and spends no time on compiling for it. */
  async function open(engine: EngineName): Promise<CoreInfo> {
    let adapter: AdapterInfo | null = null;
    try {
      adapter = await look();
      if (engine === 'auto' && adapter.software) {
        const name = [adapter.vendor, adapter.architecture, adapter.description].filter(Boolean).join(' ');
        return { engine: 'cpu', why: `the adapter (${name}) is software, slower than the CPU engine`, adapter };
      }
      await device();
      return { engine: 'gpu', why: null, adapter };
    } catch (thrown) {
      const error = toPlainError(thrown, memory.buffer.byteLength);
      if (engine === 'gpu' || error.fatal) throw thrown;
      return { engine: 'cpu', why: error.message, adapter };
    }
  }

  const infos: { [engine in EngineName]?: CoreInfo } = {};
  const opened = async (engine: EngineName) => (infos[engine] ??= await open(engine));

  const handlers: Handlers = {
    open: ({ engine }) => opened(engine),
    async delaunay3d({ points, engine, outputs }, control) {
      const started = performance.now();
      const wanted = () => new glue.Outputs(outputs.includes('neighbors'), outputs.includes('hull'), outputs.includes('duplicateOf'));
      const onProgress = (phase: string, fraction: number) => {
        control.onProgress({ phase, fraction });
        return control.isAborted();
      };
      const finish = (mesh: any, adapter: AdapterInfo | null, why: string | null) => ({
        points,
        tetrahedra: mesh.tetrahedra,
        neighbors: mesh.neighbors ?? new Int32Array(0),
        hull: mesh.hull ?? new Uint32Array(0),
        duplicateOf: mesh.duplicateOf ?? new Int32Array(0),
        dimension: mesh.dimension,
        stats: {
          ...mesh.stats,
          why: mesh.stats.why ?? why,
          adapter: mesh.stats.engine === 'gpu' ? adapter : null,
          milliseconds: performance.now() - started,
          wasmBytes: memory.buffer.byteLength,
        },
      });
      const onCpu = (why: string | null) => finish(glue.delaunay3d_cpu(points, wanted(), onProgress), null, why);

      if (engine === 'cpu') return onCpu(null);
      if (engine === 'auto' && points.length < 3 * FEW_POINTS) {
        return onCpu(`fewer than ${FEW_POINTS} points are faster on the CPU`);
      }
      const { engine: best, why, adapter } = await opened(engine);
      if (best === 'cpu') return onCpu(why);
      try {
        return finish(await (await device()).delaunay3d(points, wanted(), onProgress), adapter, null);
      } catch (thrown) {
        const { code, message, fatal } = toPlainError(thrown, memory.buffer.byteLength);
        if (code === 'DEVICE_LOST' || code === 'GPU') close();
        const unfit: string[] = ['DEVICE_LOST', 'GPU', 'NO_ADAPTER', 'OUT_OF_DEVICE_MEMORY', 'BUFFER_TOO_LARGE'];
        if (engine === 'gpu' || fatal || !unfit.includes(code)) throw thrown;
        return onCpu(message);
      }
    },
  };
  return { handlers, memory, dispose: close };
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
    software: info.isFallbackAdapter === true || software.test([vendor, architecture, device, description].join(' ')),
    maxStorageBufferBindingSize: Math.min(limits.maxStorageBufferBindingSize, limits.maxBufferSize),
  };
}

function toolsTasks(module: WebAssembly.Module) {
  const glue = makeToolsGlue(globalThis);
  const { memory } = glue.initSync({ module });

  function withMesh<R>({ points, mesh }: Tasks['verify']['args'], body: (mesh: any) => R): R {
    const copy = new glue.Mesh(points, mesh.tetrahedra, mesh.neighbors, mesh.hull, mesh.duplicateOf, mesh.dimension);
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

