// The tasks, on the WebAssembly instances that run them: in a worker or in the calling thread.

import makeGlue from 'glue';
import type { Coordinates } from './arrays.js';
import { PointCarrier, writeInSlices } from './carrier.js';
import type { Device } from './device.js';
import { GPU_ERRORS, type PlainError, toPlainError } from './errors.js';
import { bytesOf } from './held.js';
import { Memory, MemoryThreads } from './memory.js';
import type {
  Control,
  CoreInfo,
  CoreStats,
  Helper,
  MadeResident,
  ModuleName,
  Task,
  TaskName,
  Tasks,
} from './protocol.js';
import type { AdapterInfo, Backend, Output } from './types.js';
import { wgpuCalls } from './wgpu-calls.js';

/** The shortest time between two progress reports, since each is a message to the page. */
const PROGRESS_MILLISECONDS = 20;

/** The tasks of a module. */
interface ModuleTasks {
  handlers: Handlers;
  memory: WebAssembly.Memory;
  dispose(): void;
  free?(key: number): void;
}

/** The device that an instance uses. */
interface Uses {
  /** The GPU object in which wgpu looks for it. */
  gpu?: object | undefined;
  /** The caller's device, while a worker has the points. */
  device?: Device | undefined;
}

const TASKS: Record<ModuleName, (module: WebAssembly.Module, uses: Uses) => ModuleTasks> = {
  d3: tasks3d,
  d2: tasks2d,
  edit: editTasks,
  tools: toolsTasks,
  derived: derivedTasks,
};

type Handlers = {
  [T in TaskName]?: (
    args: Tasks[T]['args'],
    control: Control,
    helper?: Helper,
  ) => Promise<Tasks[T]['result']>;
};

/** One WebAssembly instance and its tasks. */
export interface Core {
  /** Rejects with a {@link PlainError}. */
  run<T extends TaskName>(
    task: T,
    args: Tasks[T]['args'],
    control: Control,
    helper?: Helper,
  ): Promise<Tasks[T]['result']>;
  dispose(): void;
  /** Frees a mesh that stays on the caller's device. */
  free(key: number): void;
}

/**
 * Creates the core of a module. With a `gpu`, it uses that, and with the caller's `device` in it, only drives
 * that: a helper has to compute.
 */
export function makeCore(
  name: ModuleName,
  module: WebAssembly.Module,
  gpu?: object,
  device?: Device,
): Core {
  const { handlers, memory, dispose, free } = TASKS[name](module, { gpu, device });
  return {
    async run(task, args, control, helper) {
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
        return await handler(args, throttled, helper);
      } catch (thrown) {
        const error = toPlainError(thrown, memory.buffer.byteLength);
        // They go back, since the caller may have given them away.
        throw 'points' in args ? { points: args.points, ...error } : error;
      }
    },
    dispose,
    free: (key) => free?.(key),
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
  calls?: object,
): { glue: any; memory: WebAssembly.Memory } {
  try {
    const glue = makeGlue(name, calls, scope);
    const { memory } = glue.initSync({ module });
    return { glue, memory };
  } catch (error) {
    const why = `WebAssembly cannot be started: ${String(error)}`;
    if (error instanceof RangeError) throw { code: 'OUT_OF_MEMORY', message: why, fatal: true };
    const message = `${why}. Deploy all files of one version of gdel-wasm together`;
    throw { code: 'LOAD_FAILED', message, fatal: true } satisfies PlainError;
  }
}

type Report = (phase: string, fraction: number) => boolean;

/** Returns the function that WebAssembly calls with its progress. */
const reporting =
  (control: Control): Report =>
  (phase, fraction) => {
    control.onProgress({ phase, fraction });
    return control.isAborted();
  };

/** A mesh on the device. */
interface WasmMesh {
  drive(triangulator: object, carrier: PointCarrier, report: Report): Promise<any>;
  read(array: number, memory: (bytes: number) => Uint8Array): Promise<Uint8Array<ArrayBuffer>>;
  update(triangulator: object, points: Coordinates, backend: string, report: Report): Promise<any>;
  free(): void;
}

