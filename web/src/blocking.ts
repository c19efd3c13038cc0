// Triangulations by the CPU backend in the calling thread, done when the function returns.

import { statsOfCpu } from './core.js';
import { toPlainError } from './errors.js';
import type { Instance } from './instance.js';

/**
 * Returns a function that calls another one with an instance, and completes the statistics of its result.
 * It throws a `PlainError`, and replaces an instance that broke.
 */
export function blockingInstance<Glue>(open: () => Instance<Glue>) {
  let instance: Instance<Glue> | undefined = open();
  return <M extends object>(triangulate: (glue: Glue) => M & { stats?: object }): M => {
    const started = performance.now();
    const { glue, memory } = (instance ??= open());
    try {
      const mesh = triangulate(glue);
      if (mesh.stats) mesh.stats = statsOfCpu(mesh.stats, started, memory);
      return mesh;
    } catch (thrown) {
      const error = toPlainError(thrown, memory.buffer.byteLength);
      if (error.fatal) instance = undefined;
      throw error;
    }
  };
}
