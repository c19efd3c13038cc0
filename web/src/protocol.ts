// What the page and the worker say to each other.

import type { PlainError } from './errors.js';
import type {
  EngineInfo,
  EngineName,
  MeshStatement,
  MeshStatement2,
  Output,
  PointCloud,
  Progress,
  Report,
  Report2,
  Stats,
  Trace,
} from './types.js';

/** The wasm modules. */
export type ModuleName = 'engine' | 'plane' | 'tools';

export type Coordinates = Float32Array | Float64Array;

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
  write: {
    args: { points: Coordinates; mesh: MeshStatement; format: string };
    result: Record<string, Uint8Array>;
  };
  verify: { args: { points: Coordinates; mesh: MeshStatement }; result: Report };
  generate2d: { args: { kind: string; count: number; seed: bigint }; result: Float64Array };
  write2d: {
    args: { points: Coordinates; mesh: MeshStatement2; format: string };
    result: Record<string, Uint8Array>;
  };
  verify2d: { args: { points: Coordinates; mesh: MeshStatement2 }; result: Report2 };
}

export type TaskName = keyof Tasks;

/** Which module carries out which task. */
export const MODULE_OF: Readonly<Record<TaskName, ModuleName>> = {
  open: 'engine',
  delaunay3d: 'engine',
  delaunay2d: 'plane',
  generate: 'tools',
  readPoints: 'tools',
  write: 'tools',
  verify: 'tools',
  generate2d: 'tools',
  write2d: 'tools',
  verify2d: 'tools',
};

/** How a task talks to its caller. */
export interface Control {
  onProgress(progress: Progress): void;
  isAborted(): boolean;
}

export type ToWorker =
  | { type: 'load'; name: ModuleName; module: WebAssembly.Module }
  | { type: 'run'; id: number; task: TaskName; args: Tasks[TaskName]['args'] }
  | { type: 'abort'; id: number };

export type FromWorker =
  | { type: 'ready' }
  | { type: 'progress'; id: number; progress: Progress }
  | { type: 'done'; id: number; result: Tasks[TaskName]['result'] }
  | { type: 'failed'; id: number; error: PlainError };
