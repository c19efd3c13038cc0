// With the caller's device, the calling thread drives it while a worker has the points: in Node by the npm
// package `webgpu` (Dawn) on Chromium's software driver.

import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { test } from 'node:test';
import { setFlagsFromString } from 'node:v8';
import { runInNewContext } from 'node:vm';
import { fingerprint } from './fingerprints.mjs';
import { canonical } from './moving.mjs';
import { importFrom, project } from './package.mjs';

const swiftshader = '/usr/lib/chromium/vk_swiftshader_icd.json';
if (!process.env.VK_DRIVER_FILES && existsSync(swiftshader))
  process.env.VK_DRIVER_FILES = swiftshader;
const { create } = await import('webgpu');
/** Kept, since Dawn's devices do not outlive their instance. */
const gpu = create([]);

const gdel = await importFrom(project());
const { createTriangulator, delaunay2d, delaunay3d, generate, generate2d } = gdel;

async function openDevice() {
  const adapter = await gpu.requestAdapter();
  const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
  return adapter.requestDevice({ requiredLimits: { maxBufferSize, maxStorageBufferBindingSize } });
}

test('with the caller’s device, a worker splays', {
  timeout: 600_000,
}, async () => {
  const device = await openDevice();
  const errors = [];
  device.addEventListener('uncapturederror', ({ error }) => errors.push(error.message));
  const triangulator = await createTriangulator({ device, backend: 'gpu' });
  const { thread, whyThread } = triangulator.info;
  assert.deepEqual([thread, whyThread], ['worker', null]);

  // Of these, Phase 1 leaves much to splaying.
  const sphere = await generate('sphere', 5000, { seed: 5 });
  sphere.copyWithin(3 * 4999, 0, 3);
  const expected = await delaunay3d(sphere, { backend: 'cpu' });
  const mesh = await triangulator.delaunay3d(sphere);
  assert.equal(fingerprint(mesh.tetrahedra), fingerprint(expected.tetrahedra));
  assert.deepEqual(mesh.duplicateOf, expected.duplicateOf);
  const { backend, fallback, splay } = mesh.stats;
  assert.deepEqual([backend, fallback, mesh.stats.thread], ['gpu', null, 'worker']);
  assert.ok(splay.built > 0);
  const points = await generate('uniform', 1000, { seed: 5 });

  // The fallback, in both dimensions.
  const flat = points.map((x, i) => (i % 3 === 2 ? 1 : x));
  const coplanar = await triangulator.delaunay3d(flat, { resident: true });
  assert.deepEqual([coplanar.dimension, coplanar.stats.thread], [2, 'worker']);
  assert.match(coplanar.stats.fallback, /coplanar/);
  const plane = await generate2d('uniform', 1500, { seed: 5 });
  const triangles = await triangulator.delaunay2d(plane);
  assert.deepEqual([triangles.stats.backend, triangles.stats.thread], ['gpu', 'worker']);
  const { triangles: expected2d } = await delaunay2d(plane, { backend: 'cpu' });
  assert.equal(canonical(triangles.triangles, 3), canonical(expected2d, 3));
  const line = await triangulator.delaunay2d(plane.map((x, i) => (i % 2 ? 0 : x)));
  assert.equal(line.dimension, 1);
  const few = await triangulator.delaunay3d(points, { backend: 'cpu' });
  assert.deepEqual([few.stats.backend, few.stats.thread], ['cpu', 'worker']);

  // A mesh on the device, its update, and its arrays.
  const resident = await triangulator.delaunay3d(points, { resident: true });
  const moved = points.map((x, i) => (i % 97 ? x : x * 1.001));
  await resident.update(moved);
  const { tetrahedra } = await delaunay3d(moved, { backend: 'cpu' });
  assert.equal(fingerprint(await resident.read('tetrahedra')), fingerprint(tetrahedra));
  // The caller's own scope was not closed in place of one of the worker's.
  device.pushErrorScope('validation');
  const run = triangulator.delaunay3d(points);
  device.createBuffer({ size: 4, usage: 0xffffff });
  assert.notEqual(await device.popErrorScope(), null);
  await run;

  const here = await createTriangulator({ device, backend: 'gpu', worker: false });
  assert.equal(here.info.thread, 'caller');
  const same = await here.delaunay3d(points);
  const before = await run;
  assert.equal(fingerprint(same.tetrahedra), fingerprint(before.tetrahedra));
  assert.deepEqual(Object.keys(same.stats), Object.keys(mesh.stats));
  assert.deepEqual(errors, []);
  here.dispose();
  triangulator.dispose();
  // It is not closed with its triangulators.
  assert.equal((await resident.read('hull')).length % 3, 0);
});

test('aborts, and the loss of the caller’s device', { timeout: 600_000 }, async () => {
  const device = await openDevice();
  const triangulator = await createTriangulator({ device, backend: 'gpu' });
  const points = await generate('uniform', 1000, { seed: 6 });
  const mesh = await triangulator.delaunay3d(points, { resident: true });
  for (const phase of ['lattice', 'phase 1', 'splay', 'finish']) {
    const controller = new AbortController();
    const { signal } = controller;
    const onProgress = (report) => report.phase === phase && controller.abort();
    const run = triangulator.delaunay3d(points, { signal, onProgress });
    // Reports are rare, so that there may be none of a short phase.
    await run.then(
      () => {},
      ({ code }) => assert.equal(code, 'ABORTED'),
    );
  }
  await assert.rejects(triangulator.delaunay3d(points, { signal: AbortSignal.timeout(1) }), {
    name: 'TimeoutError',
  });
  // The mesh outlasts the worker that may have been ended.
  const moved = points.map((x) => x * 1.5);
  await mesh.update(moved);
  const { tetrahedra } = await delaunay3d(moved, { backend: 'cpu' });
  assert.equal(fingerprint(await mesh.read('tetrahedra')), fingerprint(tetrahedra));
  assert.equal(typeof mesh.stats.update.flips, 'number');

  const reports = [];
  const run = triangulator.delaunay3d(points, {
    onProgress(report) {
      if (reports.push(report) === 1) device.destroy();
    },
  });
  await assert.rejects(run, ({ code }) => ['DEVICE_LOST', 'GPU'].includes(code));
  await assert.rejects(mesh.read('hull'), ({ code }) => ['DEVICE_LOST', 'GPU'].includes(code));
  triangulator.dispose();
  await assert.rejects(triangulator.delaunay3d(points), { code: 'DISPOSED' });
});

test('what the worker has dropped is garbage here, too', { timeout: 600_000 }, async () => {
  setFlagsFromString('--expose-gc');
  const collectGarbage = runInNewContext('gc');
  const device = await openDevice();
  const create = device.createBuffer.bind(device);
  const created = [];
  const createBuffer = (descriptor) => {
    const buffer = create(descriptor);
    created.push(new WeakRef(buffer));
    return buffer;
  };
  Object.defineProperty(device, 'createBuffer', { value: createBuffer });
  const triangulator = await createTriangulator({ device, backend: 'gpu' });
  const points = await generate('uniform', 1000, { seed: 7 });
  // Each number of points has buffers of its own. The worker does not collect its garbage meanwhile.
  for (let count = 300; count < 310; count++)
    await triangulator.delaunay3d(points.slice(0, 3 * count));
  // What a promise has just been fulfilled with is alive until the next turn.
  await new Promise((resolve) => setImmediate(resolve));
  collectGarbage();
  const alive = created.filter((reference) => reference.deref()).length;
  assert.ok(alive < created.length / 2, `${alive} of ${created.length} buffers`);
  triangulator.dispose();
});
