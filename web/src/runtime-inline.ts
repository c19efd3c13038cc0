// Everything in one file: the worker's code as text, the wasm modules compressed and in base64.

import d2 from 'base64:d2';
import d3 from 'base64:d3';
import tools from 'base64:tools';
import source from 'text:worker';
import { type Runtime, whenReady } from './runtime.js';
import { blobWorker } from './web-worker.js';
import * as code from './worker.js';

export const runtime: Runtime = {
  async compile(name) {
    const binary = atob({ d3, d2, tools }[name]);
    const bytes = Uint8Array.from(binary, (character) => character.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
    return WebAssembly.compile(await new Response(stream).arrayBuffer());
  },
  workers: [() => whenReady(blobWorker(source))],
  code: async () => code,
};
