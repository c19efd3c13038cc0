// The wasm modules of this page, each compiled once for all workers.

import type { ModuleName } from './protocol.js';
import { compile, type Loaded, type WasmAsset } from './runtime.js';

const modules = new Map<ModuleName, Promise<Loaded<WebAssembly.Module>>>();

/** Returns a module. */
export function compiled(asset: WasmAsset): Promise<Loaded<WebAssembly.Module>> {
  let module = modules.get(asset.name);
  if (!module) {
    module = compile(asset).catch((error: unknown) => {
      // The next call tries again.
      modules.delete(asset.name);
      throw error;
    });
    modules.set(asset.name, module);
  }
  return module;
}
