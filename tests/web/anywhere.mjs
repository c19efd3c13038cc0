// What every browser has to get right: the meshes that tests/data/fingerprints.txt pins, by the CPU, and by the GPU
// where there is one. Runs in a page.

import { fingerprint } from './fingerprints.mjs';

/** The largest of the meshes for a GPU that is software, which takes its time. */
const MOST_IN_SOFTWARE = 100;

/** Returns what the browser has, and the meshes that are wrong. */
export async function check(pinned) {
  const { createTriangulator, delaunay3d, generate } = await import('/gdel/index.js');
  const wrong = [];
  const compare = async (backend, { kind, count, seed, fingerprint: expected }, triangulate) => {
    const points = await generate(kind, count, { seed });
    const { tetrahedra, stats } = await triangulate(points, { backend });
    const isRight = fingerprint(tetrahedra) === expected;
    if (!isRight || stats.backend !== backend || stats.thread !== 'worker')
      wrong.push({ backend, kind, count, isRight, fallback: stats.fallback, by: stats.backend });
  };
  for (const mesh of pinned) await compare('cpu', mesh, delaunay3d);
  let triangulator;
  try {
    // Hardware has to pass its self-test first.
    triangulator = await createTriangulator({ backend: 'gpu' });
  } catch ({ code, message }) {
    return { wrong, adapter: null, code, message };
  }
  const { adapter } = triangulator.info;
  for (const mesh of pinned) {
    if (!adapter.software || mesh.count < MOST_IN_SOFTWARE)
      await compare('gpu', mesh, (...args) => triangulator.delaunay3d(...args));
  }
  triangulator.dispose();
  return { wrong, adapter };
}
