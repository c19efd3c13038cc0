/**
 * Exact 3D and 2D Delaunay triangulation in the browser and in Node: WebGPU where there is a GPU, WebAssembly everywhere.
 *
 * @packageDocumentation
 */
/// <reference lib="esnext.disposable" preserve="true" />

export { Delaunator } from './delaunator.js';
export { createEngine, delaunay2d, delaunay3d, Engine } from './engine.js';
export { GdelError, type GdelErrorCode } from './errors.js';
export { Mesh3 } from './mesh.js';
export { Mesh2 } from './mesh2.js';
export {
  type GenerateOptions,
  generate,
  generate2d,
  type ReadOptions,
  readPoints,
  verify,
  verify2d,
} from './tools.js';
export type {
  AccessorOptions,
  AdapterInfo,
  Check,
  Distribution,
  Distribution2,
  EngineInfo,
  EngineName,
  EngineOptions,
  GpuStats,
  MeshStatement,
  MeshStatement2,
  Output,
  PlaneOptions,
  PointCloud,
  Points,
  Progress,
  Report,
  Report2,
  RunOptions,
  SplayStats,
  Stats,
  TaskOptions,
  Trace,
} from './types.js';