/** The arrays of meshes on the device, by their numbers. */
const ARRAYS = {
  d3: ['tetrahedra', 'neighbors', 'hull'],
  d2: ['triangles', 'halfedges', 'hull'],
};

/** What runs have in common. */
type RunArgs = Tasks['delaunay2d']['args'];

/** What 3D and 2D tasks share: an instance, its triangulator, and the choice of the backend. */
function instance(name: 'd3' | 'd2', module: WebAssembly.Module, { gpu, device }: Uses) {
  // Nothing is to hold up the thread of a caller whose worker computes.
  const calls = wgpuCalls(!device);
  const scope = gpu ? scopeWith(gpu) : globalThis;
  const { glue, memory } = instantiate(name, module, scope, calls);
  const triangulator = new glue.WasmTriangulator();
  let looking: Promise<AdapterInfo> | undefined;
  const memoryThreads = new MemoryThreads();
  /** The meshes on the device, by their keys. */
  const meshes = new Map<number, WasmMesh>();
  /** The mesh of the last run, if that was an update of arrays: the next one goes on from it. */
  let kept: MadeResident | undefined;
  /** Of the simplices: there are 6.8 per uniform point in 3D, and less than 2 per point in 2D. */
  let bytesPerCoordinate = name === 'd3' ? (7 * 16) / 3 : (2 * 12) / 2;

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

  /** Returns what `backend` uses for these points, or null where it is the CPU without looking for an adapter. */
  const decide = (
    backend: Backend,
    { length }: Coordinates,
    minGpuCoordinates: number,
  ): Promise<CoreInfo> | null => {
    const isCpu = backend === 'cpu' || (backend === 'auto' && length < minGpuCoordinates);
    return isCpu ? null : choose(backend);
  };

  /** Returns the statistics of a run with what is only known in JavaScript. */
  const complete = (
    stats: any,
    info: CoreInfo | null,
    started: number,
    { readyBytes }: Memory,
  ): CoreStats => ({
    ...stats,
    fallback: stats.fallback ?? info?.fallback ?? null,
    adapter: stats.backend === 'gpu' ? (info?.adapter ?? null) : null,
    milliseconds: performance.now() - started,
    wasmBytes: memory.buffer.byteLength,
    readyBytes,
  });

  /**
   * Triangulates, and adds to the mesh what is only known in JavaScript. Of its arrays, `large` are
   * those of simplices and neighbours.
   */
  async function run(
    { points, backend, resident, spare, moved, key, newKey, outputs }: RunArgs,
    minGpuCoordinates: number,
    large: number,
    control: Control,
    triangulate: (
      backend: Backend,
      resident: boolean,
      take: (bytes: number) => Uint8Array,
      report: Report,
    ) => Promise<any>,
  ): Promise<any> {
    const started = performance.now();
    const info = await decide(backend, points, minGpuCoordinates);
    const isOnGpu = info?.backend === 'gpu';
    if (!isOnGpu) control.onBlocking();
    const ready = new Memory(spare);
    if (isOnGpu && !resident && !spare?.length)
      memoryThreads.serve(ready, large, Math.ceil(bytesPerCoordinate * points.length));
    const report = reporting(control);
    const chosen = info?.backend === 'cpu' ? 'cpu' : backend;
    // A mesh of an instance that broke is of no use to this one, and not known here.
    const before = meshes.get(moved ?? key!);
    const run = (onDevice: boolean) => triangulate(chosen, onDevice, ready.take, report);
    const runOrUpdate = async (onDevice: boolean) => {
      const made = await (before?.update(triangulator, points, chosen, report) ?? run(onDevice));
      if (made.resident) remember(made, newKey);
      return made;
    };
    let mesh: any;
    try {
      if (isOnGpu && key !== undefined) {
        try {
          mesh = await keep(await runOrUpdate(true), outputs!, ready);
        } catch (error) {
          // The CPU takes over from a device that failed, without which nothing can be kept.
          if (backend === 'gpu' || !GPU_ERRORS.has((error as PlainError).code)) throw error;
          mesh = await run(false);
        }
      } else {
        drop();
        mesh = await runOrUpdate(resident ?? false);
      }
    } finally {
      memoryThreads.release();
    }
    const { byteLength } = mesh.tetrahedra ?? mesh.triangles ?? points;
    // The next run may have a few more of them.
    if (isOnGpu && !resident) bytesPerCoordinate = (1.02 * byteLength) / (points.length || 1);
    return { ...mesh, points, stats: complete(mesh.stats, info, started, ready) };
  }

  /** Frees what the device keeps. */
  function drop(): void {
    if (!kept) return;
    for (const buffer of kept.buffers) (buffer as { destroy(): void }).destroy();
    free(kept.key);
    kept = undefined;
  }

  function free(key: number): void {
    meshes.get(key)?.free();
    meshes.delete(key);
  }

  /** Returns those arrays of a mesh on the device that are wanted, and always the simplices. */
  async function read(
    { buffers, counts }: MadeResident,
    mesh: WasmMesh,
    outputs: readonly string[],
    { take }: Memory,
  ): Promise<any> {
    const arrays = ARRAYS[name].map(async (array, i) => {
      if (i > 0 && !outputs.includes(array)) return [];
      const size = counts[i === 2 ? 1 : 0] && buffers[i]!.size;
      const { buffer, length } = await (device
        ? bytesOf(device, buffers[i]!, size, take)
        : mesh.read(i, take));
      return [[array, new (i === 1 ? Int32Array : Uint32Array)(buffer, 0, length / 4)]];
    });
    return Object.fromEntries((await Promise.all(arrays)).flat());
  }

  /** Returns the arrays of a mesh on the device, which keeps it. */
  async function keep(made: any, outputs: readonly string[], ready: Memory): Promise<any> {
    const resident = made.resident as MadeResident;
    const { dimension, duplicateOf, key } = resident;
    const arrays = await read(resident, meshes.get(key)!, outputs, ready);
    drop();
    kept = resident;
    if (outputs.includes('duplicateOf')) arrays.duplicateOf = duplicateOf;
    return { ...arrays, dimension, stats: made.stats, key };
  }

  /** Remembers the mesh that a run has left on the device. */
  function remember(made: any, key: number): void {
    const { mesh, ...resident } = made.resident;
    made.resident = { ...resident, key };
    meshes.set(key, mesh);
  }

  /** Drives the device, while the helper has the points; or has it triangulate them. */
  async function drive(
    task: Task,
    args: RunArgs,
    minGpuCoordinates: number,
    control: Control,
    helper: Helper,
    begin: (carrier: PointCarrier, report: Report) => Promise<any>,
  ): Promise<any> {
    const started = performance.now();
    const { backend, resident, spare, moved, key, newKey, outputs = [] } = args;
    const info = await decide(backend, args.points, minGpuCoordinates);
    const carrier = new PointCarrier(
      args.points,
      helper,
      device!,
      name === 'd3' ? 3 : 2,
      calls.writeBuffer,
    );
    const ready = new Memory(spare);
    const report = reporting(control);
    let left: { fallback: string | null; gpu: null; update: null } | undefined;
    let mesh: any;
    if (info?.backend === 'gpu') {
      const before = meshes.get(moved ?? key!);
      if (key === undefined) drop();
      try {
        const made = await carrier.use(() =>
          before ? before.drive(triangulator, carrier, report) : begin(carrier, report),
        );
        left = made.leftToCpu;
        if (!left) {
          remember(made, newKey);
          mesh = made;
          if (!resident) {
            mesh = await keep(made, outputs, ready);
            if (made.trace) mesh.trace = made.trace;
            if (key === undefined) {
              drop();
              delete mesh.key;
            }
          }
        }
      } catch (thrown) {
        const error = toPlainError(carrier.failure ?? thrown, memory.buffer.byteLength);
        // The CPU takes over from a device that failed.
        if (carrier.failure || backend === 'gpu' || !GPU_ERRORS.has(error.code))
          throw { ...error, points: carrier.points };
        left = { fallback: error.message, gpu: null, update: null };
      }
    }
    if (!mesh) {
      mesh = await helper.run(
        task,
        {
          points: carrier.points,
          backend: 'cpu',
          outputs: (resident ? [...ARRAYS[name], 'duplicateOf'] : outputs) as Output[],
          spare: [],
          newKey,
          vertexSimplex: resident ?? false,
        },
        [carrier.points.buffer],
      );
      carrier.points = mesh.points;
      if (resident) mesh = await upload(mesh, newKey);
      const { fallback, gpu, update } = { ...mesh.stats, ...left };
      mesh.stats = { ...mesh.stats, fallback, gpu, update };
    }
    return { ...mesh, points: carrier.points, stats: complete(mesh.stats, info, started, ready) };
  }

  /** Moves a mesh of the CPU to the device. */
  async function upload(mesh: any, key: number): Promise<any> {
    const [simplices, neighbors, hull] = ARRAYS[name].map((array) => mesh[array]);
    const [corners, ofHull] = name === 'd3' ? [4, 3] : [3, 1];
    const room = name === 'd3' ? triangulator.room3d : triangulator.room2d;
    const { duplicateOf, dimension } = mesh;
    const lens = [simplices.length / corners, hull.length / ofHull];
    const made = await room.call(triangulator, ...lens, duplicateOf, dimension);
    remember(made, key);
    for (const [i, array] of [simplices, neighbors, hull, mesh.vertexSimplex].entries())
      await writeInSlices(made.resident.buffers[i], array, device!.queue, calls.writeBuffer);
    device!.queue.submit([]);
    return { resident: made.resident, stats: mesh.stats };
  }

  // The points of a run that another thread drives.
  let session: any;
  const hosting: Handlers = {
    async begin({ points }, control) {
      control.onBlocking();
      session?.free();
      session = undefined;
      session = new (name === 'd3' ? glue.Session3 : glue.Session2)(points, reporting(control));
      return { points };
    },
    async answer({ kind, request }, control) {
      control.onBlocking();
      return { answer: session.answer(kind, request) };
    },
    async end() {
      session?.free();
      session = undefined;
      return {};
    },
  };

  const dispose = () => {
    drop();
    memoryThreads.end();
    calls.end();
    if (!(gpu as Gpu | undefined)?.isGiven) void triangulator.close();
  };
  return { glue, memory, triangulator, choose, run, drive, hosting, dispose, free };
}

