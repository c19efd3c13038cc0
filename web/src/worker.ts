// The worker: one task at a time, each in the core of its wasm module. Also loaded by the page itself where it may have no worker.

import { buffersOf, type Core, makeCore } from './core.js';
import type { PlainError } from './errors.js';
import {
  type FromWorker,
  MODULE_OF,
  type ModuleName,
  type TaskName,
  type Tasks,
  type ToWorker,
} from './protocol.js';

export { makeCore, makeTriangulator } from './core.js';

/** The port to whoever made this worker. */
export interface Port {
  post(message: FromWorker, transfer: ArrayBuffer[]): void;
  listen(handler: (message: ToWorker) => void): void;
}

/** Serves the tasks that come through `port`. */
export function serve(port: Port): void {
  const cores = new Map<ModuleName, Core>();
  const aborted = new Set<number>();

  async function run(id: number, task: TaskName, args: Tasks[TaskName]['args']) {
    try {
      const core = cores.get(MODULE_OF[task]);
      if (!core)
        throw {
          code: 'INTERNAL',
          message: `no module for ${task} was loaded`,
          fatal: true,
        } satisfies PlainError;
      const result = await core.run(task, args, {
        onProgress: (progress) => port.post({ type: 'progress', id, progress }, []),
        isAborted: () => aborted.has(id),
      });
      port.post({ type: 'done', id, result }, buffersOf(result));
    } catch (thrown) {
      port.post({ type: 'failed', id, error: thrown as PlainError }, []);
    } finally {
      aborted.delete(id);
    }
  }

  port.listen((message) => {
    if (message.type === 'load') {
      cores.set(message.name, makeCore(message.name, message.module));
    } else if (message.type === 'run') {
      void run(message.id, message.task, message.args);
    } else {
      aborted.add(message.id);
    }
  });
  port.post({ type: 'ready' }, []);
}

/** The name of our workers: a page's own worker may load this file too, and its messages are not for us. */
const WORKER_NAME = 'gdel-wasm';

declare const DedicatedWorkerGlobalScope: { new (): Worker & { name: string } } | undefined;

if (typeof DedicatedWorkerGlobalScope !== 'undefined') {
  const scope: unknown = globalThis;
  if (scope instanceof DedicatedWorkerGlobalScope && scope.name === WORKER_NAME) {
    serve({
      post: (message, transfer) => scope.postMessage(message, transfer),
      listen: (handler) => scope.addEventListener('message', (event) => handler(event.data)),
    });
  }
}
