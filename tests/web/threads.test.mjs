// Several workers make the mesh of one.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { dist, project } from './package.mjs';

const url = pathToFileURL(join(dist(project()), 'index.js'));
const { createTriangulator, delaunay2d, delaunay3d, generate, generate2d, verify, verify2d } =
  await import(url);

/** The simplices in a form that is equal for equal meshes. */
function canonical(simplices, corners) {
  const all = [];
  for (let i = 0; i < simplices.length; i += corners)
    all.push([...simplices.subarray(i, i + corners)].sort((a, b) => a - b).join(' '));
  return all.sort();
}

const OUTSIDE = (entries) => entries.filter((entry) => entry === -1).length;

for (const distribution of ['uniform', 'sphere', 'grid'])
  test(`3D, ${distribution}`, async () => {
    const points = await generate(distribution, 3000, { seed: 1 });
    const one = await delaunay3d(points, { backend: 'cpu', threads: 1 });
    assert.equal(one.stats.threads, 1);
    for (const threads of [2, 3]) {
      const mesh = await delaunay3d(points, { backend: 'cpu', threads });
      assert.equal(mesh.stats.threads, threads);
      assert.equal(mesh.stats.fallback, null);
      assert.equal(mesh.stats.thread, 'worker');
      assert.deepEqual(canonical(mesh.tetrahedra, 4), canonical(one.tetrahedra, 4));
      assert.deepEqual(canonical(mesh.hull, 3), canonical(one.hull, 3));
      assert.equal(OUTSIDE(mesh.neighbors), OUTSIDE(one.neighbors));
      assert.deepEqual(mesh.duplicateOf, one.duplicateOf);
      assert.equal(mesh.dimension, 3);
      assert.ok((await verify(mesh.points, mesh)).passed);
    }
  });

for (const distribution of ['uniform', 'grid', 'two-lines'])
  test(`2D, ${distribution}`, async () => {
    const points = await generate2d(distribution, 4000, { seed: 1 });
    const one = await delaunay2d(points, { backend: 'cpu', threads: 1 });
    const mesh = await delaunay2d(points, { backend: 'cpu', threads: 2 });
    assert.deepEqual(canonical(mesh.triangles, 3), canonical(one.triangles, 3));
    assert.deepEqual(mesh.hull, one.hull);
    assert.deepEqual(mesh.duplicateOf, one.duplicateOf);
    assert.ok((await verify2d(mesh.coords, mesh)).passed);
    assert.equal(mesh.stats.threads, 2);
  });

test('what depends on most points everywhere is left to one worker', async () => {
  const points = await generate('sphere', 20_000, { seed: 1 });
  const mesh = await delaunay3d(points, { backend: 'cpu', threads: 8 });
  assert.equal(mesh.stats.threads, 1);
  const one = await delaunay3d(points, { backend: 'cpu', threads: 1 });
  assert.deepEqual(mesh.tetrahedra, one.tetrahedra);
});

test('points in a plane, few and none are left to one worker', async () => {
  const plane = await generate2d('uniform', 500, { seed: 1 });
  const flat = Array.from({ length: 500 }, (_, i) => [plane[2 * i], plane[2 * i + 1], 1]).flat();
  const mesh = await delaunay3d(new Float64Array(flat), { backend: 'cpu', threads: 3 });
  assert.deepEqual([mesh.dimension, mesh.tetrahedra.length, mesh.stats.threads], [2, 0, 1]);
  const none = await delaunay3d([], { backend: 'cpu', threads: 3 });
  assert.deepEqual([none.dimension, none.stats.threads], [0, 1]);
});

test('without a GPU, auto takes several workers and says why it took the CPU', async () => {
  const points = await generate('uniform', 100_000, { seed: 1 });
  const mesh = await delaunay3d(points, { threads: 2, outputs: ['neighbors'] });
  assert.equal(mesh.stats.threads, 2);
  assert.match(mesh.stats.fallback, /WebGPU is not available here/);
  assert.equal(mesh.neighbors.length, mesh.tetrahedra.length);
  assert.equal(mesh.hull.length, 0);
  assert.equal(mesh.duplicateOf.length, 0);
});

test('reports progress that grows to 1', async () => {
  const points = await generate('uniform', 30_000, { seed: 1 });
  const fractions = [];
  const onProgress = ({ fraction }) => fractions.push(fraction);
  await delaunay3d(points, { backend: 'cpu', threads: 2, onProgress });
  assert.equal(fractions.at(-1), 1);
  assert.deepEqual(
    fractions,
    fractions.toSorted((a, b) => a - b),
  );
});

test('can be aborted, and goes on', async () => {
  const points = await generate('uniform', 200_000, { seed: 1 });
  const controller = new AbortController();
  const reason = new Error('enough');
  const run = delaunay3d(points, {
    backend: 'cpu',
    threads: 2,
    signal: controller.signal,
    onProgress: () => controller.abort(reason),
  });
  await assert.rejects(run, reason);
  const failing = delaunay3d(points, {
    backend: 'cpu',
    threads: 2,
    onProgress() {
      throw reason;
    },
  });
  await assert.rejects(failing, reason);
  const mesh = await delaunay3d(points.subarray(0, 3000), { backend: 'cpu', threads: 2 });
  assert.equal(mesh.stats.threads, 2);
});

test('errors name the point, and give the points back', async () => {
  const points = await generate('uniform', 1000, { seed: 1 });
  points[300] = Number.NaN;
  const copy = points.slice();
  const options = { backend: 'cpu', threads: 2, transfer: true };
  await assert.rejects(delaunay3d(copy, options), (error) => {
    assert.deepEqual([error.code, error.index], ['NOT_FINITE', 100]);
    assert.deepEqual(error.points, points);
    return true;
  });
  for (const threads of [0, 1.5, 65, '2'])
    await assert.rejects(delaunay3d([], { threads }), { code: 'BAD_INPUT' });
});

test('a triangulator that is disposed of ends the workers', async () => {
  const triangulator = await createTriangulator({ backend: 'cpu' });
  const points = await generate('uniform', 100_000, { seed: 1 });
  const run = triangulator.delaunay3d(points, {
    threads: 2,
    onProgress: () => triangulator.dispose(),
  });
  await assert.rejects(run, { code: 'DISPOSED' });
});
