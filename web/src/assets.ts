// The files beside this one, and modules that hold copies of them for where a URL leads nowhere:
// bundlers without assets, strange servers, opaque origins. Each URL and each import is written out
// and stands alone, so that bundlers find what they need and leave out what is not used. webpack puts workers of
// one name into one file.

import type { ModuleAsset, WasmAsset, WorkerAsset } from './runtime.js';

/** Hides a URL from bundlers: Node's threads take it, and bundlers would copy the file a second time. */
const here = () => import.meta.url;

export const wasm3d: WasmAsset = {
  name: 'd3',
  file: () => new URL('./gdel-3d.wasm', import.meta.url),
  copy: () => import('base64:d3'),
};
export const code3d = () => import('./core-3d.js');
const worker3d: WorkerAsset = {
  start: () =>
    new Worker(new URL('./worker-3d.js', import.meta.url), {
      type: 'module',
      name: 'gdel-3d',
    }),
  file: () => new URL('./worker-3d.js', here()),
  copy: () => import('text:d3'),
};
export const module3d: ModuleAsset = { wasm: wasm3d, worker: worker3d, code: code3d };

export const wasm2d: WasmAsset = {
  name: 'd2',
  file: () => new URL('./gdel-2d.wasm', import.meta.url),
  copy: () => import('base64:d2'),
};
export const code2d = () => import('./core-2d.js');
const worker2d: WorkerAsset = {
  start: () =>
    new Worker(new URL('./worker-2d.js', import.meta.url), {
      type: 'module',
      name: 'gdel-2d',
    }),
  file: () => new URL('./worker-2d.js', here()),
  copy: () => import('text:d2'),
};
export const module2d: ModuleAsset = { wasm: wasm2d, worker: worker2d, code: code2d };

export const wasmEdit: WasmAsset = {
  name: 'edit',
  file: () => new URL('./gdel-edit.wasm', import.meta.url),
  copy: () => import('base64:edit'),
};
export const codeEdit = () => import('./core-edit.js');
const workerEdit: WorkerAsset = {
  start: () =>
    new Worker(new URL('./worker-edit.js', import.meta.url), {
      type: 'module',
      name: 'gdel-edit',
    }),
  file: () => new URL('./worker-edit.js', here()),
  copy: () => import('text:edit'),
};
export const moduleEdit: ModuleAsset = { wasm: wasmEdit, worker: workerEdit, code: codeEdit };

const wasmTools: WasmAsset = {
  name: 'tools',
  file: () => new URL('./gdel-tools.wasm', import.meta.url),
  copy: () => import('base64:tools'),
};
const codeTools = () => import('./core-tools.js');
const workerTools: WorkerAsset = {
  start: () =>
    new Worker(new URL('./worker-tools.js', import.meta.url), {
      type: 'module',
      name: 'gdel-tools',
    }),
  file: () => new URL('./worker-tools.js', here()),
  copy: () => import('text:tools'),
};
export const moduleTools: ModuleAsset = { wasm: wasmTools, worker: workerTools, code: codeTools };

export const wasmTransport: WasmAsset = {
  name: 'transport',
  file: () => new URL('./gdel-transport.wasm', import.meta.url),
  copy: () => import('base64:transport'),
};
export const codeTransport = () => import('./core-transport.js');
const workerTransport: WorkerAsset = {
  start: () =>
    new Worker(new URL('./worker-transport.js', import.meta.url), {
      type: 'module',
      name: 'gdel-transport',
    }),
  file: () => new URL('./worker-transport.js', here()),
  copy: () => import('text:transport'),
};
export const moduleTransport: ModuleAsset = {
  wasm: wasmTransport,
  worker: workerTransport,
  code: codeTransport,
};

const wasmDerived: WasmAsset = {
  name: 'derived',
  file: () => new URL('./gdel-derived.wasm', import.meta.url),
  copy: () => import('base64:derived'),
};
const codeDerived = () => import('./core-derived.js');
const workerDerived: WorkerAsset = {
  start: () =>
    new Worker(new URL('./worker-derived.js', import.meta.url), {
      type: 'module',
      name: 'gdel-derived',
    }),
  file: () => new URL('./worker-derived.js', here()),
  copy: () => import('text:derived'),
};
export const moduleDerived: ModuleAsset = {
  wasm: wasmDerived,
  worker: workerDerived,
  code: codeDerived,
};

const wasmSurface: WasmAsset = {
  name: 'surface',
  file: () => new URL('./gdel-surface.wasm', import.meta.url),
  copy: () => import('base64:surface'),
};
const codeSurface = () => import('./core-surface.js');
const workerSurface: WorkerAsset = {
  start: () =>
    new Worker(new URL('./worker-surface.js', import.meta.url), {
      type: 'module',
      name: 'gdel-surface',
    }),
  file: () => new URL('./worker-surface.js', here()),
  copy: () => import('text:surface'),
};
export const moduleSurface: ModuleAsset = {
  wasm: wasmSurface,
  worker: workerSurface,
  code: codeSurface,
};
