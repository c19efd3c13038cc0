// What runs the tasks of a module: in a worker or in the calling thread.

import type { Device } from './device.js';
import { toPlainError } from './errors.js';
import type { Control, Helper, TaskName, Tasks } from './protocol.js';

/** The shortest time between two progress reports, since each is a message to the page. */
const PROGRESS_MILLISECONDS = 20;

export type Handlers = {
  [T in TaskName]?: (
    args: Tasks[T]['args'],
    control: Control,
    helper?: Helper,
  ) => Promise<Tasks[T]['result']>;
};

/** The tasks of an instance. */
export interface ModuleTasks {
  handlers: Handlers;
  memory: WebAssembly.Memory;
  dispose?(): void;
  free?(key: number): void;
}

/** The device that an instance uses. */
export interface Uses {
  /** The GPU object in which wgpu looks for it. */
  gpu?: object | undefined;
  /**
   * The caller's device, while a worker has the points: the instance only drives it, and a helper has to
   * compute.
   */
  device?: Device | undefined;
  /** Whether the device is tested before it is used, if the caller says so. */
  selfTest?: boolean | undefined;
}

/** One WebAssembly instance and its tasks. */
export interface Core {
  /** Rejects with a `PlainError`. */
  run<T extends TaskName>(
    task: T,
    args: Tasks[T]['args'],
    control: Control,
    helper?: Helper,
  ): Promise<Tasks[T]['result']>;
  dispose(): void;
  /** Frees a mesh that stays on the caller's device. */
  free(key: number): void;
}

/** Creates the core of a module. */
export type OpenCore = (module: WebAssembly.Module, uses?: Uses) => Core;

export function coreOf({ handlers, memory, dispose, free }: ModuleTasks): Core {
  return {
    async run(task, args, control, helper) {
      try {
        const handler = handlers[task];
        if (!handler) throw new TypeError(`the module has no task ${task}`);
        return await handler(args, throttled(control), helper);
      } catch (thrown) {
        const error = toPlainError(thrown, memory.buffer.byteLength);
        // They go back, since the caller may have given them away.
        throw 'points' in args ? { points: args.points, ...error } : error;
      }
    },
    dispose: () => dispose?.(),
    free: (key) => free?.(key),
  };
}

function throttled(control: Control): Control {
  let last = -Infinity;
  return {
    ...control,
    onProgress(progress) {
      const now = performance.now();
      if (now - last < PROGRESS_MILLISECONDS && progress.fraction < 1) return;
      last = now;
      control.onProgress(progress);
    },
  };
}

/** Reports progress. Returns whether the run is to stop. */
export type ReportProgress = (phase: string, fraction: number) => boolean;

/** Returns the function that WebAssembly calls with its progress. */
export const reporting =
  (control: Control): ReportProgress =>
  (phase, fraction) => {
    control.onProgress({ phase, fraction });
    return control.isAborted();
  };

/** Returns the statistics of the CPU with what is only known in JavaScript. */
export const statsOfCpu = <S extends object>(
  stats: S,
  started: number,
  memory: WebAssembly.Memory,
) => ({
  ...stats,
  threads: 1,
  adapter: null,
  milliseconds: performance.now() - started,
  wasmBytes: memory.buffer.byteLength,
  readyBytes: 0,
});
