// What the page and the worker say to each other.

import type { PlainError } from './errors.js';
import type { EngineName, EngineInfo, Output, PointCloud, Progress, Report, Stats, Trace } from './types.js';

/** The two wasm modules. */
export type ModuleName = 'engine' | 'tools';

export type Coordinates = Float32Array | Float64Array;

export interface MeshArrays {
  tetrahedra: Uint32Array;
  neighbors?: Int32Array | undefined;
  hull?: Uint32Array | undefined;
  duplicateOf?: Int32Array | undefined;
  dimension?: number | undefined;
}

export type CoreInfo = Omit<EngineInfo, 'thread' | 'whyThread'>;

export type CoreStats = Omit<Stats, 'thread' | 'whyThread'>;

/** What can be asked for: arguments and result of each task. */
export interface Tasks {
  open: { args: { engine: EngineName }; result: CoreInfo };
  delaunay3d: {
    args: { points: Coordinates; engine: EngineName; outputs: readonly Output[] };
    result: {
      points: Coordinates;
      tetrahedra: Uint32Array;
      neighbors: Int32Array;
      hull: Uint32Array;
      duplicateOf: Int32Array;
      dimension: 0 | 1 | 2 | 3;
      trace?: Trace;
      stats: CoreStats;
    };
  };
  delaunay2d: {
    args: { points: Coordinates; engine: EngineName };
    result: {
      points: Coordinates;
      triangles: Uint32Array;
      halfedges: Int32Array;
      hull: Uint32Array;
      duplicateOf: Int32Array;
      dimension: 0 | 1 | 2;
      stats: CoreStats;
    };
  };
  generate: { args: { kind: string; count: number; seed: bigint }; result: Float64Array };
  readPoints: { args: { bytes: Uint8Array; extension: string }; result: PointCloud };
  write: { args: { points: Coordinates; mesh: MeshArrays; format: string }; result: Record<string, Uint8Array> };
  verify: { args: { points: Coordinates; mesh: MeshArrays }; result: Report };
}

export type TaskName = keyof Tasks;

/** How a task talks to its caller. */
export interface Control {
  onProgress(progress: Progress): void;
  isAborted(): boolean;
}

export type ToWorker =
  | { type: 'start'; name: ModuleName; module: WebAssembly.Module }
  | { type: 'run'; id: number; task: TaskName; args: Tasks[TaskName]['args'] }
  | { type: 'abort'; id: number };

export type FromWorker =
  | { type: 'ready' }
  | { type: 'progress'; id: number; progress: Progress }
  | { type: 'done'; id: number; result: Tasks[TaskName]['result'] }
  | { type: 'failed'; id: number; error: PlainError };
