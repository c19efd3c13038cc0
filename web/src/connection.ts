// A place where tasks run, one at a time: a worker or the calling thread.

import { allInThisRealm } from './arrays.js';
import type { PlainError } from './errors.js';
import type { FromWorker, ModuleName, TaskName, Tasks } from './protocol.js';
import type { Loaded, WorkerThread } from './runtime.js';
import type { Stop } from './stop.js';
import type { Place } from './types.js';

/**
 * The time after which an aborted task that has not stopped by itself is stopped by ending its
 * thread.
 */
const GRACE_MILLISECONDS = 50;

export interface Connection extends Place {
  /** False when the thread has died or was ended. */
  readonly isAlive: boolean;
  /** Accepts a module for later tasks. */
  load(name: ModuleName, module: WebAssembly.Module): void;
  /** Rejects with a {@link PlainError}. */
  run<T extends TaskName>(
    module: ModuleName,
    task: T,
    args: Tasks[T]['args'],
    transfer: ArrayBuffer[],
    stop: Stop,
  ): Promise<Tasks[T]['result']>;
  /** Frees a mesh that stays on the device of the caller, if this is the thread that has it. */
  free?(name: ModuleName, key: number): void;
  close(): void;
}

type TaskCode = typeof import('./core.js');

/** Runs tasks in a worker. */
export function workerConnection({ value: thread, whyInlined }: Loaded<WorkerThread>): Connection {
  let next = 0;
  let isAlive = true;
  let pending:
    | { id: number; handle: (message: FromWorker) => void; fail: (error: PlainError) => void }
    | undefined;
  thread.keepAlive(false);
  const fail = (error: Error) => {
    isAlive = false;
    const message = `the worker failed: ${error.message}`;
    pending?.fail({ code: 'INTERNAL', message, fatal: true });
  };
  thread.onMessage((message) => {
    if (message.type !== 'ready' && message.id === pending?.id) pending.handle(message);
  });
  thread.onError(fail);

  return {
    thread: 'worker',
    whyThread: null,
    whyInlined,
    get isAlive() {
      return isAlive;
    },
    load: (name, module) => thread.post({ type: 'load', name, module }, []),
    close() {
      isAlive = false;
      thread.terminate();
      const message = 'the triangulator was disposed of';
      pending?.fail({ code: 'DISPOSED', message, fatal: false });
    },
    run(module, task, args, transfer, stop) {
      const id = next++;
      let timer: ReturnType<typeof setTimeout> | undefined;
      let isBlocking = false;
      return new Promise<any>((resolve, reject) => {
        if (!isAlive)
          return reject({ code: 'INTERNAL', message: 'the worker has died', fatal: true });
        // A worker receives messages only in its event loop, to which running WebAssembly does not
        // return. So a worker that cannot answer, or does not, is ended.
        const end = () => reject({ code: 'ABORTED', message: 'aborted', fatal: true });
        stop.onStop(() => {
          if (isBlocking) return end();
          thread.post({ type: 'abort', id }, []);
          timer = setTimeout(end, GRACE_MILLISECONDS);
        });
        pending = {
          id,
          fail: reject,
          handle(message) {
            if (message.type === 'progress') stop.report(message.progress);
            else if (message.type === 'done') resolve(allInThisRealm(message.result));
            else if (message.type === 'failed') reject(allInThisRealm(message.error));
            else if (message.type === 'blocking') {
              isBlocking = true;
              if (stop.isStopped) end();
            }
          },
        };
        thread.keepAlive(true);
        thread.post({ type: 'run', id, module, task, args, isWatched: stop.isWatched }, transfer);
      }).finally(() => {
        pending = undefined;
        clearTimeout(timer);
        thread.keepAlive(false);
      });
    },
  };
}

/**
 * Runs tasks in the calling thread. A run stops at its next progress report after an abort, which
 * can come from its own callback or, while the GPU works, from anywhere.
 */
export function callerConnection(
  { makeCore }: TaskCode,
  gpu: object | undefined,
  whyThread: string,
): Connection {
  const cores = new Map<ModuleName, ReturnType<typeof makeCore>>();
  return {
    thread: 'caller',
    whyThread,
    whyInlined: null,
    isAlive: true,
    load(name, module) {
      cores.set(name, makeCore(name, module, gpu));
    },
    run: (module, task, args, _transfer, stop) =>
      cores.get(module)!.run(task, args, {
        onProgress: (progress) => stop.report(progress),
        onBlocking() {},
        isAborted: () => stop.isStopped,
      }),
    free: (name, key) => cores.get(name)!.free(key),
    close() {
      for (const core of cores.values()) core.dispose();
    },
  };
}
