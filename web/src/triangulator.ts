import { GdelError } from './errors.js';
import { Host, throwIfAborted } from './host.js';
import { Mesh3 } from './mesh.js';
import { Mesh2 } from './mesh2.js';
import { ownCoordinates } from './points.js';
import type {
  AccessorOptions,
  Backend,
  Output,
  Points,
  RunOptions,
  RunOptions2,
  TriangulatorInfo,
  TriangulatorOptions,
} from './types.js';

const ALL_OUTPUTS: readonly Output[] = ['neighbors', 'hull', 'duplicateOf', 'trace'];
const DEFAULT_OUTPUTS = ALL_OUTPUTS.filter((output) => output !== 'trace');
const BACKENDS: readonly Backend[] = ['auto', 'gpu', 'cpu'];

/**
 * Triangulates in a worker of its own and, if it uses the GPU, with a device of its own. Its runs
 * take place one after the other. It stays usable after every error.
 */
export class Triangulator {
  readonly #host: Host;
  readonly #backend: Backend;
  /** What `'auto'` uses, as found when the triangulator was created. */
  readonly info: TriangulatorInfo;

  /** @internal */
  constructor(host: Host, backend: Backend, info: TriangulatorInfo) {
    this.#host = host;
    this.#backend = backend;
    this.info = info;
  }

  /** Does the same as the function {@link delaunay3d}. */
  delaunay3d(points: Points, options?: RunOptions): Promise<Mesh3>;
  delaunay3d<T>(points: ArrayLike<T>, options: AccessorOptions<T>): Promise<Mesh3>;
  delaunay3d(points: unknown, options: RunOptions = {}): Promise<Mesh3> {
    return triangulate(this.#host, points, { backend: this.#backend, ...options });
  }

  /** Does the same as the function {@link delaunay2d}. */
  delaunay2d(points: Points, options?: RunOptions2): Promise<Mesh2>;
  delaunay2d<T>(
    points: ArrayLike<T>,
    options: RunOptions2 & Pick<AccessorOptions<T>, 'point'>,
  ): Promise<Mesh2>;
  delaunay2d(points: unknown, options: RunOptions2 = {}): Promise<Mesh2> {
    return triangulate2d(this.#host, points, { backend: this.#backend, ...options });
  }

  /** Ends the worker and releases the device. Unfinished runs fail with code `DISPOSED`. */
  dispose(): void {
    this.#host.dispose();
  }

  /** Supports `using triangulator = await createTriangulator()`. */
  declare [Symbol.dispose]: () => void;
}

// Not in the class, since older environments lack the symbol.
if (Symbol.dispose) Triangulator.prototype[Symbol.dispose] = Triangulator.prototype.dispose;

/**
 * Creates a triangulator: loads the WebAssembly module, starts the worker, and opens the GPU unless
 * `backend` is `'cpu'`.
 */
export async function createTriangulator(options: TriangulatorOptions = {}): Promise<Triangulator> {
  const { backend = 'auto', gpu, worker } = options;
  checkBackend(backend);
  const host = new Host({ gpu, worker });
  try {
    if (backend !== 'cpu')
      return new Triangulator(host, backend, await host.run('open', { backend }, [], {}));
    // A run on no points shows that the worker starts, or why it does not.
    const args = { points: new Float64Array(0), backend, outputs: [] };
    const { thread, whyThread } = await host.run('delaunay3d', args, [], {});
    return new Triangulator(host, backend, {
      backend,
      fallback: null,
      adapter: null,
      thread,
      whyThread,
    });
  } catch (error) {
    host.dispose();
    throw error;
  }
}

let shared: Host | undefined;

/**
 * Returns the 3D Delaunay triangulation of points. It is unique and exact, has no flat tetrahedra,
 * and every distinct point is a vertex of it.
 *
 * All calls share one triangulator, which the first call creates. Coplanar, collinear, coincident
 * and empty input is no error: {@link Mesh3.dimension} tells such input apart.
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
 * Returns the 2D Delaunay triangulation of points, x, y, x, y, … or one row per point. It has the
 * properties of {@link delaunay3d}, and the arrays of the npm package `delaunator`.
 *
 * @throws {@link GdelError}, as a rejected promise.
 */
export function delaunay2d(points: Points, options?: RunOptions2): Promise<Mesh2>;
export function delaunay2d<T>(
  points: ArrayLike<T>,
  options: RunOptions2 & Pick<AccessorOptions<T>, 'point'>,
): Promise<Mesh2>;
export function delaunay2d(points: unknown, options: RunOptions2 = {}): Promise<Mesh2> {
  return triangulate2d((shared ??= new Host()), points, options);
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
      `outputs must be an array of any of ${ALL_OUTPUTS.join(', ')}, not ${String(unknown)}`,
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

async function triangulate2d(host: Host, points: unknown, options: AnyOptions): Promise<Mesh2> {
  const { signal, onProgress } = options;
  throwIfAborted(signal);
  const { args, transfer } = await prepare(points, 2, options);
  const result = await host.run('delaunay2d', args, transfer, { signal, onProgress });
  const { stats, thread, whyThread, points: coords, ...arrays } = result;
  return new Mesh2({ ...arrays, coords, stats: { ...stats, thread, whyThread } });
}

/** Returns the checked arguments of a run. Typed arrays are copied before this returns. */
async function prepare(
  points: unknown,
  dimension: number,
  { backend = 'auto', transfer = false, signal, point }: AnyOptions,
) {
  checkBackend(backend);
  if (point !== undefined && typeof point !== 'function') {
    throw new GdelError('BAD_INPUT', 'the option point must be a function');
  }
  const conversion = {
    dimension,
    transfer,
    point: point as AccessorOptions<unknown>['point'] | undefined,
    signal,
  };
  const own = await ownCoordinates(points, conversion);
  return { args: { points: own.coordinates, backend }, transfer: own.transfer };
}

function checkBackend(backend: unknown): void {
  if (!BACKENDS.includes(backend as Backend)) {
    throw new GdelError(
      'BAD_INPUT',
      `backend must be one of ${BACKENDS.join(', ')}, not ${String(backend)}`,
    );
  }
}
