import { module3d } from '#assets';
import type { Device } from './device.js';
import { Host } from './host.js';
import { Mesh3 } from './mesh.js';
import { Mesh2 } from './mesh2.js';
import { bad, checkBoolean, checkOneOf, optionsOf, outputsOf } from './options.js';
import { type GpuBuffer, ResidentMesh2, ResidentMesh3 } from './resident.js';
import {
  type AnyOptions,
  BACKENDS,
  IN_2D,
  IN_3D,
  type Maker,
  nextKey,
  sharedMaker,
  triangulate,
  updating,
} from './run.js';
import type {
  AccessorOptions,
  Backend,
  Points,
  RunOptions,
  RunOptions2,
  TriangulatorInfo,
  TriangulatorOptions,
} from './types.js';

/**
 * Triangulates in a worker of its own and, if it uses the GPU, with a device of its own. Its runs
 * take place one after the other. It stays usable after every error.
 */
export class Triangulator {
  readonly #maker: Maker;
  /** What `'auto'` uses, as found when the triangulator was created. */
  readonly info: TriangulatorInfo;

  /** @internal */
  constructor(host: Host, backend: Backend, info: TriangulatorInfo, device?: Device) {
    this.#maker = { host, backend, device };
    this.info = info;
    // Not a method, since older environments lack the symbol, and bundlers keep what computes names.
    if (Symbol.dispose)
      Object.defineProperty(this, Symbol.dispose, { value: () => this.dispose() });
  }

  /**
   * Does the same as the function {@link delaunay3d}; with `resident`, the mesh stays on the device.
   * With the option `device`, points may come in a `GPUBuffer` of it, as `f32`, three per point and
   * nothing else, of the usage `COPY_SRC`. They are copied as they are at the time of the call.
   */
  delaunay3d(
    points: Points | GpuBuffer,
    options: RunOptions & { resident: true },
  ): Promise<ResidentMesh3>;
  delaunay3d(points: Points | GpuBuffer, options?: RunOptions): Promise<Mesh3>;
  delaunay3d<T>(points: ArrayLike<T>, options: AccessorOptions<T>): Promise<Mesh3>;
  delaunay3d(points: unknown, options?: RunOptions): Promise<any> {
    return triangulate3d(this.#maker, points, options);
  }

  /**
   * Does the same as the function {@link delaunay2d}, with `resident` and points in a `GPUBuffer` as
   * in 3D, `f32`, two per point.
   */
  delaunay2d(
    points: Points | GpuBuffer,
    options: RunOptions2 & { resident: true },
  ): Promise<ResidentMesh2>;
  delaunay2d(points: Points | GpuBuffer, options?: RunOptions2): Promise<Mesh2>;
  delaunay2d<T>(
    points: ArrayLike<T>,
    options: RunOptions2 & Pick<AccessorOptions<T>, 'point'>,
  ): Promise<Mesh2>;
  delaunay2d(points: unknown, options?: RunOptions2): Promise<any> {
    return triangulate2d(this.#maker, points, options);
  }

  /** Ends the worker and releases the device. Unfinished runs fail with code `DISPOSED`. */
  dispose(): void {
    this.#maker.host.dispose();
  }

  /** Supports `using triangulator = await createTriangulator()`. */
  declare [Symbol.dispose]: () => void;
}

/**
 * Creates a triangulator: loads the WebAssembly module, starts the worker, and opens the GPU unless
 * `backend` is `'cpu'`.
 */
export async function createTriangulator(options?: TriangulatorOptions): Promise<Triangulator> {
  const {
    backend = 'auto',
    device,
    worker,
    selfTest,
  } = optionsOf(options) as TriangulatorOptions & {
    device?: Device;
  };
  const { gpu } = optionsOf(options);
  checkOneOf('backend', backend, BACKENDS);
  checkBoolean('worker', worker);
  checkBoolean('selfTest', selfTest);
  const { requestAdapter } = (gpu ?? {}) as { requestAdapter?: unknown };
  if (gpu !== undefined && typeof requestAdapter !== 'function')
    throw bad('the option gpu', 'a GPU object, with the function requestAdapter', gpu);
  if (device !== undefined) {
    if (typeof device?.createBuffer !== 'function')
      throw bad('the option device', 'a GPUDevice', device);
    if (gpu) throw bad('the option gpu', 'left out beside the option device', gpu);
  }
  const host = new Host({ gpu, device, worker, selfTest });
  try {
    if (backend !== 'cpu') {
      const { result, place } = await host.run(module3d, 'open', { backend }, { transfer: [] }, {});
      return new Triangulator(host, backend, { ...result, ...place }, device);
    }
    // A run on no points shows that the worker starts, or why it does not.
    const args = { points: new Float64Array(0), backend, outputs: [], newKey: nextKey() };
    const { place } = await host.run(module3d, 'delaunay3d', args, { transfer: [] }, {});
    const info = { backend, fallback: null, adapter: null, ...place };
    return new Triangulator(host, backend, info, device);
  } catch (error) {
    host.dispose();
    throw error;
  }
}

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
export function delaunay3d(points: unknown, options?: RunOptions): Promise<Mesh3> {
  return triangulate3d(sharedMaker('auto'), points, options) as Promise<Mesh3>;
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
export function delaunay2d(points: unknown, options?: RunOptions2): Promise<Mesh2> {
  return triangulate2d(sharedMaker('auto'), points, options) as Promise<Mesh2>;
}

async function triangulate3d(
  maker: Maker,
  points: unknown,
  options: AnyOptions | undefined,
): Promise<Mesh3 | ResidentMesh3> {
  const outputs = outputsOf(optionsOf(options));
  const done = await triangulate(maker, IN_3D, points, options, outputs);
  const update = updating(maker, IN_3D, options, outputs, done.factors);
  return done.result.resident
    ? new ResidentMesh3(done, update, maker.device!)
    : new Mesh3(done, outputs, update);
}

async function triangulate2d(
  maker: Maker,
  points: unknown,
  options: AnyOptions | undefined,
): Promise<Mesh2 | ResidentMesh2> {
  const done = await triangulate(maker, IN_2D, points, options);
  const update = updating(maker, IN_2D, options, [], done.factors);
  return done.result.resident
    ? new ResidentMesh2(done, update, maker.device!)
    : new Mesh2(done, update);
}
