// The files of assets.ts as copies only: no URL is ever asked for.

import type { WasmAsset, WorkerAsset } from './runtime.js';

export const wasm3d: WasmAsset = { name: 'd3', copy: () => import('base64:d3') };
export const wasm2d: WasmAsset = { name: 'd2', copy: () => import('base64:d2') };
export const wasmEdit: WasmAsset = { name: 'edit', copy: () => import('base64:edit') };
export const wasmTools: WasmAsset = { name: 'tools', copy: () => import('base64:tools') };
export const wasmDerived: WasmAsset = {
  name: 'derived',
  copy: () => import('base64:derived'),
};
export const workerCode: WorkerAsset = { copy: () => import('text:worker') };
export const taskCode = () => import('./core.js');
