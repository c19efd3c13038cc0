import type { WorkerThread } from './runtime.js';

/** A `Worker` of the web's interface. */
export function webWorker(worker: Worker): WorkerThread {
  return {
    post: (message, transfer) => worker.postMessage(message, transfer),
    onMessage: (handler) => worker.addEventListener('message', (event) => handler(event.data)),
    onError(handler) {
      worker.addEventListener('error', (event) => {
        event.preventDefault();
        handler(new Error(event.message || 'the worker was blocked or could not be loaded'));
      });
      worker.addEventListener('messageerror', () =>
        handler(new Error('a message could not be read')),
      );
    },
    terminate: () => worker.terminate(),
    keepAlive() {},
  };
}

/** A worker from its source text. */
export function blobWorker(source: string): WorkerThread {
  const url = URL.createObjectURL(new Blob([source], { type: 'text/javascript' }));
  const thread = webWorker(new Worker(url, { type: 'module', name: 'gdel-wasm' }));
  // The worker fetches its script after this, and says that it is there by its first message.
  const revoke = () => URL.revokeObjectURL(url);
  thread.onMessage(revoke);
  thread.onError(revoke);
  return thread;
}
