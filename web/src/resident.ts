// Meshes that stay on the caller's device, and points that come from it.

import type { Coordinates, Indices, SignedIndices } from './arrays.js';
import { GdelError, toGdelError, toPlainError } from './errors.js';
import { checkOneOf } from './options.js';
import type { Tasks } from './protocol.js';
import type { Stats } from './types.js';

/** A `GPUBuffer`; any object where the types of WebGPU are not there. */
export type GpuBuffer = typeof globalThis extends { GPUBuffer: { prototype: infer B } }
  ? B
  : object;

/** The arrays of a mesh on the device. */
export type ResidentArray = 'tetrahedra' | 'neighbors' | 'hull' | 'vertexTetrahedron';

const ARRAYS: readonly ResidentArray[] = ['tetrahedra', 'neighbors', 'hull', 'vertexTetrahedron'];

/** What is used of a `GPUBuffer`. */
interface Buffer {
  size: number;
  mapAsync(mode: number): Promise<void>;
  getMappedRange(): ArrayBuffer;
  destroy(): void;
}

/** What is used of a `GPUDevice`. */
export interface Device {
  features: object;
  limits: object;
  adapterInfo?: object;
  queue: { submit(commands: object[]): void };
  createBuffer(descriptor: object): Buffer;
  createCommandEncoder(): {
    copyBufferToBuffer(from: object, at: number, to: object, start: number, size: number): void;
    finish(): object;
  };
  pushErrorScope(filter: string): void;
  popErrorScope(): Promise<{ message: string } | null>;
}

/** Returns a GPU object for wgpu, which asks for a device and gets this one. */
export function gpuOf(device: Device): object {
  const { features, limits, adapterInfo } = device;
  const none = { vendor: '', architecture: '', device: '', description: '' };
  const adapter = {
    features,
    limits,
    info: adapterInfo ?? none,
    requestDevice: async () => device,
  };
  return { isGiven: true, requestAdapter: async () => adapter };
}

/** Returns whether a value works as a `GPUBuffer`. */
export function isBuffer(value: unknown): value is Buffer {
  return typeof (value as Buffer | undefined)?.mapAsync === 'function';
}

/** Copies the points in a buffer, of the usage `COPY_SRC`, as they are when this is called. */
export async function coordinatesOf(device: Device, points: Buffer): Promise<Coordinates> {
  device.pushErrorScope('validation');
  // MAP_READ and COPY_DST.
  const staging = device.createBuffer({ size: points.size, usage: 9 });
  const encoder = device.createCommandEncoder();
  encoder.copyBufferToBuffer(points, 0, staging, 0, points.size);
  device.queue.submit([encoder.finish()]);
  const error = await device.popErrorScope();
  if (error) throw new GdelError('BAD_INPUT', `the buffer of points: ${error.message}`);
  try {
    await staging.mapAsync(1);
    return new Float32Array(staging.getMappedRange().slice(0));
  } catch (error) {
    throw new GdelError('DEVICE_LOST', `the points could not be read: ${String(error)}`);
  } finally {
    staging.destroy();
  }
}

/**
 * A 3D Delaunay triangulation in buffers of the caller's device. Later runs do not change them. They
 * can be bound as storage, vertex and index buffers, and copied from; an empty array has a buffer of
 * 16 bytes.
 */
export class ResidentMesh3 {
  /**
   * The arrays on the device, as {@link Mesh3} has them: `tetrahedra` (`array<vec4u>`), `neighbors`
   * (`array<vec4i>`), `hull` (three `u32` per triangle), and `vertexTetrahedron`, the lowest
   * tetrahedron of each point (`i32`, −1 for duplicates).
   */
  readonly buffers: Readonly<Record<ResidentArray, GpuBuffer>>;
  /** The number of tetrahedra. */
  readonly tetrahedronCount: number;
  /** The number of triangles of the hull. */
  readonly hullCount: number;
  /**
   * One per point: −1, or the lowest index of a point with the same coordinates, which represents
   * this one in the mesh.
   */
  readonly duplicateOf: SignedIndices;
  /** The affine dimension of the points. Below 3 there are no tetrahedra. */
  readonly dimension: 0 | 1 | 2 | 3;
  /** Statistics of the run. */
  readonly stats: Stats;
  #resident: { read(array: number): Promise<Uint8Array<ArrayBuffer>> } | undefined;

  /** @internal */
  constructor(made: NonNullable<Tasks['delaunay3d']['result']['resident']>, stats: Stats) {
    this.buffers = Object.fromEntries(ARRAYS.map((name, i) => [name, made.buffers[i]])) as any;
    [this.tetrahedronCount, this.hullCount] = made.counts;
    this.duplicateOf = made.duplicateOf;
    this.dimension = made.dimension;
    this.stats = stats;
    this.#resident = made.mesh;
  }

  /**
   * Returns a copy of an array.
   *
   * @throws {@link GdelError} `DEVICE_LOST`, `DISPOSED` after {@link destroy}.
   */
  async read(array: 'tetrahedra' | 'hull'): Promise<Indices>;
  async read(array: 'neighbors' | 'vertexTetrahedron'): Promise<SignedIndices>;
  async read(array: ResidentArray): Promise<Indices | SignedIndices>;
  async read(array: ResidentArray): Promise<Indices | SignedIndices> {
    checkOneOf('array', array, ARRAYS);
    if (!this.#resident) throw new GdelError('DISPOSED', 'the mesh was destroyed');
    try {
      const { buffer } = await this.#resident.read(ARRAYS.indexOf(array));
      return array === 'tetrahedra' || array === 'hull'
        ? new Uint32Array(buffer)
        : new Int32Array(buffer);
    } catch (thrown) {
      throw toGdelError(toPlainError(thrown, 0));
    }
  }

  /** Frees the buffers now, rather than when the mesh is garbage. */
  destroy(): void {
    this.#resident = undefined;
    for (const buffer of Object.values(this.buffers)) (buffer as unknown as Buffer).destroy();
  }
}
