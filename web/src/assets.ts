// The files beside this one, and modules that hold copies of them for where a URL leads nowhere:
// bundlers without assets, strange servers, opaque origins. Each URL and each import is written out
// and stands alone, so that bundlers find what they need and leave out what is not used.

import type { WasmAsset, WorkerAsset } from './runtime.js';

export const wasm3d: WasmAsset = {
  name: 'd3',
  file: () => new URL('./gdel-3d.wasm', import.meta.url),
  copy: () => import('base64:d3'),
};

export const wasm2d: WasmAsset = {
  name: 'd2',
  file: () => new URL('./gdel-2d.wasm', import.meta.url),
  copy: () => import('base64:d2'),
};

export const wasmEdit: WasmAsset = {
  name: 'edit',
  file: () => new URL('./gdel-edit.wasm', import.meta.url),
  copy: () => import('base64:edit'),
};

export const wasmTools: WasmAsset = {
  name: 'tools',
  file: () => new URL('./gdel-tools.wasm', import.meta.url),
  copy: () => import('base64:tools'),
};

export const wasmDerived: WasmAsset = {
  name: 'derived',
  file: () => new URL('./gdel-derived.wasm', import.meta.url),
  copy: () => import('base64:derived'),
};

/** Hides a URL from bundlers. */
const here = () => import.meta.url;

export const workerCode: WorkerAsset = {
  start: () =>
    new Worker(new URL('./worker.js', import.meta.url), { type: 'module', name: 'gdel' }),
  // Node's threads take this one. Bundlers would copy the file a second time.
  file: () => new URL('./worker.js', here()),
  copy: () => import('text:worker'),
};

/** The worker's tasks, for the calling thread. */
export const taskCode = () => import('./core.js');
