import * as Comlink from 'comlink';
import type { ModelWorker } from './worker';
import address from './worker?worker&url';

/** The model in its worker. */
export type ModelClient = Comlink.Remote<ModelWorker>;

export function connect(onError: () => void): ModelClient {
  const worker = startWorker(new URL(address, import.meta.url));
  worker.addEventListener('error', onError);
  return Comlink.wrap<ModelWorker>(worker);
}

/**
 * Starts a module as a worker. A page without an origin of its own, as in a sandboxed frame, may
 * only start scripts that it has made itself. Such a script imports the module, and keeps the
 * messages that come meanwhile.
 */
export function startWorker(url: URL): Worker {
  if (self.origin !== 'null') return new Worker(url, { type: 'module' });
  const script = `const early = [];
const keep = (event) => early.push(event);
addEventListener('message', keep);
import(${JSON.stringify(url.href)}).then(() => {
  removeEventListener('message', keep);
  for (const { data, ports } of early) dispatchEvent(new MessageEvent('message', { data, ports }));
}, (error) => setTimeout(() => { throw error; }));`;
  return new Worker(URL.createObjectURL(new Blob([script], { type: 'text/javascript' })));
}
