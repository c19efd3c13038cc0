// Instances of a wasm module.

import type { PlainError } from './errors.js';

/** What wasm-bindgen exports for every module. */
interface AnyGlue {
  initSync(module: { module: WebAssembly.Module }): object;
}

export interface Instance<Glue> {
  glue: Glue;
  memory: WebAssembly.Memory;
}

/** Returns an instance with its own state, or throws a {@link PlainError}. */
export function instantiate<Glue extends AnyGlue>(
  makeGlue: MakeGlue<Glue>,
  module: WebAssembly.Module,
  scope: object = globalThis,
): Instance<Glue> {
  try {
    const glue = makeGlue(scope);
    // Not declared for modules in which nobody else asks for it.
    const { memory } = glue.initSync({ module }) as { memory: WebAssembly.Memory };
    return { glue, memory };
  } catch (error) {
    const why = `WebAssembly cannot be started: ${String(error)}`;
    if (error instanceof RangeError) throw { code: 'OUT_OF_MEMORY', message: why, fatal: true };
    const message = `${why}. Deploy all files of one version of gdel-wasm together`;
    throw { code: 'LOAD_FAILED', message, fatal: true } satisfies PlainError;
  }
}
