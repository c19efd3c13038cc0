/**
 * Exact 3D and 2D Delaunay triangulation in the browser and in Node: WebGPU where there is a GPU, WebAssembly everywhere.
 *
 * @packageDocumentation
 */
/// <reference lib="esnext.disposable" preserve="true" />

export { createEngine, delaunay2d, delaunay3d, Engine } from './engine.js';
export { GdelError, type GdelErrorCode } from './errors.js';
export { Mesh3, type Mesh2 } from './mesh.js';
export { generate, readPoints, verify, type ReadOptions } from './tools.js';
export type {
  AccessorOptions,
  AdapterInfo,
  Check,
  Distribution,
  EngineInfo,
  EngineName,
  EngineOptions,
  GpuStats,
  MeshStatement,
  Output,
  PlaneOptions,
  PointCloud,
  Points,
  Progress,
  Report,
  RunOptions,
  SplayStats,
  Stats,
  TaskOptions,
  Trace,
} from './types.js';
