// Browsers and Deno: files beside this one.

import { type Runtime, whenReady } from './runtime.js';
import { wasmUrl } from './wasm-urls.js';
import { blobWorker, webWorker } from './web-worker.js';

export const runtime: Runtime = {
  async compile(name) {
    const response = await fetch(wasmUrl[name]());
    if (!response.ok) throw new Error(`${response.url}: ${response.status} ${response.statusText}`);
    // Streaming compilation needs the right type, which not every server sends.
    if (response.headers.get('content-type')?.startsWith('application/wasm')) {
      return WebAssembly.compileStreaming(response);
    }
    return WebAssembly.compile(await response.arrayBuffer());
  },

  workers: [
    () =>
      whenReady(
        webWorker(
          new Worker(new URL('./worker.js', import.meta.url), {
            type: 'module',
            name: 'gdel-wasm',
          }),
        ),
      ),
    // Scripts from another origin, such as a CDN, may not be workers, but their text may.
    async () => {
      const url = new URL('./worker.js', import.meta.url);
      if (url.origin === globalThis.location?.origin)
        throw new Error('the worker was blocked or could not be loaded');
      const response = await fetch(url);
      if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
      return whenReady(blobWorker(await response.text()));
    },
  ],

  code: () => import('./worker.js'),
};
