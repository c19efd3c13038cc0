import { GdelError } from './errors.js';
import { Host, throwIfAborted } from './host.js';
import { Mesh3 } from './mesh.js';
import { Mesh2 } from './mesh2.js';
import { ownCoordinates } from './points.js';
import type {
  AccessorOptions,
  EngineInfo,
  EngineName,
  EngineOptions,
  Output,
  PlaneOptions,
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

  /** As the function {@link delaunay2d}. */
  delaunay2d(points: Points, options?: PlaneOptions): Promise<Mesh2>;
  delaunay2d<T>(
    points: ArrayLike<T>,
    options: PlaneOptions & Pick<AccessorOptions<T>, 'point'>,
  ): Promise<Mesh2>;
  delaunay2d(points: unknown, options: PlaneOptions = {}): Promise<Mesh2> {
    return triangulatePlane(this.#host, points, { engine: this.#engine, ...options });
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
  const host = new Host({ gpu, worker });
  try {
    if (engine !== 'cpu')
      return new Engine(host, engine, await host.run('open', { engine }, [], {}));
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
  return triangulate((shared ??= new Host()), points, options);
}

/**
 * The 2D Delaunay triangulation of points x, y, x, y, … or of rows: as {@link delaunay3d} in the plane, with the arrays of
 * the npm package `delaunator`.
 *
 * @throws {@link GdelError}, as a rejected promise.
 */
export function delaunay2d(points: Points, options?: PlaneOptions): Promise<Mesh2>;
export function delaunay2d<T>(
  points: ArrayLike<T>,
  options: PlaneOptions & Pick<AccessorOptions<T>, 'point'>,
): Promise<Mesh2>;
export function delaunay2d(points: unknown, options: PlaneOptions = {}): Promise<Mesh2> {
  return triangulatePlane((shared ??= new Host()), points, options);
}

type AnyOptions = RunOptions & { point?: unknown };

async function triangulate(host: Host, points: unknown, options: AnyOptions): Promise<Mesh3> {
  const { signal, onProgress } = options;
  throwIfAborted(signal);
  const outputs = options.outputs ?? DEFAULT_OUTPUTS;
  const unknown = Array.isArray(outputs)
    ? outputs.find((output) => !ALL_OUTPUTS.includes(output))
    : outputs;
  if (unknown !== undefined) {
    throw new GdelError(
      'BAD_INPUT',
      `outputs are among ${ALL_OUTPUTS.join(', ')}, not ${String(unknown)}`,
    );
  }
  const { args, transfer } = await prepare(points, 3, options);
  const result = await host.run('delaunay3d', { ...args, outputs }, transfer, {
    signal,
    onProgress,
  });
  const { stats, thread, whyThread, ...arrays } = result;
  return new Mesh3({ ...arrays, stats: { ...stats, thread, whyThread } }, outputs);
}

async function triangulatePlane(host: Host, points: unknown, options: AnyOptions): Promise<Mesh2> {
  const { signal, onProgress } = options;
  throwIfAborted(signal);
  const { args, transfer } = await prepare(points, 2, options);
  const result = await host.run('delaunay2d', args, transfer, { signal, onProgress });
  const { stats, thread, whyThread, points: coords, ...arrays } = result;
  return new Mesh2({ ...arrays, coords, stats: { ...stats, thread, whyThread } });
}

/** The arguments of a run, checked. Typed arrays are copied before this returns. */
async function prepare(
  points: unknown,
  dimension: number,
  { engine = 'auto', transfer = false, signal, point }: AnyOptions,
) {
  checkEngine(engine);
  if (point !== undefined && typeof point !== 'function') {
    throw new GdelError('BAD_INPUT', 'the option point is a function');
  }
  const conversion = {
    dimension,
    transfer,
    point: point as AccessorOptions<unknown>['point'] | undefined,
    signal,
  };
  const own = await ownCoordinates(points, conversion);
  return { args: { points: own.coordinates, engine }, transfer: own.transfer };
}

function checkEngine(engine: unknown): void {
  if (!ENGINES.includes(engine as EngineName)) {
    throw new GdelError('BAD_INPUT', `engines are ${ENGINES.join(', ')}, not ${String(engine)}`);
  }
}
