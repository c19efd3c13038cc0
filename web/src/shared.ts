// What all tasks on finished meshes share: a worker of their own, so that they do not wait for
// triangulations.

import { Host } from './host.js';
import type { TaskName, Tasks } from './protocol.js';
import type { ModuleAsset } from './runtime.js';
import { throwIfAborted } from './stop.js';
import type { TaskOptions } from './types.js';

let shared: Host | undefined;

/** Runs a task of a module with options that are checked. */
export async function runShared<T extends TaskName>(
  asset: ModuleAsset,
  task: T,
  args: Tasks[T]['args'],
  options: TaskOptions,
  transfer: ArrayBuffer[] = [],
): Promise<Tasks[T]['result']> {
  throwIfAborted(options.signal);
  shared ??= new Host();
  return (await shared.run(asset, task, args, { transfer }, options)).result;
}
