// Meshes that stay on the caller's device, and points that come from it.

import type { Coordinates, Indices, SignedIndices } from './arrays.js';
import { GdelError, toGdelError, toPlainError } from './errors.js';
import { checkOneOf } from './options.js';
import type { Stats } from './types.js';

/** A `GPUBuffer`; any object where the types of WebGPU are not there. */
export type GpuBuffer = typeof globalThis extends { GPUBuffer: { prototype: infer B } }
  ? B
  : object;

/** The arrays of a 3D mesh on the device. */
export interface ResidentArrays3 {
  tetrahedra: Indices;
  neighbors: SignedIndices;
  hull: Indices;
  vertexTetrahedron: SignedIndices;
}

/** The arrays of a 2D mesh on the device. */
export interface ResidentArrays2 {
  triangles: Indices;
  halfedges: SignedIndices;
  hull: Indices;
  vertexTriangle: SignedIndices;
}

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

/** What runs in both dimensions return of a mesh on the device. */
export interface MadeResident {
  buffers: object[];
  counts: [number, number];
  duplicateOf: SignedIndices;
  dimension: 0 | 1 | 2 | 3;
  mesh: { read(array: number): Promise<Uint8Array<ArrayBuffer>> };
}

/**
 * A mesh in buffers of the caller's device. Later runs do not change them. They can be bound as
 * storage, vertex and index buffers, and copied from; an empty array has a buffer of 16 bytes.
 */
export class ResidentMesh<Arrays> {
  /** The arrays on the device. */
  readonly buffers: Readonly<Record<keyof Arrays, GpuBuffer>>;
  /** The number of triangles of the hull in 3D, of its vertices in 2D. */
  readonly hullCount: number;
  /**
   * One per point: −1, or the lowest index of a point with the same coordinates, which represents
   * this one in the mesh.
   */
  readonly duplicateOf: SignedIndices;
  /**
   * The affine dimension of the points. Below that of the mesh there are no tetrahedra or triangles.
   */
  readonly dimension: 0 | 1 | 2 | 3;
  /** Statistics of the run. */
  readonly stats: Stats;
  #resident: MadeResident['mesh'] | undefined;
  readonly #names: readonly string[];

  /** @internal */
  constructor(names: readonly (keyof Arrays & string)[], made: MadeResident, stats: Stats) {
    this.buffers = Object.fromEntries(names.map((name, i) => [name, made.buffers[i]])) as any;
    this.hullCount = made.counts[1];
    this.duplicateOf = made.duplicateOf;
    this.dimension = made.dimension;
    this.stats = stats;
    this.#resident = made.mesh;
    this.#names = names;
  }

  /**
   * Returns a copy of an array.
   *
   * @throws {@link GdelError} `DEVICE_LOST`, `DISPOSED` after {@link destroy}.
   */
  async read<Name extends keyof Arrays & string>(array: Name): Promise<Arrays[Name]> {
    checkOneOf('array', array, this.#names);
    if (!this.#resident) throw new GdelError('DISPOSED', 'the mesh was destroyed');
    const i = this.#names.indexOf(array);
    try {
      const { buffer } = await this.#resident.read(i);
      // Every other array has −1 where there is nothing.
      return new (i % 2 ? Int32Array : Uint32Array)(buffer) as Arrays[Name];
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

/**
 * A 3D Delaunay triangulation on the caller's device, with the arrays of {@link Mesh3}: `tetrahedra`
 * (`array<vec4u>`), `neighbors` (`array<vec4i>`), `hull` (three `u32` per triangle), and
 * `vertexTetrahedron`, the lowest tetrahedron of each point (`i32`, −1 for duplicates).
 */
export class ResidentMesh3 extends ResidentMesh<ResidentArrays3> {
  /** The number of tetrahedra. */
  readonly tetrahedronCount: number;

  /** @internal */
  constructor(made: MadeResident, stats: Stats) {
    super(['tetrahedra', 'neighbors', 'hull', 'vertexTetrahedron'], made, stats);
    this.tetrahedronCount = made.counts[0];
  }
}

/**
 * A 2D Delaunay triangulation on the caller's device, with the arrays of {@link Mesh2}: `triangles`
 * (three `u32` per triangle), `halfedges` (three `i32` per triangle), `hull` (`u32`), and
 * `vertexTriangle`, the lowest triangle of each point (`i32`, −1 for duplicates).
 */
export class ResidentMesh2 extends ResidentMesh<ResidentArrays2> {
  /** The number of triangles. */
  readonly triangleCount: number;

  /** @internal */
  constructor(made: MadeResident, stats: Stats) {
    super(['triangles', 'halfedges', 'hull', 'vertexTriangle'], made, stats);
    this.triangleCount = made.counts[0];
  }
}
