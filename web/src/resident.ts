// Meshes that stay on the caller's device, and points that come from it.

import type { Coordinates, Indices, SignedIndices } from './arrays.js';
import type { Device } from './device.js';
import { GdelError } from './errors.js';
import { bytesOf, Held } from './held.js';
import { Memory, memoryOf } from './memory.js';
import { Mesh3 } from './mesh.js';
import { Mesh2 } from './mesh2.js';
import { checkOneOf } from './options.js';
import type { Done, Task } from './protocol.js';
import type { Update } from './run.js';
import type { Points, Stats, UpdateOptions } from './types.js';
import { Updating } from './updating.js';

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

/** What is derived from meshes in the same way wherever they are. */
type Answer =
  | 'locate'
  | 'nearest'
  | 'interpolate'
  | 'interpolateGrid'
  | 'interpolationWeights'
  | 'gradients'
  | 'topology'
  | 'geometry'
  | 'contours'
  | 'voronoi'
  | 'alphaShape'
  | 'ballComplex'
  | 'surface'
  | 'spanningTree'
  | 'transport';

/**
 * A mesh in buffers of the caller's device. Later runs do not change them. They can be bound as
 * storage, vertex and index buffers, and copied from; an empty array has a buffer of 16 bytes.
 *
 * What is derived from it, by {@link locate} and the other methods that meshes elsewhere have, too, is
 * computed by the CPU in a worker. The arrays are read from the device for the first answer, and kept
 * for others until the mesh is updated or destroyed.
 */
export class ResidentMesh<Arrays, Mesh extends Mesh2 | Mesh3> {
  /** The arrays on the device. */
  declare readonly buffers: Readonly<Record<keyof Arrays, GpuBuffer>>;
  /** The number of triangles of the hull in 3D, of its vertices in 2D. */
  declare readonly hullCount: number;
  /**
   * One per point: −1, or the lowest index of a point with the same coordinates, which represents
   * this one in the mesh.
   */
  declare readonly duplicateOf: SignedIndices;
  /**
   * The affine dimension of the points. Below that of the mesh there are no tetrahedra or triangles.
   */
  declare readonly dimension: 0 | 1 | 2 | 3;
  /** Statistics of the run. */
  declare readonly stats: Stats;
  #held: Held | undefined;
  #points: Coordinates | undefined;
  /** What answers are derived from, once one has been asked for. */
  #mesh: Promise<Mesh> | undefined;
  readonly #names: readonly string[];
  /** What the number of tetrahedra or triangles is called. */
  readonly #count: string;
  readonly #update: Update<Task>;
  /** Makes a mesh of arrays in the memory of the CPU. */
  readonly #make: (done: any) => Mesh;
  readonly #updating = new Updating();

  /** @internal */
  constructor(
    names: readonly (keyof Arrays & string)[],
    count: string,
    done: Done<Task>,
    update: Update<Task>,
    device: Device,
    make: (done: any) => Mesh,
  ) {
    this.#names = names;
    this.#count = count;
    this.#update = update;
    this.#make = make;
    this.#take(done, device);
  }

