/**
 * Points: x, y, z, x, y, z, … in one typed array, or one row a point. Every finite number is taken at its exact value.
 *
 * A `Float32Array` or `Float64Array` is the fastest; anything else is converted to `Float64Array`. More than 2 MB are copied
 * or converted a slice at a time so that the page stays responsive: do not change them before the result is there.
 */
export type Points = Float32Array | Float64Array | ArrayLike<ArrayLike<number>>;

/** `'auto'`: the GPU where there is a hardware adapter and enough points, else the CPU. */
export type EngineName = 'auto' | 'gpu' | 'cpu';

/**
 * What a run can deliver besides the tetrahedra. `'trace'` is for small inputs: the GPU engine then reads everything back
 * after every round.
 */
export type Output = 'neighbors' | 'hull' | 'duplicateOf' | 'trace';

/** How far a run has come. */
export interface Progress {
  /** The phase that is running, as in {@link Stats.phases}. */
  phase: string;
  /** The share of the whole run that is done, 0 to 1. It never falls, except where the CPU engine takes over. */
  fraction: number;
}

/** For everything that can take long. */
export interface TaskOptions {
  /** Aborts the work, within 100 ms; the promise is rejected at once, with the signal's reason if that is not the
   * usual `AbortError`, else with a {@link GdelError} of code `ABORTED`. */
  signal?: AbortSignal | undefined;
  /** Called at most some 50 times a second, the last time with fraction 1. */
  onProgress?: ((progress: Progress) => void) | undefined;
}

/** How to triangulate. */
export interface RunOptions extends TaskOptions {
  /** Which engine; all give the same set of tetrahedra. Default: the engine's own, `'auto'`. */
  engine?: EngineName | undefined;
  /** The arrays to deliver besides `tetrahedra`; those left out are empty. Default: all but `'trace'`. */
  outputs?: readonly Output[] | undefined;
  /** Give the input's buffer away instead of copying it: the array, and every other view of its buffer, is empty
   * afterwards. {@link Mesh3.points} gives the coordinates back. Default: false. */
  transfer?: boolean | undefined;
}

/** How to triangulate in the plane. */
export type PlaneOptions = Omit<RunOptions, 'outputs'>;

/** How to triangulate points that are objects. */
export interface AccessorOptions<T> extends RunOptions {
  /** The coordinates of an item. */
  point: (item: T, index: number) => ArrayLike<number>;
}

/** How to make an engine. */
export interface EngineOptions {
  /** The engine of runs that name none, default `'auto'`. With `'gpu'`, `createEngine` fails where no GPU can be used. */
  engine?: EngineName | undefined;
  /** A `GPU` object where `navigator.gpu` is missing, such as `create([])` of the npm package `webgpu` in Node. It cannot
   * be sent to another thread, so runs then take place in the calling one. */
  gpu?: object | undefined;
  /** Whether to work in a thread of its own, default true. */
  worker?: boolean | undefined;
}

/** A WebGPU adapter, as the browser describes it. Browsers may leave strings empty. */
export interface AdapterInfo {
  vendor: string;
  architecture: string;
  device: string;
  description: string;
  /** It computes on the CPU: correct, but slower than the CPU engine. */
  software: boolean;
  /** The largest buffer that a kernel can see, in bytes: what bounds the size of the input. */
  maxStorageBufferBindingSize: number;
}

/** What an engine works with. */
export interface EngineInfo {
  /** The engine that `'auto'` takes for large inputs. */
  engine: 'gpu' | 'cpu';
  /** Why that is the CPU engine; null where it is the GPU. */
  why: string | null;
  /** The adapter that was found, used or not. */
  adapter: AdapterInfo | null;
  /** Where the work is done. */
  thread: 'worker' | 'caller';
  /** Why it is done in the calling thread; null where there is a worker. */
  whyThread: string | null;
}

/** What a run did. */
export interface Stats {
  /** The engine that made the mesh. */
  engine: 'gpu' | 'cpu';
  /** Why the CPU engine made it, where that was not asked for; else null. */
  why: string | null;
  /** The adapter, where the GPU engine made the mesh. */
  adapter: AdapterInfo | null;
  /** Where the work was done, and why, if that was in the calling thread. */
  thread: 'worker' | 'caller';
  whyThread: string | null;
  /** The phases in the order in which they ran. */
  phases: { name: string; milliseconds: number }[];
  /** Milliseconds of the whole run, copies to and from WebAssembly included. */
  milliseconds: number;
  /** Signs that the floating-point filter left open, by what decided them. */
  exact: {
    /** Integers on the lattice. */
    integer: number;
    /** Expansions or big integers, where a point does not fit the lattice. */
    expansion: number;
    /** Cospherical points: the symbolic perturbation. */
    symbolic: number;
  };
  /** What the GPU did, also where the CPU engine had to take over from it; else null. */
  gpu: GpuStats | null;
  /** What star splaying did after that. */
  splay: SplayStats | null;
  /** Bytes of WebAssembly memory: the most that was ever needed, since it never shrinks. */
  wasmBytes: number;
}