function tasks3d(module: WebAssembly.Module, uses: Uses): ModuleTasks {
  const { glue, memory, triangulator, choose, run, drive, hosting, ...rest } = instance(
    'd3',
    module,
    uses,
  );

  const handlers: Handlers = {
    ...hosting,

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

    async delaunay3d(args, control, helper) {
      const minGpuCoordinates = 3 * glue.min_gpu_points_3d();
      const { points, outputs, vertexSimplex } = args;
      if (helper) {
        const begin = (carrier: PointCarrier, report: Report) =>
          triangulator.drive3d(carrier, outputs.includes('trace'), report);
        return withEmpty(
          await drive('delaunay3d', args, minGpuCoordinates, control, helper, begin),
        );
      }
      const large = outputs.includes('neighbors') ? 2 : 1;
      const mesh = await run(args, minGpuCoordinates, large, control, (backend, ...to) =>
        triangulator.delaunay3d(points, backend, outputsOf(glue, outputs, vertexSimplex), ...to),
      );
      return withEmpty(mesh);
    },
  };
  return { handlers, memory, ...rest };
}

function outputsOf(glue: any, outputs: readonly Output[], vertexSimplex = false): any {
  const has = (output: Output) => outputs.includes(output);
  const wanted = [has('neighbors'), has('hull'), has('duplicateOf'), has('trace')];
  return new glue.Outputs(...wanted, vertexSimplex);
}

