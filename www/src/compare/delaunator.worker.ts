import Delaunator from 'delaunator';
import { orient2d } from 'robust-predicates';
import type { OtherResult } from './result';

// One run a worker: whoever wants to cancel it, ends the worker.
self.onmessage = ({ data: points }: MessageEvent<Float64Array>) => {
  const started = performance.now();
  const { triangles } = new Delaunator(points);
  const milliseconds = performance.now() - started;
  let flat = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [2 * triangles[t], 2 * triangles[t + 1], 2 * triangles[t + 2]];
    if (
      orient2d(points[a], points[a + 1], points[b], points[b + 1], points[c], points[c + 1]) === 0
    )
      flat++;
  }
  self.postMessage({ milliseconds, simplices: triangles.length / 3, flat } satisfies OtherResult);
};
