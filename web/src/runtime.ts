// What differs between environments: each build has the implementation of its own.

import type { FromWorker, ModuleName, ToWorker } from './protocol.js';

/** A worker thread. */
export interface WorkerThread {
  post(message: ToWorker, transfer: ArrayBuffer[]): void;
  onMessage(handler: (message: FromWorker) => void): void;
  /** The thread did not start, or died. */
  onError(handler: (error: Error) => void): void;
  terminate(): void;
  /** Whether the process must stay alive for it. Browsers do not ask. */
  keepAlive(busy: boolean): void;
}

export interface Runtime {
  /** Compiles a wasm module. */
  compile(name: ModuleName): Promise<WebAssembly.Module>;
  /** The ways to start a worker, best first. Each waits until the worker has loaded its code. */
  workers: (() => Promise<WorkerThread>)[];
  /** The worker's code, for use in the calling thread. */
  code(): Promise<typeof import('./worker.js')>;
}

/**
 * The thread when it has loaded its code. To be called in the turn that made the thread: in Deno, a
 * message that was sent before the first listener is there can be lost.
 */
export function whenReady(thread: WorkerThread): Promise<WorkerThread> {
  return new Promise((resolve, reject) => {
    thread.onMessage((message) => message.type === 'ready' && resolve(thread));
    thread.onError((error) => {
      thread.terminate();
      reject(error);
    });
  });
}
