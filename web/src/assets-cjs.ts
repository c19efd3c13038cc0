// The files of assets.ts for `require`: jest, and Node before it could `require` ES modules. They
// lie on a disk, so there are no copies, which jest could not import.

import type { WasmAsset, WorkerAsset } from './runtime.js';

export const wasm3d: WasmAsset = {
  name: 'd3',
  file: () => new URL('./gdel-3d.wasm', import.meta.url),
};

export const wasm2d: WasmAsset = {
  name: 'd2',
  file: () => new URL('./gdel-2d.wasm', import.meta.url),
};

export const wasmEdit: WasmAsset = {
  name: 'edit',
  file: () => new URL('./gdel-edit.wasm', import.meta.url),
};

export const wasmTools: WasmAsset = {
  name: 'tools',
  file: () => new URL('./gdel-tools.wasm', import.meta.url),
};

export const wasmDerived: WasmAsset = {
  name: 'derived',
  file: () => new URL('./gdel-derived.wasm', import.meta.url),
};

export const workerCode: WorkerAsset = { file: () => new URL('./worker.js', import.meta.url) };
export const taskCode = () => import('./core.js');
