import { loadQhull } from 'qhull-wasm';
import wasm from 'qhull-wasm/dist/qhull.wasm?url';
import { orient3d } from 'robust-predicates';
import type { OtherResult } from './result';

// One run a worker: whoever wants to cancel it, ends the worker.
self.onmessage = async ({ data: points }: MessageEvent<Float64Array>) => {
  const qhull = await loadQhull({
    wasmBinary: new Uint8Array(await (await fetch(wasm)).arrayBuffer()),
  });
  const started = performance.now();
  const { facets } = qhull.delaunay(points, 3);
  const milliseconds = performance.now() - started;
  const flat = facets.reduce((sum, tetrahedron) => {
    const [a, b, c, d] = tetrahedron.map((v) => points.subarray(3 * v, 3 * v + 3));
    return (
      sum +
      (orient3d(a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2], d[0], d[1], d[2]) === 0
        ? 1
        : 0)
    );
  }, 0);
  self.postMessage({ milliseconds, simplices: facets.length, flat } satisfies OtherResult);
};
