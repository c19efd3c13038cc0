// The meshes that an instance has on the device.

import type { Coordinates } from './arrays.js';
import type { PointCarrier } from './carrier.js';
import type { ReportProgress } from './core.js';
import type { Buffer, Device } from './device.js';
import { bytesOf } from './held.js';
import type { Memory } from './memory.js';
import type { CoreStats, MadeResident, Tasks } from './protocol.js';

/** A mesh on the device, as WebAssembly has it. */
export interface WasmMesh {
  drive(triangulator: object, carrier: PointCarrier, report: ReportProgress): Promise<Made>;
  read(array: number, memory: Memory['take']): Promise<Uint8Array<ArrayBuffer>>;
  update(
    triangulator: object,
    points: Coordinates,
    backend: string,
    report: ReportProgress,
  ): Promise<Made>;
  free(): void;
}

type Results = Tasks['delaunay3d']['result'] & Tasks['delaunay2d']['result'];

/** The arrays that were requested, of either dimension. */
export type MeshArrays = Partial<Omit<Results, 'points' | 'stats' | 'resident'>>;

/** What WebAssembly returns of a run. */
export interface Made extends MeshArrays {
  stats: CoreStats;
  resident?: Omit<MadeResident, 'key'> & { mesh: WasmMesh };
  /** What is known of a run that the CPU has to do, instead of everything else. */
  leftToCpu?: Partial<CoreStats>;
}

/** What a run returns: arrays, or a mesh on the device. */
export interface Finished extends MeshArrays {
  stats: CoreStats;
  resident?: MadeResident;
}

/** Returns the bytes of the simplices of a mesh, if it has been made and is not on the device. */
export const simplexBytes = (mesh: Finished | undefined): number | undefined =>
  (mesh?.tetrahedra ?? mesh?.triangles)?.byteLength;

export class ResidentMeshes {
  readonly #arrays: readonly string[];
  /** The caller's device. */
  readonly #device: Device | undefined;
  readonly #byKey = new Map<number, WasmMesh>();
  /** The mesh of the last run, if that was an update of arrays: the next one goes on from it. */
  #kept: MadeResident | undefined;

  constructor(arrays: readonly string[], device: Device | undefined) {
    this.#arrays = arrays;
    this.#device = device;
  }

  /** Returns a mesh. Those of an instance that broke are of no use to another one, and not known there. */
  get(key: number | undefined): WasmMesh | undefined {
    return this.#byKey.get(key!);
  }

  /** Remembers the mesh that a run has left on the device, if it has. */
  remember({ resident, ...made }: Made, key: number): Finished {
    if (!resident) return made;
    const { mesh, ...rest } = resident;
    this.#byKey.set(key, mesh);
    return { ...made, resident: { ...rest, key } };
  }

  free(key: number): void {
    this.#byKey.get(key)?.free();
    this.#byKey.delete(key);
  }

  /** Frees what the device keeps for the next update. */
  drop(): void {
    if (!this.#kept) return;
    for (const buffer of this.#kept.buffers) buffer.destroy();
    this.free(this.#kept.key);
    this.#kept = undefined;
  }

  /** Returns the arrays of a mesh on the device, which keeps it. */
  async keep(
    { resident, stats, trace }: Finished,
    outputs: readonly string[],
    { take }: Memory,
  ): Promise<Finished> {
    const { dimension, duplicateOf, key } = resident!;
    const arrays = await this.#read(resident!, outputs, take);
    this.drop();
    this.#kept = resident;
    if (outputs.includes('duplicateOf')) arrays.duplicateOf = duplicateOf;
    return {
      ...arrays,
      ...(trace ? { trace } : {}),
      dimension: dimension as 0 | 1 | 2,
      stats,
      key,
    };
  }

  /** Returns those arrays of a mesh that are wanted, and always the simplices. */
  async #read(
    { buffers, counts, key }: MadeResident,
    outputs: readonly string[],
    take: Memory['take'],
  ): Promise<MeshArrays> {
    const mesh = this.#byKey.get(key)!;
    const bytes = (buffer: Buffer, i: number) =>
      this.#device
        ? bytesOf(this.#device, buffer, counts[i === 2 ? 1 : 0] && buffer.size, take)
        : mesh.read(i, take);
    const arrays: MeshArrays = {};
    // One after the other: each has several pieces on their way.
    for (const [i, array] of this.#arrays.entries()) {
      if (i > 0 && !outputs.includes(array)) continue;
      const { buffer, length } = await bytes(buffers[i]!, i);
      const view = new (i === 1 ? Int32Array : Uint32Array)(buffer, 0, length / 4);
      Object.assign(arrays, { [array]: view });
    }
    return arrays;
  }
}
