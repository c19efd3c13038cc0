// The messages between the page and the worker.

import type {
  AlphaOptions,
  AlphaShape,
  BallComplex,
  Contour2,
  Contour3,
  Geometry,
  Interpolated,
  InterpolateOptions,
  InterpolationWeights,
  LocateOptions,
  LocationsOnSphere,
  SphereArrays,
  SphereVoronoiArrays,
  SurfaceArrays,
  SurfaceOptions,
  TinArrays,
  Topology,
  Transport,
  TransportOptions,
  VoronoiArrays,
} from './answers.js';
import type { Bytes, Coordinates, Doubles, Indices, SignedIndices } from './arrays.js';
import type { ConstrainedArrays } from './constrained.js';
import type { Segments } from './constraints.js';
import type { Buffer } from './device.js';
import type { PlainError } from './errors.js';
import type { PowerCells, TreemapArrays, TreemapTask } from './nested.js';
import type {
  Backend,
  MeshView,
  MeshView2,
  Output,
  Place,
  PointCloud,
  Progress,
  Report,
  Report2,
  Shapes,
  Stats,
  Trace,
  TriangulatorInfo,
} from './types.js';

/** The wasm modules. */
export type ModuleName = 'd3' | 'd2' | 'edit' | 'tools' | 'derived' | 'surface' | 'transport';

export type CoreInfo = Omit<TriangulatorInfo, keyof Place>;

export type CoreStats = Omit<Stats, keyof Place>;

/** A mesh to derive something from. */
export interface DerivedMesh {
  tetrahedra?: Indices;
  neighbors?: SignedIndices;
  triangles?: Indices;
  halfedges?: SignedIndices;
  duplicateOf: SignedIndices;
  /** Without them it is the Delaunay triangulation. */
  weights?: Doubles | undefined;
  constraints?: Pick<ConstrainedArrays, 'edges'> | undefined;
}

/** What everything that is derived from a mesh needs. */
export interface DerivedArgs {
  dimension: 2 | 3;
  points: Coordinates;
  mesh: DerivedMesh;
}

/** A sphere to ask something. */
export interface SphereArgs {
  points: Coordinates;
  triangles: Indices;
  duplicateOf: SignedIndices;
}

/** The mesh of points before they moved. */
export interface MovedMesh extends DerivedMesh {
  /** In 2D. */
  hull?: Indices;
  dimension: number;
}

/** What runs in both dimensions return of a mesh on the device. */
export interface MadeResident {
  buffers: Buffer[];
  counts: [number, number];
  duplicateOf: SignedIndices;
  dimension: 0 | 1 | 2 | 3;
  /** The number under which the instance that made it has it. */
  key: number;
}

/** What becomes of a mesh whose points stay where they are. */
export interface Edit {
  /** Its points, which new ones follow. */
  before: Coordinates;
  /** The points that it loses; without these, it loses what is unused. */
  removed?: ArrayLike<number> | undefined;
}

/** What the points that are left were numbered before, if some were dropped. */
interface Kept {
  kept?: Indices;
}

/** The arrays of a tile, with the numbers that simplices have in the mesh. */
export interface TileArrays {
  simplices: Indices;
  neighbors: SignedIndices;
  /** Five words per facet that may lead to another tile. */
  borders: Indices;
  hull: Indices;
}