/** What the flipping phase did on the GPU. */
export interface GpuStats {
  /** The insertion rounds, then the rounds in which the last flips were done. */
  rounds: {
    /** Points that were inserted. */
    inserted: number;
    /** Tetrahedra whose facets are still to be checked at the end. */
    active: number;
    flips: number;
    /** Flip iterations that had something to do. */
    iterations: number;
    milliseconds: number;
  }[];
  /** Flips of two tetrahedra into three. */
  flips23: number;
  /** Flips of three tetrahedra into two. */
  flips32: number;
  flipIterations: number;
  /** Signs that took exact arithmetic. */
  exactTests: number;
  /** Facets that were not locally Delaunay and could not be flipped. */
  notLocallyDelaunay: number;
  /** The vertices of such facets. */
  failedVertices: number;
  /** Points that another one at the same place of the lattice stood for. */
  united: number;
  readbacks: number;
  dispatches: number;
  submits: number;
  /** The most bytes of GPU memory that were held at a time. */
  bytes: number;
}

/** What star splaying did. */
export interface SplayStats {
  /** Flat tetrahedra on the hull that were peeled off. */
  peeled: number;
  /** Failed vertices. */
  failed: number;
  /** Stars that were made convex. */
  built: number;
  /** Of these, the ones that were built from their points. */
  fromPoints: number;
  /** Stars that were taken from the triangulation as they are. */
  pulled: number;
  /** Flips of Flip-Flop. */
  flips: number;
  /** Points that were inserted into stars. */
  insertions: number;
  /** Checks whether all stars agree about a tetrahedron. */
  checks: number;
  /** Tetrahedra that were removed from the triangulation. */
  removed: number;
  /** Tetrahedra that were added to it. */
  added: number;
  /** Points that only splaying inserted. */
  inserted: number;
  /** Signs that were asked for. */
  signs: number;
  /** Rounds of insertions. */
  rounds: number;
}

/** How a mesh came about, step by step, in the GPU engine. */
export interface Trace {
  /** The finite tetrahedra after each of {@link GpuStats.rounds}. The last are what splaying begins with. */
  rounds: { tetrahedra: Uint32Array }[];
  /** Three a facet: those between finite tetrahedra that were not locally Delaunay when flipping was done. */
  nonDelaunayFacets: Uint32Array;
  /** One a tetrahedron of the mesh: 0 if flipping made it, 1 if splaying did. */
  created: Uint8Array;
}

/** The distributions of {@link generate}. */
export type Distribution = 'uniform' | 'gaussian' | 'ball' | 'sphere' | 'thin-sphere' | 'grid';

/** The distributions of {@link generate2d}. */
export type Distribution2 =
  | 'uniform'
  | 'gaussian'
  | 'disk'
  | 'circle'
  | 'thin-circle'
  | 'grid'
  | 'two-lines'
  | 'clusters';

/** Points of a file. */
export interface PointCloud {
  /** x, y, z, x, y, z, … in the precision of the file. */
  points: Float32Array | Float64Array;
  /** Points of the file that are left out because they hold no measurement (NaN in a PCD file). */
  noReturn: number;
}

/** A property that the verifier decides, and how that ended. */
export interface Check {
  /** Such as `'orientation'` or `'delaunay'`. */
  name: string;
  outcome: 'passed' | 'failed' | 'not stated' | 'not decided';
  passed: boolean;
  /** The first defect, in words. */
  detail: string;
  /** In how many places the property does not hold. */
  defects: number;
}

/** What the verifier found. */
export interface Report {
  /** The mesh is the Delaunay triangulation of the points, with the ties broken as documented. */
  passed: boolean;
  /** The affine dimension of the points, 0 to 3. */
  dimension: number;
  checks: Check[];
  counts: {
    points: number;
    distinctPoints: number;
    vertices: number;
    edges: number;
    facets: number;
    tetrahedra: number;
    hullTriangles: number;
  };
}

/** What the verifier takes for a mesh: what is missing is not checked. */
export interface MeshStatement {
  tetrahedra: Uint32Array;
  neighbors?: Int32Array | undefined;
  hull?: Uint32Array | undefined;
  duplicateOf?: Int32Array | undefined;
  dimension?: number | undefined;
}

/** What the verifier found in the plane. */
export interface Report2 extends Omit<Report, 'counts'> {
  counts: {
    points: number;
    distinctPoints: number;
    vertices: number;
    edges: number;
    triangles: number;
    hullEdges: number;
  };
}

/** What the verifier takes for a mesh of the plane: what is missing is not checked. */
export interface MeshStatement2 {
  triangles: Uint32Array;
  halfedges?: Int32Array | undefined;
  hull?: Uint32Array | undefined;
  duplicateOf?: Int32Array | undefined;
  dimension?: number | undefined;
}
