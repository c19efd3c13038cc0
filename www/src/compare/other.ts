import { startWorker } from '../model/client';
import delaunator from './delaunator.worker?worker&url';
import qhull from './qhull.worker?worker&url';
import type { OtherResult } from './result';

const WORKERS = {
  'qhull-wasm': qhull,
  delaunator,
};

/** Runs a library on points in a worker of its own. Aborting ends the worker. */
export function runOther(
  library: keyof typeof WORKERS,
  points: Float32Array | Float64Array,
  signal: AbortSignal,
): Promise<OtherResult> {
  const worker = startWorker(new URL(WORKERS[library], import.meta.url));
  const result = new Promise<OtherResult>((resolve, reject) => {
    worker.onmessage = ({ data }) => resolve(data);
    worker.onerror = (event) => reject(new Error(event.message || `${library} could not be run.`));
    signal.addEventListener('abort', () => reject(signal.reason));
  });
  const doubles = Float64Array.from(points);
  worker.postMessage(doubles, [doubles.buffer]);
  return result.finally(() => worker.terminate());
}
