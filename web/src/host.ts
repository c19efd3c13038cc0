// Where tasks run: one worker, made when it is needed, or the calling thread. One task at a time; others wait.

import { GdelError, toGdelError, type PlainError } from './errors.js';
import type { FromWorker, ModuleName, TaskName, Tasks } from './protocol.js';
import { runtime } from '#runtime';
import type { WorkerThread } from './runtime.js';
import type { Progress, TaskOptions } from './types.js';

/** An aborted task that does not stop by itself within this time is stopped by ending its thread. */
const GRACE_MILLISECONDS = 50;

/** How to run one task. */
interface Connection {
  thread: 'worker' | 'caller';
  whyThread: string | null;
  /** Rejects with a {@link PlainError}. */
  run<T extends TaskName>(
    task: T,
    args: Tasks[T]['args'],
    transfer: ArrayBuffer[],
    onProgress: (progress: Progress) => void,
    signal: AbortSignal | undefined,
  ): Promise<Tasks[T]['result']>;
  close(): void;
}

const modules = new Map<ModuleName, Promise<WebAssembly.Module>>();

/** Compiled once, for all workers. */
function compiled(name: ModuleName): Promise<WebAssembly.Module> {
  let module = modules.get(name);
  if (!module) {
    module = runtime.compile(name).catch((cause: unknown) => {
      modules.delete(name);
      const why = cause instanceof Error ? cause.message : String(cause);
      throw new GdelError('LOAD_FAILED', `the WebAssembly module cannot be loaded: ${why}`, { cause });
    });
    modules.set(name, module);
  }
  return module;
}

export interface HostOptions {
  gpu?: object | undefined;
  worker?: boolean | undefined;
}

export class Host {
  readonly #name: ModuleName;
  readonly #options: HostOptions;
  #connection: Promise<Connection> | undefined;
  /** Why workers are of no use here; found out once. */
  #noWorker: string | null = null;
  #last: Promise<unknown> = Promise.resolve();
  #disposed = false;

  constructor(name: ModuleName, options: HostOptions = {}) {
    this.#name = name;
    this.#options = options;
    if (options.gpu) this.#noWorker = 'a GPU object cannot be sent to another thread';
    else if (options.worker === false) this.#noWorker = 'the caller asked for no worker';
  }

