// Terrain, for the entry that has it.

import { codeEdit, moduleEdit } from '#assets';
import { thrown } from './errors.js';
import { optionsOf, taskOptions } from './options.js';
import { copyOf } from './points.js';
import type { Tasks } from './protocol.js';
import { loadCode } from './runtime.js';
import { runShared } from './shared.js';
import type { Points, TaskOptions } from './types.js';

/**
 * Makes terrain in a worker.
 *
 * @internal
 */
export async function runTin(
  points: Points,
  options: TaskOptions,
): Promise<Tasks['tin']['result']> {
  const given = optionsOf(options);
  const task = taskOptions(given);
  const copy = await copyOf(points, 3, task);
  const { tinArgs } = await loadCode(codeEdit);
  const args = thrown(() => tinArgs(copy, given as object));
  return runShared(moduleEdit, 'tin', args, task);
}

/** @internal */
export { write } from './tools.js';
