// The worker of a wasm module: one task at a time.

import { openCore } from '#core';
import { buffersOf } from './arrays.js';
import { builtin } from './builtin.js';
import type { Core } from './core.js';
import type { PlainError } from './errors.js';
import type { FromWorker, ToWorker } from './protocol.js';

/** The port to whoever started this worker. */
interface Port {
  post(message: FromWorker, transfer: ArrayBuffer[]): void;
  listen(handler: (message: ToWorker) => void): void;
}

/** Returns the core of the module, or why there is none. */
function coreOrError({ module, selfTest }: ToWorker & { type: 'load' }): Core | PlainError {
  try {
    return openCore(module, { selfTest });
  } catch (error) {
    return error as PlainError;
  }
}

/** Serves the tasks that come through `port`. */
function serve(port: Port): void {
  let core: Core | PlainError;
  const aborted = new Set<number>();

  async function run({ id, task, args, isWatched }: ToWorker & { type: 'run' }) {
    try {
      if ('code' in core) throw core;
      const result = await core.run(task, args, {
        onProgress(progress) {
          if (isWatched) port.post({ type: 'progress', id, progress }, []);
        },
        onBlocking() {
          if (isWatched) port.post({ type: 'blocking', id }, []);
        },
        isAborted: () => aborted.has(id),
      });
      port.post({ type: 'done', id, result }, buffersOf(result));
    } catch (thrown) {
      const error = thrown as PlainError;
      port.post({ type: 'failed', id, error }, buffersOf(error.points));
    } finally {
      aborted.delete(id);
    }
  }

  port.listen((message) => {
    if (message.type === 'load') core = coreOrError(message);
    else if (message.type === 'run') void run(message);
    else aborted.add(message.id);
  });
  port.post({ type: 'ready' }, []);
}

/** The part of a worker's global object that is used here. */
interface Scope {
  postMessage(message: unknown, transfer: ArrayBuffer[]): void;
  addEventListener(type: 'message', listener: (event: MessageEvent) => void): void;
}

const scope = globalThis as unknown as Scope;
const port = builtin('node:worker_threads')?.parentPort;
serve({
  post: (message, transfer) => (port ?? scope).postMessage(message, transfer),
  listen(handler) {
    if (port) port.on('message', handler);
    else scope.addEventListener('message', ({ data }) => handler(data));
  },
});
