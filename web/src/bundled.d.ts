// What the build script makes of the wasm packages and of the workers.

/**
 * Returns an instance of the JavaScript that wasm-bindgen has written for a module, with a state of its
 * own: a broken one can be replaced. Takes what stands for the global object.
 */
type MakeGlue<Glue> = (globalThis: object) => Glue;

/** Whether this code is bundled for a worker, which never drives the device of another thread. */
declare const IN_WORKER: boolean;

/** The version of the package. */
declare const VERSION: string;

declare module 'glue:d3' {
  const makeGlue: MakeGlue<typeof import('../pkg/d3/gdel.js')>;
  export default makeGlue;
}

declare module 'glue:d2' {
  const makeGlue: MakeGlue<typeof import('../pkg/d2/gdel.js')>;
  export default makeGlue;
}

declare module 'glue:edit' {
  const makeGlue: MakeGlue<typeof import('../pkg/edit/gdel.js')>;
  export default makeGlue;
}

declare module 'glue:tools' {
  const makeGlue: MakeGlue<typeof import('../pkg/tools/gdel.js')>;
  export default makeGlue;
}

declare module 'glue:transport' {
  const makeGlue: MakeGlue<typeof import('../pkg/transport/gdel.js')>;
  export default makeGlue;
}

declare module 'glue:surface' {
  const makeGlue: MakeGlue<typeof import('../pkg/surface/gdel.js')>;
  export default makeGlue;
}

declare module 'glue:derived' {
  const makeGlue: MakeGlue<typeof import('../pkg/derived/gdel.js')>;
  export default makeGlue;
}

/** A compressed wasm module, which becomes a file of its own. */
declare module 'base64:*' {
  const base64: string;
  export default base64;
}

/** The text of a bundled worker, which becomes a file of its own. */
declare module 'text:*' {
  const source: string;
  export default source;
}
