import { GdelError } from './errors.js';

/** Sees to it that a mesh has one update at a time: the next one goes on from its result. */
export class Updating {
  #isRunning = false;

  async run<R>(update: () => Promise<R>): Promise<R> {
    if (this.#isRunning)
      throw new GdelError('BAD_INPUT', 'the mesh is being updated: await that first');
    this.#isRunning = true;
    try {
      return await update();
    } finally {
      this.#isRunning = false;
    }
  }
}