/** The arguments and the result of each task. */
export interface Tasks {
  open: { args: { backend: Backend }; result: CoreInfo };
  delaunay3d: {
    args: {
      points: Coordinates;
      backend: Backend;
      outputs: readonly Output[];
      resident?: boolean;
      /** Memory for the arrays. */
      spare?: ArrayBuffer[];
      /** The key of the mesh on the device of the points where they were, if they have moved. */
      moved?: number;
      /** For an update of what the GPU has made: the key of the last one, 0 for the first. */
      key?: number;
      /** The key of the mesh if it stays on the device, which no other mesh has. */
      newKey: number;
      /** Whether to return a simplex of each point. */
      vertexSimplex?: boolean;
      /** Whether to do nothing if it would be done by the CPU, of which several workers are ready. */
      leavesToWorkers?: boolean;
    };
    result: {
      points: Coordinates;
      /** Whether nothing was done: then there is only `stats.fallback`. */
      isLeft?: boolean;
      tetrahedra: Indices;
      neighbors: SignedIndices;
      hull: Indices;
      duplicateOf: SignedIndices;
      dimension: 0 | 1 | 2 | 3;
      /** The hidden points, if there are weights that differ. */
      hidden?: Indices;
      trace?: Trace;
      /** Instead of the arrays, if it was requested: the mesh on the device. */
      resident?: MadeResident;
      /** The key of what the device keeps for the next update, if this was one. */
      key?: number;
      vertexSimplex?: SignedIndices;
      stats: CoreStats;
    };
  };
  delaunay2d: {
    args: {
      points: Coordinates;
      backend: Backend;
      resident?: boolean;
      spare?: ArrayBuffer[];
      moved?: number;
      key?: number;
      newKey: number;
      vertexSimplex?: boolean;
      outputs?: readonly string[];
      leavesToWorkers?: boolean;
    };
    result: {
      points: Coordinates;
      isLeft?: boolean;
      triangles: Indices;
      halfedges: SignedIndices;
      hull: Indices;
      duplicateOf: SignedIndices;
      dimension: 0 | 1 | 2;
      /** The hidden points, if there are weights that differ. */
      hidden?: Indices;
      constraints?: ConstrainedArrays;
      /** Instead of the arrays, if it was requested. */
      resident?: MadeResident;
      key?: number;
      vertexSimplex?: SignedIndices;
      stats: CoreStats;
    };
  };
  /** Takes the points of a run that the calling thread drives on its device, and returns them. */
  begin: { args: { points: Coordinates }; result: { points: Coordinates } };
  /** Answers a request of this kind about these points, in lists of words. */
  answer: { args: { kind: number; request: Indices[] }; result: { answer: Indices[] } };
  /** Forgets the points. */
  end: { args: object; result: object };
  change: {
    args: {
      dimension: 2 | 3;
      points: Coordinates;
      mesh: MovedMesh;
      outputs: readonly Output[];
    } & Partial<Edit>;
    result: Tasks['delaunay3d' | 'delaunay2d']['result'] & Kept;
  };
  regular: {
    args: {
      dimension: 2 | 3;
      points: Coordinates;
      weights: Doubles;
      outputs: readonly Output[];
    };
    result: Tasks['delaunay3d' | 'delaunay2d']['result'];
  };
  constrained: {
    args: { points: Coordinates; backend: Backend; segments: Segments };
    result: Tasks['delaunay2d']['result'];
  };
  refine: {
    args: {
      points: Coordinates;
      mesh: object;
      options: object;
      /** What was known of the constraints. */
      before: Pick<ConstrainedArrays, 'added' | 'moved' | 'zeroLength'>;
    };
    result: Tasks['constrained']['result'];
  };
  /** Splits points into tiles, one for each worker. */
  splitPoints: {
    args: { dimension: 2 | 3; points: Coordinates; tiles: number };
    result: {
      points: Coordinates;
      /** The affine dimension of the points. */
      spanned: number;
      plan: Bytes;
      parts: { points: Doubles; indices: Indices }[];
    };
  };
  /** Begins a tile, or goes on with the one that was begun. */
  stepTile: {
    args: {
      begin?: { dimension: 2 | 3; plan: Bytes; number: number; points: Doubles; indices: Indices };
      /** Numbers of senders, each with its message after it. */
      messages: (number | Bytes)[];
    };
    /** Numbers of receivers, each with the message for it after it. */
    result: { messages: (number | Bytes)[] };
  };
  finishTile: {
    args: object;
    result: { simplices: number; duplicates: Indices; stats: CoreStats };
  };
  /** Returns the arrays of the tile, before which there are `base` simplices in the mesh. */
  takeTile: { args: { base: number }; result: TileArrays };
  /** Joins the tile to the others, which follow it. */
  joinTiles: {
    args: {
      dimension: 2 | 3;
      points: number;
      /** How many simplices the tile has. */
      simplices: number;
      others: TileArrays[];
      duplicates: Indices[];
    };
    result: {
      simplices: Indices;
      neighbors: SignedIndices;
      hull: Indices;
      duplicateOf: SignedIndices;
    };
  };
  tin: {
    args: { points: Coordinates; segments: Segments; options: object };
    result: TinArrays;
  };
  generate: { args: { kind: string; count: number; seed: bigint }; result: Doubles };
  readPoints: {
    args: { bytes: Uint8Array; extension: string; dimension: 2 | 3 };
    result: PointCloud;
  };
  readShapes: { args: { bytes: Uint8Array; extension: string }; result: Shapes };
  write: {
    args: { points: Coordinates; mesh: MeshView; format: string };
    result: Record<string, Bytes>;
  };
  verify: { args: { points: Coordinates; mesh: MeshView }; result: Report };
  generate2d: { args: { kind: string; count: number; seed: bigint }; result: Doubles };
  write2d: {
    args: { points: Coordinates; mesh: MeshView2 & { inside?: Bytes | undefined }; format: string };
    result: Record<string, Bytes>;
  };
  verify2d: { args: { points: Coordinates; mesh: MeshView2 }; result: Report2 };
  locate: {
    args: DerivedArgs & { queries: Coordinates; options: LocateOptions };
    result: { simplices: SignedIndices; facets: SignedIndices; outside: number };
  };
  nearest: { args: DerivedArgs & { queries: Coordinates; k: number }; result: SignedIndices };
  interpolate: {
    args: DerivedArgs & { queries: Coordinates; values: Doubles; options: InterpolateOptions };
    result: Interpolated;
  };
  interpolateGrid: {
    args: DerivedArgs & { values: Doubles; grid: Doubles; options: InterpolateOptions };
    result: Interpolated;
  };
  interpolationWeights: {
    args: DerivedArgs & { queries: Coordinates; options: InterpolateOptions };
    result: InterpolationWeights;
  };
  gradients: {
    args: DerivedArgs & { values: Doubles; options: InterpolateOptions };
    result: Doubles;
  };
  contours: {
    args: DerivedArgs & { values: Doubles; levels: Doubles; closed: boolean };
    result: (Contour2 & Contour3)[];
  };
  voronoi: { args: DerivedArgs & { clip: string; bounds: Doubles }; result: VoronoiArrays };
  transport: {
    args: Omit<DerivedArgs, 'mesh'> & {
      clip: string;
      bounds: Doubles;
      masses: Doubles | undefined;
      options: Pick<TransportOptions, 'normalize' | 'tolerance'>;
    };
    result: Transport;
  };
  treemap: { args: TreemapTask; result: TreemapArrays };
  powerCells: { args: { points: Doubles; weights: Doubles; corners: Doubles }; result: PowerCells };
  alphaShape: {
    args: DerivedArgs & { options: AlphaOptions };
    result: AlphaShape;
  };
  ballComplex: { args: DerivedArgs & { alpha: number; weights: Doubles }; result: BallComplex };
  surface: {
    args: DerivedArgs & { options: SurfaceOptions };
    result: SurfaceArrays & { triangles: Indices; edges: Indices };
  };
  spanningTree: { args: DerivedArgs; result: { edges: Indices; lengths: Doubles } };
  topology: { args: DerivedArgs; result: Topology };
  geometry: { args: DerivedArgs; result: Geometry };
  /** Returns the points of the unit sphere for longitudes and latitudes. */
  onSphere: { args: { places: Coordinates }; result: Doubles };
  /** Makes a sphere of the hull of its points. */
  sphere: { args: SphereArgs; result: SphereArrays };
  sphereNearest: { args: SphereArgs & { queries: Coordinates }; result: SignedIndices };
  sphereLocate: { args: SphereArgs & { queries: Coordinates }; result: LocationsOnSphere };
  sphereInterpolate: {
    args: SphereArgs & { queries: Coordinates; values: Doubles };
    result: Interpolated;
  };
  sphereVoronoi: { args: SphereArgs; result: SphereVoronoiArrays };
}

