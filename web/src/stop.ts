// What ends a run early.

import { GdelError } from './errors.js';
import type { Progress, TaskOptions } from './types.js';

/** Ends a run when its signal is aborted or its `onProgress` fails. */
export class Stop {
  readonly #options: TaskOptions;
  #error: { reason: unknown } | undefined;
  #isOver = false;
  #onStop: ((reason: unknown) => void)[] = [];

  constructor(options: TaskOptions) {
    this.#options = options;
    options.signal?.addEventListener('abort', this.#abort);
    if (options.signal?.aborted) this.#abort();
  }

  readonly #abort = () => this.#stop(abortReason(this.#options.signal!));

  #stop(reason: unknown): void {
    if (this.#error) return;
    this.#error = { reason };
    for (const handler of this.#onStop.splice(0)) handler(reason);
  }

  get isStopped(): boolean {
    return this.#error !== undefined;
  }

  /** Whether the caller has a signal. */
  get canBeAborted(): boolean {
    return this.#options.signal !== undefined;
  }

  throwIfStopped(): void {
    if (this.#error) throw this.#error.reason;
  }

  /** Whether somebody wants to hear of the run before it ends. */
  get isWatched(): boolean {
    return this.canBeAborted || this.#options.onProgress !== undefined;
  }

  /** Calls a handler when the run is to end: at once if it already is. */
  onStop(handler: (reason: unknown) => void): void {
    if (this.#error) handler(this.#error.reason);
    else this.#onStop.push(handler);
  }

  /** Reports progress to the caller. After the end, what still arrives is no longer of interest. */
  report(progress: Progress): void {
    if (this.#error) return;
    try {
      const result: unknown = this.#options.onProgress?.(progress);
      // An async function, although it is not asked for.
      if (typeof result === 'object' && result !== null && 'then' in result)
        void Promise.resolve(result).catch((error: unknown) => {
          // Nobody waits for the run any more, so the error is unhandled, as it would be elsewhere.
          if (this.#isOver) throw error;
          this.#stop(error);
        });
    } catch (error) {
      this.#stop(error);
    }
  }

  /** Has to be called when the run has ended. */
  release(): void {
    this.#isOver = true;
    this.#onStop = [];
    this.#options.signal?.removeEventListener('abort', this.#abort);
  }
}

/** Returns the signal's reason, or a {@link GdelError} in place of the usual `AbortError`. */
function abortReason({ reason }: AbortSignal): unknown {
  const isUsual =
    reason === undefined ||
    (typeof reason === 'object' && reason !== null && reason.name === 'AbortError');
  return isUsual ? new GdelError('ABORTED', 'the run was aborted', { cause: reason }) : reason;
}

export function throwIfAborted(signal: AbortSignal | undefined): void {
  if (signal?.aborted) throw abortReason(signal);
}
