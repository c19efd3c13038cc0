// Everything in one file: the worker's code as text, the wasm modules compressed and in base64.

import engine from 'base64:engine';
import plane from 'base64:plane';
import tools from 'base64:tools';
import source from 'text:worker';
import { type Runtime, whenReady } from './runtime.js';
import { blobWorker } from './web-worker.js';
import * as code from './worker.js';

export const runtime: Runtime = {
  async compile(name) {
    const binary = atob({ engine, plane, tools }[name]);
    const bytes = Uint8Array.from(binary, (character) => character.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
    return WebAssembly.compile(await new Response(stream).arrayBuffer());
  },
  workers: [() => whenReady(blobWorker(source))],
  code: async () => code,
};