export type TaskName = keyof Tasks;

/** The tasks with cells in the plane, which the interfaces of other packages call. */
export type PowerTask = 'treemap' | 'powerCells';

/** The tasks that triangulate. */
export type Task = 'delaunay3d' | 'delaunay2d';

/** The result of a task, and where it was computed. */
export interface Done<T extends TaskName> {
  result: Tasks[T]['result'];
  place: Place;
  /** Frees a mesh that stays on the caller's device. */
  free?(key: number): void;
  /** By which the points were multiplied, one per axis. */
  factors?: readonly number[] | undefined;
  /** The weights of the points, unless they are equal. */
  weights?: Doubles | null;
}

/** A worker that helps a thread which drives a device: it has a module of the same name. */
export interface Helper {
  run<T extends TaskName>(
    task: T,
    args: Tasks[T]['args'],
    transfer: ArrayBuffer[],
  ): Promise<Tasks[T]['result']>;
}

/** The connection of a task to its caller. */
export interface Control {
  onProgress(progress: Progress): void;
  /** Says that from now on the thread will hear nothing until the task is done. */
  onBlocking(): void;
  isAborted(): boolean;
}

export type ToWorker =
  | { type: 'load'; module: WebAssembly.Module; selfTest: boolean | undefined }
  | {
      type: 'run';
      id: number;
      task: TaskName;
      args: Tasks[TaskName]['args'];
      /** Whether to send messages before the last one: for small inputs, they are what takes long. */
      isWatched: boolean;
    }
  | { type: 'abort'; id: number };

export type FromWorker =
  | { type: 'ready' }
  | { type: 'progress'; id: number; progress: Progress }
  | { type: 'blocking'; id: number }
  | { type: 'done'; id: number; result: Tasks[TaskName]['result'] }
  | { type: 'failed'; id: number; error: PlainError };
