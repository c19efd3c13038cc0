// What differs between environments. Each build has the one of its own in place of this file's implementation.

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
  /** The ways to start a worker, best first. */
  workers: (() => WorkerThread | Promise<WorkerThread>)[];
  /** The worker's code, for use in the calling thread. */
  code(): Promise<typeof import('./worker.js')>;
}
