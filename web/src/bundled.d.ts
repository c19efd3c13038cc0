// What the build script makes of the wasm packages and of the worker.

/**
 * The JavaScript side of the wasm modules, with a state of its own in each call: a broken instance
 * can be replaced. It has the exports of all modules; those of the named one work. Some calls of wgpu are
 * made by `calls`, if it is given.
 */
declare module 'glue' {
  const makeGlue: (moduleName: string, calls: object | undefined, globalThis: object) => any;
  export default makeGlue;
}

/** A compressed wasm module, which becomes a file of its own. */
declare module 'base64:*' {
  const base64: string;
  export default base64;
}

/** The text of the bundled worker, which becomes a file of its own. */
declare module 'text:worker' {
  const source: string;
  export default source;
}
