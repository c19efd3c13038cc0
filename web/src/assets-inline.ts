// The files of assets.ts as copies only: no URL is ever asked for.

import type { ModuleAsset, WasmAsset, WorkerAsset } from './runtime.js';

export const wasm3d: WasmAsset = { name: 'd3', copy: () => import('base64:d3') };
export const code3d = () => import('./core-3d.js');
const worker3d: WorkerAsset = { copy: () => import('text:d3') };
export const module3d: ModuleAsset = { wasm: wasm3d, worker: worker3d, code: code3d };

export const wasm2d: WasmAsset = { name: 'd2', copy: () => import('base64:d2') };
export const code2d = () => import('./core-2d.js');
const worker2d: WorkerAsset = { copy: () => import('text:d2') };
export const module2d: ModuleAsset = { wasm: wasm2d, worker: worker2d, code: code2d };

export const wasmEdit: WasmAsset = { name: 'edit', copy: () => import('base64:edit') };
export const codeEdit = () => import('./core-edit.js');
const workerEdit: WorkerAsset = { copy: () => import('text:edit') };
export const moduleEdit: ModuleAsset = { wasm: wasmEdit, worker: workerEdit, code: codeEdit };

const wasmTools: WasmAsset = { name: 'tools', copy: () => import('base64:tools') };
const codeTools = () => import('./core-tools.js');
const workerTools: WorkerAsset = { copy: () => import('text:tools') };
export const moduleTools: ModuleAsset = { wasm: wasmTools, worker: workerTools, code: codeTools };

export const wasmTransport: WasmAsset = {
  name: 'transport',
  copy: () => import('base64:transport'),
};
export const codeTransport = () => import('./core-transport.js');
const workerTransport: WorkerAsset = { copy: () => import('text:transport') };
export const moduleTransport: ModuleAsset = {
  wasm: wasmTransport,
  worker: workerTransport,
  code: codeTransport,
};

const wasmDerived: WasmAsset = { name: 'derived', copy: () => import('base64:derived') };
const codeDerived = () => import('./core-derived.js');
const workerDerived: WorkerAsset = { copy: () => import('text:derived') };
export const moduleDerived: ModuleAsset = {
  wasm: wasmDerived,
  worker: workerDerived,
  code: codeDerived,
};

const wasmSurface: WasmAsset = { name: 'surface', copy: () => import('base64:surface') };
const codeSurface = () => import('./core-surface.js');
const workerSurface: WorkerAsset = { copy: () => import('text:surface') };
export const moduleSurface: ModuleAsset = {
  wasm: wasmSurface,
  worker: workerSurface,
  code: codeSurface,
};
