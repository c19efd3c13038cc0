import { GdelError } from './errors.js';
import { Host, throwIfAborted } from './host.js';
import { Mesh3 } from './mesh.js';
import { ownCoordinates } from './points.js';
import type {
  AccessorOptions,
  EngineInfo,
  EngineName,
  EngineOptions,
  Output,
  Points,
  RunOptions,
} from './types.js';

const ALL_OUTPUTS: readonly Output[] = ['neighbors', 'hull', 'duplicateOf', 'trace'];
const DEFAULT_OUTPUTS = ALL_OUTPUTS.filter((output) => output !== 'trace');
const ENGINES: readonly EngineName[] = ['auto', 'gpu', 'cpu'];

/**
 * An engine with a worker and, where the GPU is used, a device of its own. Runs of one engine take place one after the
 * other. It stays usable after every error.
 */
export class Engine {
  readonly #host: Host;
  readonly #engine: EngineName;
  /** What `'auto'` works with, as found when the engine was made. */
  readonly info: EngineInfo;

  /** @internal */
  constructor(host: Host, engine: EngineName, info: EngineInfo) {
    this.#host = host;
    this.#engine = engine;
    this.info = info;
  }

  /** As the function {@link delaunay3d}. */
  delaunay3d(points: Points, options?: RunOptions): Promise<Mesh3>;
  delaunay3d<T>(points: ArrayLike<T>, options: AccessorOptions<T>): Promise<Mesh3>;
  delaunay3d(points: unknown, options: RunOptions = {}): Promise<Mesh3> {
    return triangulate(this.#host, points, { engine: this.#engine, ...options });
  }

  /** Ends the worker and gives the device back. Runs that are not finished fail with code `DISPOSED`. */
  dispose(): void {
    this.#host.dispose();
  }

  /** For `using engine = await createEngine()`, where the language has it. */
  declare [Symbol.dispose]: () => void;
}

// Not in the class: older engines lack the symbol.
if (Symbol.dispose) Engine.prototype[Symbol.dispose] = Engine.prototype.dispose;

/** Makes an engine: loads the WebAssembly module, starts the worker, and opens the GPU unless `engine` is `'cpu'`. */
export async function createEngine(options: EngineOptions = {}): Promise<Engine> {
  const { engine = 'auto', gpu, worker } = options;
  checkEngine(engine);
  const host = new Host('engine', { gpu, worker });
  try {
    if (engine !== 'cpu') return new Engine(host, engine, await host.run('open', { engine }, [], {}));
    // A run on no points shows that the engine works, and where.
    const args = { points: new Float64Array(0), engine, outputs: [] };
    const { thread, whyThread } = await host.run('delaunay3d', args, [], {});
    const why = 'the caller asked for it';
    return new Engine(host, engine, { engine, why, adapter: null, thread, whyThread });
  } catch (error) {
    host.dispose();
    throw error;
  }
}

let shared: Host | undefined;

/**
 * The 3D Delaunay triangulation of points: unique, exact, without flat tetrahedra, and with every distinct point in it.
 *
 * Works in a shared engine that is made on the first call. Coplanar, collinear, equal or no points are no error:
 * {@link Mesh3.dimension} says what they are.
 *
 * ```ts
 * const mesh = await delaunay3d(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]));
 * mesh.tetrahedra; // Uint32Array [ … ]
 * ```
 *
 * @throws {@link GdelError}, as a rejected promise.
 */
export function delaunay3d(points: Points, options?: RunOptions): Promise<Mesh3>;
export function delaunay3d<T>(points: ArrayLike<T>, options: AccessorOptions<T>): Promise<Mesh3>;
export function delaunay3d(points: unknown, options: RunOptions = {}): Promise<Mesh3> {
  return triangulate((shared ??= new Host('engine')), points, options);
}

async function triangulate(host: Host, points: unknown, options: RunOptions & { point?: unknown }): Promise<Mesh3> {
  const { signal, onProgress, transfer = false } = options;
  throwIfAborted(signal);
  const engine = options.engine ?? 'auto';
  const outputs = options.outputs ?? DEFAULT_OUTPUTS;
  checkEngine(engine);
  const unknown = Array.isArray(outputs) ? outputs.find((output) => !ALL_OUTPUTS.includes(output)) : outputs;
  if (unknown !== undefined) {
    throw new GdelError('BAD_INPUT', `outputs are among ${ALL_OUTPUTS.join(', ')}, not ${String(unknown)}`);
  }
  if (options.point !== undefined && typeof options.point !== 'function') {
    throw new GdelError('BAD_INPUT', 'the option point is a function');
  }
  const point = options.point as AccessorOptions<unknown>['point'] | undefined;
  const conversion = { dimension: 3, transfer, point, signal };
  const converted = ownCoordinates(points, conversion);
  const own = converted instanceof Promise ? await converted : converted;
  const args = { points: own.coordinates, engine, outputs };
  const { stats, thread, whyThread, ...arrays } = await host.run('delaunay3d', args, own.transfer, { signal, onProgress });
  return new Mesh3({ ...arrays, stats: { ...stats, thread, whyThread } }, outputs);
}

function checkEngine(engine: unknown): void {
  if (!ENGINES.includes(engine as EngineName)) {
    throw new GdelError('BAD_INPUT', `engines are ${ENGINES.join(', ')}, not ${String(engine)}`);
  }
}