  /** Runs a task after all earlier ones. */
  async run<T extends TaskName>(
    task: T,
    args: Tasks[T]['args'],
    transfer: ArrayBuffer[],
    { signal, onProgress }: TaskOptions,
  ): Promise<Tasks[T]['result'] & Pick<Connection, 'thread' | 'whyThread'>> {
    throwIfAborted(signal);
    const work = this.#last.then(async () => {
      throwIfAborted(signal);
      if (this.#disposed) throw new GdelError('DISPOSED', 'the engine was disposed of');
      const connection = await this.#connect();
      throwIfAborted(signal);
      // After an abort, what still arrives is no longer of interest.
      const report = (progress: Progress) => signal?.aborted || onProgress?.(progress);
      try {
        const { thread, whyThread } = connection;
        return Object.assign(await connection.run(task, args, transfer, report, signal), { thread, whyThread });
      } catch (thrown) {
        const error = thrown as PlainError;
        if (error.fatal) this.#drop(connection);
        throw error.code === 'ABORTED' && signal ? abortReason(signal) : toGdelError(error);
      }
    });
    this.#last = work.catch(() => {});
    return untilAborted(work, signal);
  }

  dispose(): void {
    this.#disposed = true;
    void this.#connection?.then((connection) => connection.close(), () => {});
    this.#connection = undefined;
  }

  #drop(connection: Connection): void {
    connection.close();
    this.#connection = undefined;
  }

  #connect(): Promise<Connection> {
    this.#connection ??= this.#open().catch((error: unknown) => {
      this.#connection = undefined;
      throw error;
    });
    return this.#connection;
  }

  async #open(): Promise<Connection> {
    const module = await compiled(this.#name);
    if (this.#noWorker === null) {
      const reasons: string[] = [];
      for (const start of runtime.workers) {
        try {
          const thread = await ready(await start());
          thread.post({ type: 'start', name: this.#name, module }, []);
          return workerConnection(thread, () => (this.#connection = undefined));
        } catch (error) {
          reasons.push(error instanceof Error ? error.message : String(error));
        }
      }
      this.#noWorker = [...new Set(reasons)].join('; ');
    }
    return callerConnection(this.#name, module, this.#options.gpu, this.#noWorker);
  }
}

/** A worker that has loaded its code. */
function ready(thread: WorkerThread): Promise<WorkerThread> {
  return new Promise((resolve, reject) => {
    thread.onMessage((message) => message.type === 'ready' && resolve(thread));
    thread.onError((error) => {
      thread.terminate();
      reject(error);
    });
  });
}

function workerConnection(thread: WorkerThread, onDeath: () => void): Connection {
  let next = 0;
  let pending: { id: number; handle: (message: FromWorker) => void; fail: (error: PlainError) => void } | undefined;
  thread.keepAlive(false);
  thread.onMessage((message) => {
    if (message.type !== 'ready' && message.id === pending?.id) pending.handle(message);
  });
  thread.onError((error) => {
    onDeath();
    pending?.fail({ code: 'INTERNAL', message: `the worker failed: ${error.message}`, fatal: true });
  });

  return {
    thread: 'worker',
    whyThread: null,
    close() {
      thread.terminate();
      pending?.fail({ code: 'DISPOSED', message: 'the engine was disposed of', fatal: false });
    },
    run(task, args, transfer, onProgress, signal) {
      const id = next++;
      let timer: ReturnType<typeof setTimeout> | undefined;
      // Messages reach a worker only between its tasks' turns, and wasm that runs has none. So what does not answer is
      // ended; the next run starts a new worker.
      const abort = () => {
        thread.post({ type: 'abort', id }, []);
        timer = setTimeout(
          () => pending?.fail({ code: 'ABORTED', message: 'aborted', fatal: true }),
          GRACE_MILLISECONDS,
        );
      };
      return new Promise<any>((resolve, reject) => {
        pending = {
          id,
          fail: reject,
          handle(message) {
            if (message.type === 'progress') onProgress(message.progress);
            else if (message.type === 'done') resolve(message.result);
            else if (message.type === 'failed') reject(message.error);
          },
        };
        thread.keepAlive(true);
        thread.post({ type: 'run', id, task, args }, transfer);
        signal?.addEventListener('abort', abort);
      }).finally(() => {
        pending = undefined;
        clearTimeout(timer);
        signal?.removeEventListener('abort', abort);
        thread.keepAlive(false);
      });
    },
  };
}

/** In the calling thread. A run stops at its next report when the signal is aborted, which a callback of its own can do,
 * or anything while the GPU is at work. */
async function callerConnection(
  name: ModuleName,
  module: WebAssembly.Module,
  gpu: object | undefined,
  whyThread: string,
): Promise<Connection> {
  const { makeCore } = await runtime.code();
  const core = makeCore(name, module, gpu);
  return {
    thread: 'caller',
    whyThread,
    run: (task, args, _transfer, onProgress, signal) =>
      core.run(task, args, { onProgress, isAborted: () => signal?.aborted ?? false }),
    close: () => core.dispose(),
  };
}

/** The signal's reason; in place of the usual `AbortError`, an error of this package's type. */
function abortReason(signal: AbortSignal): unknown {
  const reason: unknown = signal.reason;
  const isUsual = reason === undefined || (reason instanceof Error && reason.name === 'AbortError');
  return isUsual ? new GdelError('ABORTED', 'the run was aborted', { cause: reason }) : reason;
}

export function throwIfAborted(signal: AbortSignal | undefined): void {
  if (signal?.aborted) throw abortReason(signal);
}

/** The result, unless the signal is aborted before. */
function untilAborted<R>(work: Promise<R>, signal: AbortSignal | undefined): Promise<R> {
  if (!signal) return work;
  return new Promise((resolve, reject) => {
    const abort = () => reject(abortReason(signal));
    signal.addEventListener('abort', abort);
    work.then(resolve, reject).finally(() => signal.removeEventListener('abort', abort));
  });
}
