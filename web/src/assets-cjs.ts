// The files of assets.ts for `require`: jest, and Node before it could `require` ES modules. They
// lie on a disk, so there are no copies, which jest could not import.

import type { ModuleAsset, WasmAsset, WorkerAsset } from './runtime.js';

export const wasm3d: WasmAsset = {
  name: 'd3',
  file: () => new URL('./gdel-3d.wasm', import.meta.url),
};
export const code3d = () => import('./core-3d.js');
const worker3d: WorkerAsset = { file: () => new URL('./worker-3d.js', import.meta.url) };
export const module3d: ModuleAsset = { wasm: wasm3d, worker: worker3d, code: code3d };

export const wasm2d: WasmAsset = {
  name: 'd2',
  file: () => new URL('./gdel-2d.wasm', import.meta.url),
};
export const code2d = () => import('./core-2d.js');
const worker2d: WorkerAsset = { file: () => new URL('./worker-2d.js', import.meta.url) };
export const module2d: ModuleAsset = { wasm: wasm2d, worker: worker2d, code: code2d };

export const wasmEdit: WasmAsset = {
  name: 'edit',
  file: () => new URL('./gdel-edit.wasm', import.meta.url),
};
export const codeEdit = () => import('./core-edit.js');
const workerEdit: WorkerAsset = { file: () => new URL('./worker-edit.js', import.meta.url) };
export const moduleEdit: ModuleAsset = { wasm: wasmEdit, worker: workerEdit, code: codeEdit };

const wasmTools: WasmAsset = {
  name: 'tools',
  file: () => new URL('./gdel-tools.wasm', import.meta.url),
};
const codeTools = () => import('./core-tools.js');
const workerTools: WorkerAsset = { file: () => new URL('./worker-tools.js', import.meta.url) };
export const moduleTools: ModuleAsset = { wasm: wasmTools, worker: workerTools, code: codeTools };

export const wasmTransport: WasmAsset = {
  name: 'transport',
  file: () => new URL('./gdel-transport.wasm', import.meta.url),
};
export const codeTransport = () => import('./core-transport.js');
const workerTransport: WorkerAsset = {
  file: () => new URL('./worker-transport.js', import.meta.url),
};
export const moduleTransport: ModuleAsset = {
  wasm: wasmTransport,
  worker: workerTransport,
  code: codeTransport,
};

const wasmDerived: WasmAsset = {
  name: 'derived',
  file: () => new URL('./gdel-derived.wasm', import.meta.url),
};
const codeDerived = () => import('./core-derived.js');
const workerDerived: WorkerAsset = { file: () => new URL('./worker-derived.js', import.meta.url) };
export const moduleDerived: ModuleAsset = {
  wasm: wasmDerived,
  worker: workerDerived,
  code: codeDerived,
};

const wasmSurface: WasmAsset = {
  name: 'surface',
  file: () => new URL('./gdel-surface.wasm', import.meta.url),
};
const codeSurface = () => import('./core-surface.js');
const workerSurface: WorkerAsset = { file: () => new URL('./worker-surface.js', import.meta.url) };
export const moduleSurface: ModuleAsset = {
  wasm: wasmSurface,
  worker: workerSurface,
  code: codeSurface,
};
