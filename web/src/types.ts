import type { Bytes, Coordinates, Doubles, Indices } from './arrays.js';
import type { Stats as RunStats } from './stats.js';

/**
 * Points: x, y, z, x, y, z, … in one array, typed or not, or one row per point. Every finite number
 * counts with its exact value.
 *
 * A `Float32Array` or `Float64Array` is fastest. Anything else is converted: integers of at most 16
 * bits to a `Float32Array`, the rest to a `Float64Array`. More than 2 MB are copied or converted in
 * slices, so that the page stays responsive: do not change them before the result is there.
 */
export type Points = ArrayLike<number> | ArrayLike<ArrayLike<number>>;

/**
 * What computes a mesh. `'auto'` is the GPU for large inputs if it is hardware, and otherwise the
 * CPU.
 */
export type Backend = 'auto' | 'gpu' | 'cpu';

/**
 * The arrays that a run can return besides the tetrahedra. `'trace'` is for small inputs, since
 * everything is then read back from the GPU after every round.
 */
export type Output = 'neighbors' | 'hull' | 'duplicateOf' | 'trace';

/** The progress of a run. */
export interface Progress {
  /** The name of the running phase, as in `stats.phases`. */
  phase: string;
  /**
   * The completed part of the run, 0 to 1. It never decreases, unless the CPU takes over from the
   * GPU, or an update begins anew.
   */
  fraction: number;
}

/** Options of everything that can take long. */
export interface TaskOptions {
  /**
   * Aborts the work within 100 ms. The promise is rejected at once: with the signal's reason, or
   * with a {@link GdelError} of code `ABORTED` in place of the usual `AbortError`.
   */
  signal?: AbortSignal | undefined;
  /**
   * Called at most about 50 times per second, the last time with fraction 1. If it throws, or
   * returns a promise that is rejected, the work ends with that error.
   */
  onProgress?: ((progress: Progress) => void) | undefined;
}

/** Options for a 3D triangulation. */
export interface RunOptions extends TaskOptions {
  /**
   * The backend; the result does not depend on it. Default: that of the triangulator, or `'auto'`.
   */
  backend?: Backend | undefined;
  /**
   * The number of workers with which the CPU triangulates, each of them a part of the points, from 1 to 64. The result
   * does not depend on it. Default: as many as the machine has processors, but one for each 50,000 points.
   */
  threads?: number | undefined;
  /** The arrays to return besides `tetrahedra`; others are empty. Default: all but `'trace'`. */
  outputs?: readonly Output[] | undefined;
  /**
   * Whether to transfer the buffer of a `Float32Array` or `Float64Array` instead of copying it. The
   * array, and every other view of its buffer, is then empty. The mesh has the coordinates; if the
   * run fails, {@link GdelError.points} has them. An abort can lose them, since it may end the
   * worker that has them. Default: false.
   */
  transfer?: boolean | undefined;
  /**
   * Factors by which the coordinates are multiplied first, one per axis, such as for degrees and metres;
   * true for those that give each axis the same extent. The mesh is that of the scaled coordinates, which
   * it has, with the factors as `factors`; points of updates and queries are scaled as well. Then
   * `transfer` has no effect. Default: false.
   */
  rescale?: boolean | readonly number[] | undefined;
  /**
   * One weight per point: the mesh is the regular triangulation, the dual of the power diagram, and points
   * can be `hidden`. A point of weight *w* counts as a ball of radius √*w*; only differences of weights
   * count. The CPU computes it. Not together with `radii`, `rescale` or `resident`.
   */
  weights?: ArrayLike<number> | undefined;
  /** One radius per point instead of `weights`, which are its squares. */
  radii?: ArrayLike<number> | undefined;
  /**
   * Whether the mesh stays on the device of a triangulator that was created with the option
   * `device`; `outputs` then has no meaning. Default: false.
   */
  resident?: boolean | undefined;
  /**
   * A mesh that is not needed any more: its arrays, apart from the points, become empty, and those
   * that the GPU makes are written where they fit into their memory. Fresh memory takes the system
   * longer to provide than the arrays take to copy.
   */
  reuse?: MeshView | undefined;
}

/** Which triangles are inside the boundaries of a mesh: see {@link ConstraintOptions.fill}. */
export type Fill = 'all' | 'evenodd' | 'nonzero' | 'enclosed';

/**
 * Segments that are to be edges of a 2D mesh, which is then the constrained Delaunay triangulation: unique, whatever
 * their order. A segment that leads through a point is two segments there, exactly. Segments may overlap, and may be
 * given several times; those whose ends are equal are ignored. The CPU computes the mesh. Not together with `weights`,
 * `radii`, `rescale` or `resident`.
 */