/** Adds empty arrays for those that were not requested. */
function withEmpty(mesh: any): any {
  mesh.neighbors ??= new Int32Array(0);
  mesh.hull ??= new Uint32Array(0);
  mesh.duplicateOf ??= new Int32Array(0);
  return mesh;
}

function tasks2d(module: WebAssembly.Module, uses: Uses): ModuleTasks {
  const { glue, memory, triangulator, choose, run, drive, hosting, ...rest } = instance(
    'd2',
    module,
    uses,
  );

  const handlers: Handlers = {
    ...hosting,

    delaunay2d(args, control, helper) {
      const minGpuCoordinates = 2 * glue.min_gpu_points_2d();
      const all = { ...args, outputs: [...ARRAYS.d2, 'duplicateOf'] };
      if (helper)
        return drive('delaunay2d', all, minGpuCoordinates, control, helper, (...to) =>
          triangulator.drive2d(...to),
        );
      return run(all, minGpuCoordinates, 2, control, (backend, ...to) =>
        triangulator.delaunay2d(args.points, backend, args.vertexSimplex ?? false, ...to),
      );
    },
  };
  return { handlers, memory, ...rest };
}

/** Meshes in the memory of the CPU that gain and lose points. */
function editTasks(module: WebAssembly.Module): ModuleTasks {
  const { glue, memory } = instantiate('edit', module);
  const handlers: Handlers = {
    async change({ dimension, points, before, mesh: given, removed, outputs }, control) {
      const started = performance.now();
      control.onBlocking();
      const mesh = glue.change(
        dimension,
        points,
        before,
        given,
        removed,
        outputsOf(glue, outputs),
        reporting(control),
      );
      if (dimension === 3) withEmpty(mesh);
      return { points, ...mesh, stats: statsOf(mesh.stats, started, memory) };
    },
  };
  return { handlers, memory, dispose() {} };
}

