// Work in slices, between which the thread handles other events.

/**
 * How long a slice is. The step that goes beyond it can take several milliseconds, such as a
 * submission to a device, and the thread is not to be blocked for more than 8.
 */
const SLICE_MILLISECONDS = 2;

/** The bytes that are copied or written at a time. */
export const STEP_BYTES = 2 ** 20;

/** A slice of work, which begins when this is created. */
export class Slice {
  #since = performance.now();

  get isOver(): boolean {
    return performance.now() - this.#since > SLICE_MILLISECONDS;
  }

  /** Handles waiting events, and begins the next slice: sooner than a timer, which browsers delay. */
  async next(): Promise<void> {
    await new Promise<void>((resolve) => {
      if (typeof MessageChannel !== 'function') return setTimeout(resolve);
      const { port1, port2 } = new MessageChannel();
      port1.onmessage = () => {
        port1.close();
        resolve();
      };
      port2.postMessage(null);
    });
    this.#since = performance.now();
  }
}

/** Copies as many bytes as `to` has room for. */
export async function copyInSlices(from: ArrayBuffer, to: Uint8Array): Promise<void> {
  const slice = new Slice();
  for (let at = 0; at < to.length; at += STEP_BYTES) {
    if (slice.isOver) await slice.next();
    to.set(new Uint8Array(from, at, Math.min(STEP_BYTES, to.length - at)), at);
  }
}
