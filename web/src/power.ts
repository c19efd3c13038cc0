// Cells of power diagrams in the plane, for the entries that are made of them.

import { codeTransport, moduleTransport, wasmTransport } from '#assets';
import type { createBlocking } from './core-transport.js';
import { thrown } from './errors.js';
import type { PowerTask, Tasks } from './protocol.js';
import { runShared } from './shared.js';
import { type Blocking, blocking, type Loadable, load, loaded } from './sync.js';
import type { TaskOptions } from './types.js';

const loadablePower: Loadable<Blocking<ReturnType<typeof createBlocking>>> = {
  start: () => blocking(wasmTransport, codeTransport),
};

/**
 * Loads what {@link powerNow} needs. Later calls do nothing.
 *
 * @internal
 */
export function loadPower(): Promise<void> {
  return load(loadablePower);
}

/**
 * Does a task with cells in the plane in the calling thread.
 *
 * @internal
 */
export function powerNow<T extends PowerTask>(task: T, args: Tasks[T]['args']): Tasks[T]['result'] {
  const { triangulate } = loaded(loadablePower, 'load');
  return thrown(() => triangulate(task, args));
}

/**
 * Does the same in a worker.
 *
 * @internal
 */
export function runPower<T extends PowerTask>(
  task: T,
  args: Tasks[T]['args'],
  options: TaskOptions,
): Promise<Tasks[T]['result']> {
  return runShared(moduleTransport, task, args, options);
}
