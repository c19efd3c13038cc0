import type { QhullResult } from './qhull.worker';

/** Runs qhull-wasm on points in a worker of its own. Aborting ends the worker. */
export function runQhull(points: Float32Array | Float64Array, signal: AbortSignal): Promise<QhullResult> {
  const worker = new Worker(new URL('./qhull.worker.ts', import.meta.url), { type: 'module' });
  const result = new Promise<QhullResult>((resolve, reject) => {
    worker.onmessage = ({ data }) => resolve(data);
    worker.onerror = (event) => reject(new Error(event.message || 'qhull-wasm could not be run.'));
    signal.addEventListener('abort', () => reject(signal.reason));
  });
  const doubles = Float64Array.from(points);
  worker.postMessage(doubles, [doubles.buffer]);
  return result.finally(() => worker.terminate());
}
