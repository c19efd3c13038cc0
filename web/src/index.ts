/**
 * Exact 3D and 2D Delaunay triangulation in browsers, Node, Deno and Bun: with WebGPU if there is a
 * GPU, with WebAssembly everywhere.
 *
 * @packageDocumentation
 */
/// <reference lib="esnext.disposable" preserve="true" />

export type {
  AlphaOptions,
  AlphaShape,
  BallComplex,
  BallOptions,
  Bounds,
  Contour2,
  Contour3,
  ContourOptions,
  Geometry,
  GridOptions,
  Interpolated,
  InterpolateOptions,
  InterpolationMethod,
  InterpolationWeights,
  LocateOptions,
  LocationsOnSphere,
  NearestOptions,
  Refinement,
  RefineOptions,
  SphereArrays,
  SphereEdges,
  SphereVoronoiArrays,
  Surface2,
  SurfaceArrays,
  SurfaceOptions,
  Topology,
  Transport,
  TransportOptions,
  VoronoiArrays,
  VoronoiOptions,
} from './answers.js';
export type { Bytes, Coordinates, Doubles, Indices, SignedIndices } from './arrays.js';
export type { Mesh } from './changing.js';
export type { Constrained, ConstrainedArrays } from './constrained.js';
export { Delaunator } from './delaunator.js';
export { SpanningTree, Surface3 } from './derived.js';
export { GdelError, type GdelErrorCode } from './errors.js';
export { Triangles } from './files.js';
export { type Locations3, Mesh3 } from './mesh.js';
export { type Locations2, Mesh2 } from './mesh2.js';
/** @internal */
export { loadPower, powerNow, runPower } from './power.js';
export {
  type GpuBuffer,
  type ResidentArrays2,
  type ResidentArrays3,
  type ResidentMesh,
  ResidentMesh2,
  ResidentMesh3,
} from './resident.js';
export { delaunaySphere, SphereMesh, type SphereOptions, SphereVoronoi } from './sphere.js';
export type { ExactCounts, GpuStats, Round, SplayStats, UpdateStats } from './stats.js';
export { delaunay2dSync, delaunay3dSync, load2d, load3d, loadConstraints } from './sync.js';
/** @internal */
export { runTin, write } from './terrain.js';
export {
  type GenerateOptions,
  generate,
  generate2d,
  type ReadOptions,
  type ReadPointsOptions,
  readPoints,
  readShapes,
  verify,
  verify2d,
} from './tools.js';
export { createTriangulator, delaunay2d, delaunay3d, Triangulator } from './triangulator.js';
export type {
  AccessorOptions,
  AdapterInfo,
  Backend,
  Check,
  ColorSource,
  ConstraintOptions,
  Distribution,
  Distribution2,
  Fill,
  MeshView,
  MeshView2,
  MoveOptions,
  Output,
  Place,
  PointCloud,
  Points,
  Progress,
  Report,
  Report2,
  RunOptions,
  RunOptions2,
  Shapes,
  Stats,
  SyncOptions,
  TaskOptions,
  Trace,
  TriangulatorInfo,
  TriangulatorOptions,
  UpdateOptions,
} from './types.js';
export { type Polygon, Voronoi2 } from './voronoi2.js';