/** Returns the statistics of the CPU with what is only known in JavaScript. */
const statsOf = (stats: object, started: number, memory: WebAssembly.Memory) => ({
  ...stats,
  adapter: null,
  milliseconds: performance.now() - started,
  wasmBytes: memory.buffer.byteLength,
  readyBytes: 0,
});

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
      if (mesh.stats) mesh.stats = statsOf(mesh.stats, started, memory);
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

/** The tasks that derive something from a mesh. */
type DerivedTask =
  | 'locate'
  | 'nearest'
  | 'interpolate'
  | 'voronoi'
  | 'alphaShape'
  | 'spanningTree'
  | 'topology'
  | 'geometry';

function derivedTasks(module: WebAssembly.Module): ModuleTasks {
  const { glue, memory } = instantiate('derived', module);
  const tasks: {
    [T in DerivedTask]: (args: Tasks[T]['args'], report: Report) => Tasks[T]['result'];
  } = {
    locate: ({ dimension, points, mesh, queries }, report) =>
      glue.locate(dimension, points, mesh, queries, report),
    nearest: ({ dimension, points, mesh, queries, k }, report) =>
      glue.nearest(dimension, points, mesh, queries, k, report),
    interpolate: ({ dimension, points, mesh, queries, values, method }, report) =>
      glue.interpolate(dimension, points, mesh, queries, values, method, report),
    voronoi: ({ dimension, points, mesh, clip, bounds }, report) =>
      glue.voronoi(dimension, points, mesh, clip, bounds, report),
    alphaShape: ({ dimension, points, mesh, alpha, components, criticalValues }, report) =>
      glue.alphaShape(dimension, points, mesh, alpha, components, criticalValues, report),
    spanningTree: ({ dimension, points, mesh }, report) =>
      glue.spanningTree(dimension, points, mesh, report),
    topology: ({ dimension, points, mesh }, report) =>
      glue.topology(dimension, points, mesh, report),
    geometry: ({ dimension, points, mesh }, report) =>
      glue.geometry(dimension, points, mesh, report),
  };
  const handlers = Object.entries(tasks).map(([name, task]) => [
    name,
    async (args: never, control: Control) => {
      control.onBlocking();
      let last = '';
      const reported = reporting(control);
      const report: Report = (phase, fraction) => reported((last = phase), fraction);
      const result = task(args, report);
      control.onProgress({ phase: last, fraction: 1 });
      return result;
    },
  ]);
  return { handlers: Object.fromEntries(handlers), memory, dispose() {} };
}
