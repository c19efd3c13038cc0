// A place where the tasks of a module run, one at a time: a worker or the calling thread.

import { allInThisRealm } from './arrays.js';
import type { Core } from './core.js';
import type { PlainError } from './errors.js';
import type { FromWorker, TaskName, Tasks } from './protocol.js';
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
  /** Rejects with a {@link PlainError}. */
  run<T extends TaskName>(
    task: T,
    args: Tasks[T]['args'],
    transfer: ArrayBuffer[],
    stop: Stop,
  ): Promise<Tasks[T]['result']>;
  /** Frees a mesh that stays on the device of the caller, if this is the thread that has it. */
  free?(key: number): void;
  close(): void;
}

/** Runs tasks in a worker. */
export function workerConnection(
  { value: thread, whyInlined }: Loaded<WorkerThread>,
  module: Loaded<WebAssembly.Module>,
  selfTest?: boolean,
): Connection {
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
  thread.post({ type: 'load', module: module.value, selfTest }, []);

  return {
    thread: 'worker',
    whyThread: null,
    whyInlined: module.whyInlined ?? whyInlined,
    get isAlive() {
      return isAlive;
    },
    close() {
      isAlive = false;
      thread.terminate();
      const message = 'the triangulator was disposed of';
      pending?.fail({ code: 'DISPOSED', message, fatal: false });
    },
    run(task, args, transfer, stop) {
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
        thread.post({ type: 'run', id, task, args, isWatched: stop.isWatched }, transfer);
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
  core: Core,
  { whyThread, whyInlined }: Pick<Place, 'whyThread' | 'whyInlined'>,
): Connection {
  return {
    thread: 'caller',
    whyThread,
    whyInlined,
    isAlive: true,
    run: (task, args, _transfer, stop) =>
      core.run(task, args, {
        onProgress: (progress) => stop.report(progress),
        onBlocking() {},
        isAborted: () => stop.isStopped,
      }),
    free: (key) => core.free(key),
    close: () => core.dispose(),
  };
}