export interface ConstraintOptions {
  /** Segments that bound nothing, such as breaklines: pairs of indices of points, or two indices each in one array. */
  edges?: ArrayLike<number> | ArrayLike<ArrayLike<number>> | undefined;
  /** Boundaries through given points: closed polygons as arrays of indices. */
  rings?: ArrayLike<ArrayLike<number>> | undefined;
  /**
   * Boundaries that bring their own points, which follow the given ones: polygons as arrays of rings of positions, like
   * the coordinates of a GeoJSON `MultiPolygon`. A last position that repeats the first one is left out.
   */
  polygons?: ArrayLike<ArrayLike<ArrayLike<ArrayLike<number>>>> | undefined;
  /** Places in holes: the region around each is outside, whatever the fill rule, and segments separate regions. */
  holes?: ArrayLike<ArrayLike<number>> | undefined;
  /**
   * Which triangles are inside: all; those from which a way out crosses boundaries an odd number of times; those
   * around which boundaries wind, with turns in one direction less those in the other; or those from which no way
   * leads out without crossing a segment, `edges` or not. Default: `'evenodd'` with `rings` or `polygons`, else `'all'`.
   */
  fill?: Fill | undefined;
  /**
   * What becomes of segments that cross where there is no point: an error of code `CROSSING_CONSTRAINTS`, or a point
   * there, rounded to the nearest coordinates, which follows all others. Default: `'error'`.
   */
  crossings?: 'error' | 'split' | undefined;
}

/** Options for a 2D triangulation. */
export interface RunOptions2 extends Omit<RunOptions, 'outputs' | 'reuse'>, ConstraintOptions {
  /** As in 3D. */
  reuse?: MeshView2 | undefined;
}

/** Options for a 3D triangulation in the calling thread. */
export type SyncOptions = Pick<RunOptions, 'outputs'>;

/** Options for points that are objects. */
export interface AccessorOptions<T> extends RunOptions {
  /** Returns the coordinates of an item. */
  point: (item: T, index: number) => ArrayLike<number>;
}

/** Options of `update`. */
export interface UpdateOptions extends TaskOptions, Pick<RunOptions, 'transfer'> {}

/** Options of the `update` of meshes that are not resident. */
export interface MoveOptions extends UpdateOptions, Pick<RunOptions, 'weights' | 'radii'> {}

/** Options of `createTriangulator`. */
export interface TriangulatorOptions {
  /**
   * The backend of runs that do not choose one, default `'auto'`. With `'gpu'`,
   * `createTriangulator` fails if no GPU can be used.
   */
  backend?: Backend | undefined;
  /**
   * A `GPU` object to use instead of `navigator.gpu`, such as `create([])` of the npm package
   * `webgpu` in Node. It cannot be sent to another thread, so runs then take place in the calling
   * thread.
   */
  gpu?: object | undefined;
  /**
   * A `GPUDevice` to use. It remains the caller's, and allows the option `resident` and points in a
   * `GPUBuffer`. The calling thread drives it, while a worker does what takes long. WebGPU's default
   * limits suffice; larger buffers allow larger inputs.
   */
  device?: object | undefined;
  /**
   * Whether to work in a worker, default true. With `false`, the calling thread does everything, which
   * blocks it.
   */
  worker?: boolean | undefined;
  /**
   * Whether a GPU has to compute meshes that are known before it is used. One that fails is an error
   * of code `GPU_WRONG`; `'auto'` takes the CPU. Default: true for hardware in browsers, where what has
   * passed is remembered, and false in Node and for a `device` of yours. With true, software has to as
   * well.
   */
  selfTest?: boolean | undefined;
}

/** A WebGPU adapter, as the browser describes it. Browsers may leave strings empty. */
export interface AdapterInfo {
  vendor: string;
  architecture: string;
  device: string;
  description: string;
  /** Whether it computes on the CPU: correctly, but slower than the CPU backend. */
  software: boolean;
  /** The largest buffer that a kernel can bind, in bytes: this limits the size of the input. */
  maxStorageBufferBindingSize: number;
}

/** Where the work is done. */
export interface Place {
  /** A worker, or the calling thread. */
  thread: 'worker' | 'caller';
  /** Why it is the calling thread; null if it is a worker. */
  whyThread: string | null;
  /**
   * Why the WebAssembly module or the worker was not loaded from its file but from the copy that
   * the package has in JavaScript; null if the files were loaded. The result is the same.
   */
  whyInlined: string | null;
}

/** What a triangulator uses. */
export interface TriangulatorInfo extends Place {
  /** The backend for large inputs. */
  backend: 'gpu' | 'cpu';
  /** Why that is the CPU, if it was not requested explicitly; otherwise null. */
  fallback: string | null;
  /** The adapter that was found, whether it is used or not. */
  adapter: AdapterInfo | null;
}

/** Statistics of the run that computed a mesh. */
export interface Stats extends RunStats, Place {
  /** The number of workers that have triangulated: more than 1 if the CPU has, by several. */
  threads: number;
  /** The adapter, if the GPU computed the mesh. */
  adapter: AdapterInfo | null;
  /** Milliseconds of the whole run, including copies to and from WebAssembly. */
  milliseconds: number;
  /** The size of the WebAssembly memory in bytes: the maximum so far, since it never shrinks. */
  wasmBytes: number;
  /**
   * The bytes of arrays of a GPU that went to memory that was ready: that of the option `reuse`, or
   * what other threads had prepared.
   */
  readyBytes: number;
}

