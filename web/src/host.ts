// Where tasks run: one worker, made when it is needed, or the calling thread. One task at a time; others wait.

import { runtime } from '#runtime';
import { GdelError, type PlainError, toGdelError } from './errors.js';
import {
  type FromWorker,
  MODULE_OF,
  type ModuleName,
  type TaskName,
  type Tasks,
} from './protocol.js';
import type { WorkerThread } from './runtime.js';
import type { Progress, TaskOptions } from './types.js';

/** An aborted task that does not stop by itself within this time is stopped by ending its thread. */
const GRACE_MILLISECONDS = 50;

/** How to run one task. */
interface Connection {
  thread: 'worker' | 'caller';
  whyThread: string | null;
  /** Takes a module for later tasks. */
  load(name: ModuleName, module: WebAssembly.Module): void;
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
export function compiled(name: ModuleName): Promise<WebAssembly.Module> {
  let module = modules.get(name);
  if (!module) {
    module = runtime.compile(name).catch((cause: unknown) => {
      modules.delete(name);
      const why = cause instanceof Error ? cause.message : String(cause);
      throw new GdelError('LOAD_FAILED', `the WebAssembly module cannot be loaded: ${why}`, {
        cause,
      });
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
  readonly #options: HostOptions;
  #connection: Promise<Connection> | undefined;
  /** The modules that each connection has. */
  readonly #loaded = new WeakMap<Connection, Set<ModuleName>>();
  /** Why workers are of no use here; found out once. */
  #noWorker: string | null = null;
  #last: Promise<unknown> = Promise.resolve();
  #disposed = false;

  constructor(options: HostOptions = {}) {
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
      await this.#load(connection, MODULE_OF[task]);
      throwIfAborted(signal);
      // After an abort, what still arrives is no longer of interest.
      const report = (progress: Progress) => signal?.aborted || onProgress?.(progress);
      try {
        const { thread, whyThread } = connection;
        return Object.assign(await connection.run(task, args, transfer, report, signal), {
          thread,
          whyThread,
        });
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
    void this.#connection?.then(
      (connection) => connection.close(),
      () => {},
    );
    this.#connection = undefined;
  }

  #drop(connection: Connection): void {
    connection.close();
    this.#connection = undefined;
  }

  /** Gives the connection a module that it does not have. */
  async #load(connection: Connection, name: ModuleName): Promise<void> {
    const loaded = this.#loaded.get(connection) ?? new Set();
    this.#loaded.set(connection, loaded);
    if (loaded.has(name)) return;
    connection.load(name, await compiled(name));
    loaded.add(name);
  }

  #connect(): Promise<Connection> {
    this.#connection ??= this.#open().catch((error: unknown) => {
      this.#connection = undefined;
      throw error;
    });
    return this.#connection;
  }

  async #open(): Promise<Connection> {
    if (this.#noWorker === null) {
      const reasons: string[] = [];
      for (const start of runtime.workers) {
        try {
          return workerConnection(await start(), () => (this.#connection = undefined));
        } catch (error) {
          reasons.push(error instanceof Error ? error.message : String(error));
        }
      }
      this.#noWorker = [...new Set(reasons)].join('; ');
    }
    return callerConnection(this.#options.gpu, this.#noWorker);
  }
}

function workerConnection(thread: WorkerThread, onDeath: () => void): Connection {
  let next = 0;
  let pending:
    | { id: number; handle: (message: FromWorker) => void; fail: (error: PlainError) => void }
    | undefined;
  thread.keepAlive(false);
  thread.onMessage((message) => {
    if (message.type !== 'ready' && message.id === pending?.id) pending.handle(message);
  });
  thread.onError((error) => {
    onDeath();
    pending?.fail({
      code: 'INTERNAL',
      message: `the worker failed: ${error.message}`,
      fatal: true,
    });
  });

  return {
    thread: 'worker',
    whyThread: null,
    load: (name, module) => thread.post({ type: 'load', name, module }, []),
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
async function callerConnection(gpu: object | undefined, whyThread: string): Promise<Connection> {
  const { makeCore } = await runtime.code();
  const cores = new Map<ModuleName, ReturnType<typeof makeCore>>();
  return {
    thread: 'caller',
    whyThread,
    load(name, module) {
      cores.set(name, makeCore(name, module, gpu));
    },
    run: (task, args, _transfer, onProgress, signal) =>
      cores
        .get(MODULE_OF[task])!
        .run(task, args, { onProgress, isAborted: () => signal?.aborted ?? false }),
    close() {
      for (const core of cores.values()) core.dispose();
    },
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
