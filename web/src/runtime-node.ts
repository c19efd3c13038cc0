// Node: files beside this one, read and not fetched; worker threads.

import { readFile } from 'node:fs/promises';
import { Worker } from 'node:worker_threads';
import { type Runtime, whenReady } from './runtime.js';
import { wasmUrl } from './wasm-urls.js';

export const runtime: Runtime = {
  async compile(name) {
    return WebAssembly.compile(await readFile(wasmUrl[name]()));
  },

  workers: [
    () => {
      const worker = new Worker(new URL('./worker-node.js', import.meta.url), {
        name: 'gdel-wasm',
      });
      return whenReady({
        post: (message, transfer) => worker.postMessage(message, transfer),
        onMessage: (handler) => worker.on('message', handler),
        onError: (handler) => worker.on('error', handler),
        terminate: () => void worker.terminate(),
        keepAlive: (busy) => (busy ? worker.ref() : worker.unref()),
      });
    },
  ],

  code: () => import('./worker.js'),
};