  /** Takes over what a run has made. */
  #take(done: Done<Task>, device: Device): void {
    const { result, place } = done;
    const made = result.resident!;
    const { counts, duplicateOf, dimension } = made;
    const stats = { ...result.stats, ...place };
    const buffers = Object.fromEntries(this.#names.map((name, i) => [name, made.buffers[i]]));
    const [count, hullCount] = counts;
    Object.assign(this, { buffers, hullCount, duplicateOf, dimension, stats });
    Object.assign(this, { [this.#count]: count });
    this.#held = new Held(done, device);
    this.#points = result.points;
    this.#mesh = undefined;
  }

  #heldNow(): Held {
    if (!this.#held) throw new GdelError('DISPOSED', 'the mesh was destroyed');
    return this.#held;
  }

  /**
   * Moves the points of the mesh: it becomes the mesh of as many other points, the same as a run from
   * scratch makes of them, except for the order of its tetrahedra or triangles. Where little has
   * changed, that is faster. {@link UpdateStats} say what was done.
   *
   * `points` are those of a run of the triangulator that made the mesh, also in a `GPUBuffer`. When
   * the promise is fulfilled, the mesh has new {@link buffers}, to be bound anew, and the old ones
   * are destroyed. Until then, and if it is rejected, the mesh is what it was.
   *
   * @throws {@link GdelError} `BAD_INPUT` for another number of points, or if the mesh is being
   * updated; `NOT_FINITE`, `ABORTED`, `DISPOSED`, and those of the device.
   */
  update(points: Points | GpuBuffer, options?: UpdateOptions): Promise<void> {
    return this.#updating.run(async () => {
      const held = this.#heldNow();
      const done = await held.use(() => this.#update(points, options, held, this.stats));
      if (this.#held !== held) {
        new Held(done, held.device).release();
        this.#heldNow();
      }
      this.#take(done, held.device);
      held.release();
    });
  }

  /**
   * Returns a copy of an array: in the memory of `reuse`, which becomes empty, if that is given and
   * large enough.
   *
   * @throws {@link GdelError} `DEVICE_LOST`, `DISPOSED` after {@link destroy}.
   */
  async read<Name extends keyof Arrays & string>(
    array: Name,
    { reuse }: { reuse?: Indices | SignedIndices | undefined } = {},
  ): Promise<Arrays[Name]> {
    checkOneOf('array', array, this.#names);
    const held = this.#heldNow();
    const i = this.#names.indexOf(array);
    const { buffers, counts, duplicateOf } = held.resident;
    const [count, hullCount] = counts;
    const source = buffers[i]!;
    // An empty array has a buffer all the same.
    const size = [count, count, hullCount, duplicateOf.length][i]! && source.size;
    const { take } = new Memory(reuse && memoryOf([reuse]));
    const { buffer } = await held.use(() => bytesOf(held.device, source, size, take));
    // Every other array has −1 where there is nothing.
    return new (i % 2 ? Int32Array : Uint32Array)(buffer, 0, size / 4) as Arrays[Name];
  }

  /** Does the same as {@link Mesh3.locate} or {@link Mesh2.locate}. */
  locate(...args: Parameters<Mesh['locate']>) {
    return this.#ask('locate', args);
  }

  /** Does the same as {@link Mesh3.nearest}. */
  nearest(...args: Parameters<Mesh['nearest']>) {
    return this.#ask('nearest', args);
  }

  /** Does the same as {@link Mesh3.interpolate}. */
  interpolate(...args: Parameters<Mesh['interpolate']>) {
    return this.#ask('interpolate', args);
  }

  /** Does the same as {@link Mesh3.interpolateGrid}. */
  interpolateGrid(...args: Parameters<Mesh['interpolateGrid']>) {
    return this.#ask('interpolateGrid', args);
  }

  /** Does the same as {@link Mesh3.interpolationWeights}. */
  interpolationWeights(...args: Parameters<Mesh['interpolationWeights']>) {
    return this.#ask('interpolationWeights', args);
  }

  /** Does the same as {@link Mesh3.gradients}. */
  gradients(...args: Parameters<Mesh['gradients']>) {
    return this.#ask('gradients', args);
  }

  /** Does the same as {@link Mesh3.topology}. */
  topology(...args: Parameters<Mesh['topology']>) {
    return this.#ask('topology', args);
  }

  /** Does the same as {@link Mesh3.geometry}. */
  geometry(...args: Parameters<Mesh['geometry']>) {
    return this.#ask('geometry', args);
  }

  /** Does the same as {@link Mesh3.contours} or {@link Mesh2.contours}. */
  contours(...args: Parameters<Mesh['contours']>) {
    return this.#ask('contours', args);
  }

  /** Does the same as {@link Mesh3.voronoi} or {@link Mesh2.voronoi}. */
  voronoi(...args: Parameters<Mesh['voronoi']>) {
    return this.#ask('voronoi', args);
  }

  /** Does the same as {@link Mesh3.alphaShape}. */
  alphaShape(...args: Parameters<Mesh['alphaShape']>) {
    return this.#ask('alphaShape', args);
  }

  /** Does the same as {@link Mesh3.ballComplex}. */
  ballComplex(...args: Parameters<Mesh['ballComplex']>) {
    return this.#ask('ballComplex', args);
  }

  /** Does the same as {@link Mesh3.surface} or {@link Mesh2.surface}. */
  surface(...args: Parameters<Mesh['surface']>) {
    return this.#ask('surface', args);
  }

  /** Does the same as {@link Mesh3.spanningTree}. */
  spanningTree(...args: Parameters<Mesh['spanningTree']>) {
    return this.#ask('spanningTree', args);
  }

  /** Does the same as {@link Mesh3.transport}. */
  transport(...args: Parameters<Mesh['transport']>) {
    return this.#ask('transport', args);
  }

  /** Derives something from the mesh. */
  async #ask<Name extends Answer>(
    name: Name,
    args: Parameters<Mesh[Name]>,
  ): Promise<Awaited<ReturnType<Mesh[Name]>>> {
    this.#heldNow();
    const mesh = (this.#mesh ??= this.#readAll());
    // The next one tries again.
    mesh.catch(() => {
      if (this.#mesh === mesh) this.#mesh = undefined;
    });
    return ((await mesh)[name] as any)(...args);
  }

  /** Returns the mesh in the memory of the CPU. */
  async #readAll(): Promise<Mesh> {
    const { duplicateOf, dimension } = this;
    const result = { duplicateOf, dimension, points: this.#points };
    const names = this.#names.slice(0, 3) as (keyof Arrays & string)[];
    const arrays = await Promise.all(names.map((name) => this.read(name)));
    Object.assign(result, Object.fromEntries(names.map((name, i) => [name, arrays[i]])));
    return this.#make({ result, place: {} });
  }

  /** Frees the buffers now, rather than when the mesh is garbage. */
  destroy(): void {
    this.#held?.release();
    this.#held = this.#points = this.#mesh = undefined;
  }
}

/**
 * A 3D Delaunay triangulation on the caller's device, with the arrays of {@link Mesh3}: `tetrahedra`
 * (`array<vec4u>`), `neighbors` (`array<vec4i>`), `hull` (three `u32` per triangle), and
 * `vertexTetrahedron`, the lowest tetrahedron of each point (`i32`, −1 for duplicates).
 */
export class ResidentMesh3 extends ResidentMesh<ResidentArrays3, Mesh3> {
  /** The number of tetrahedra. */
  declare readonly tetrahedronCount: number;

  /** @internal */
  constructor(done: Done<Task>, update: Update<Task>, device: Device) {
    super(
      ['tetrahedra', 'neighbors', 'hull', 'vertexTetrahedron'],
      'tetrahedronCount',
      done,
      update,
      device,
      (read) => new Mesh3(read, ['neighbors', 'duplicateOf'], update as Update<any>),
    );
  }
}

/**
 * A 2D Delaunay triangulation on the caller's device, with the arrays of {@link Mesh2}: `triangles`
 * (three `u32` per triangle), `halfedges` (three `i32` per triangle), `hull` (`u32`), and
 * `vertexTriangle`, the lowest triangle of each point (`i32`, −1 for duplicates).
 */
export class ResidentMesh2 extends ResidentMesh<ResidentArrays2, Mesh2> {
  /** The number of triangles. */
  declare readonly triangleCount: number;

  /** @internal */
  constructor(done: Done<Task>, update: Update<Task>, device: Device) {
    super(
      ['triangles', 'halfedges', 'hull', 'vertexTriangle'],
      'triangleCount',
      done,
      update,
      device,
      (read) => new Mesh2(read, update as Update<any>),
    );
  }
}
