// The wasm files beside this one. Each URL is written out, so that bundlers find the file.

import type { ModuleName } from './protocol.js';

/** Functions, so that only the files that are needed are looked for. */
export const wasmUrl: Readonly<Record<ModuleName, () => URL>> = {
  d3: () => new URL('./gdel-3d.wasm', import.meta.url),
  d2: () => new URL('./gdel-2d.wasm', import.meta.url),
  tools: () => new URL('./gdel-tools.wasm', import.meta.url),
};
