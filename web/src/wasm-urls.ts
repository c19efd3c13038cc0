// The wasm files beside this one, each written out, so that bundlers find them.

import type { ModuleName } from './protocol.js';

/** Functions, since only what is needed may be looked for. */
export const wasmUrl: Readonly<Record<ModuleName, () => URL>> = {
  engine: () => new URL('./gdel.wasm', import.meta.url),
  plane: () => new URL('./gdel-plane.wasm', import.meta.url),
  tools: () => new URL('./gdel-tools.wasm', import.meta.url),
};