/** The intermediate triangulations of a run on the GPU. */
export interface Trace {
  /** The finite tetrahedra after each round of Phase 1. Star splaying begins with the last. */
  rounds: { tetrahedra: Indices }[];
  /**
   * Three vertices per facet: the facets between finite tetrahedra that were not locally Delaunay
   * after Phase 1.
   */
  nonDelaunayFacets: Indices;
  /** One per tetrahedron of the mesh: 0 if Phase 1 created it, 1 if star splaying did. */
  created: Bytes;
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

/** The points of a file. */
export interface PointCloud {
  /** x, y, z, x, y, z, … in the precision of the file; x, y, x, y, … if `dimension` is 2. */
  points: Coordinates;
  /**
   * The number of points that are left out because they hold no measurement: NaN in a PCD file,
   * points that an E57 file says are invalid.
   */
  noReturn: number;
  /**
   * Red, green and blue of each point, in sRGB, or what can stand for them: `colorSource` says what.
   * `null` if the file says nothing about colours, or the same of all points.
   */
  colors: Uint8Array<ArrayBuffer> | null;
  /** What `colors` are; `null` if there are none. */
  colorSource: ColorSource | null;
  /**
   * The normal of each point, three coordinates, of length 1, or 0 where one is unknown; `null` if the file
   * has none.
   */
  normals: Float32Array<ArrayBuffer> | null;
  /** The positions of the scanner, one for each point or one for all; `null` if the file has none. */
  sensors: Float64Array<ArrayBuffer> | null;
}

/**
 * What the colours of points stand for: colours that the file has; intensities, as shades of grey
 * from the 2nd to the 98th percentile; normals, whose *x*, *y* and *z* from −1 to 1 are red, green
 * and blue.
 */
export type ColorSource = 'rgb' | 'intensity' | 'normals';

/** The shapes of a file, as `delaunay2d` takes them: `delaunay2d(shapes.points, shapes)`. */
export interface Shapes {
  /** x, y, x, y, … */
  points: Doubles;
  /** Lines: pairs of indices of points. */
  edges: Indices;
  /** Closed polygons and outlines, by the indices of their points. */
  rings: Indices[];
  /** Places in holes, which `.poly` files have. */
  holes: [number, number][];
  /** What the format takes for the inside. */
  fill: Fill;
  /** Whether there were heights, which are dropped. */
  droppedZ: boolean;
  /** What was left out, such as `'2 text'`. */
  leftOut: string[];
}

/** A property of a mesh, and what the verifier found about it. */
export interface Check {
  /** The name of the property, such as `'orientation'` or `'delaunay'`. */
  name: string;
  outcome: 'passed' | 'failed' | 'not stated' | 'not decided';
  passed: boolean;
  /** The first violation, in words. */
  detail: string;
  /** The number of violations. */
  defects: number;
}

/** What the verifier found in 3D. */
export interface Report {
  /**
   * Whether the mesh is the Delaunay triangulation of the points, with ties broken as documented.
   */
  passed: boolean;
  /** The affine dimension of the points, 0 to 3. */
  dimension: number;
  checks: Check[];
  counts: {
    points: number;
    distinctPoints: number;
    /** Those that the mesh states to be unused, which are not looked at. */
    unusedPoints: number;
    vertices: number;
    edges: number;
    facets: number;
    tetrahedra: number;
    hullTriangles: number;
  };
}

/** The arrays of a 3D mesh. What is missing is not looked at. */
export interface MeshView {
  tetrahedra: Uint32Array;
  neighbors?: Int32Array | undefined;
  hull?: Uint32Array | undefined;
  duplicateOf?: Int32Array | undefined;
  dimension?: number | undefined;
  /** The weights of the points, if the mesh is to be their regular triangulation. */
  weights?: Float64Array | null | undefined;
  /** The points that are no vertices because of their weights. */
  hidden?: Uint32Array | undefined;
}

/** What the verifier found in 2D. */
export interface Report2 extends Omit<Report, 'counts'> {
  counts: {
    points: number;
    distinctPoints: number;
    /** Those that the mesh states to be unused, which are not looked at. */
    unusedPoints: number;
    vertices: number;
    edges: number;
    triangles: number;
    hullEdges: number;
  };
}

/** The arrays of a 2D mesh. What is missing is not looked at. */
export interface MeshView2 {
  triangles: Uint32Array;
  halfedges?: Int32Array | undefined;
  hull?: Uint32Array | undefined;
  duplicateOf?: Int32Array | undefined;
  dimension?: number | undefined;
  /** As in 3D. */
  weights?: Float64Array | null | undefined;
  hidden?: Uint32Array | undefined;
  /**
   * The constrained edges, across which triangles need not be Delaunay; with `segments`, it is verified that the edges
   * are those of these segments and no others.
   */
  constraints?: { edges: Uint32Array; segments?: Uint32Array | undefined } | null | undefined;
}
