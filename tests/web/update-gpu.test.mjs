// Points that move: `update` of meshes on the device, and of those that the GPU has made, in Node by
// the npm package `webgpu` (Dawn) on Chromium's software driver.

import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { test } from 'node:test';
import { canonical, move, randomFrom } from './moving.mjs';
import { importFrom, project } from './package.mjs';

const swiftshader = '/usr/lib/chromium/vk_swiftshader_icd.json';
if (!process.env.VK_DRIVER_FILES && existsSync(swiftshader))
  process.env.VK_DRIVER_FILES = swiftshader;
const { create } = await import('webgpu');
/** Kept, since Dawn's devices do not outlive their instance. */
const gpu = create([]);

const { createTriangulator, delaunay2d, delaunay3d, generate, generate2d } = await importFrom(
  project(),
);

/** What differs between the dimensions. */
const DIMENSIONS = {
  3: {
    triangulate: delaunay3d,
    generate,
    arrays: ['tetrahedra', 'neighbors', 'hull', 'vertexTetrahedron'],
    count: 'tetrahedronCount',
  },
  2: {
    triangulate: delaunay2d,
    generate: generate2d,
    arrays: ['triangles', 'halfedges', 'hull', 'vertexTriangle'],
    count: 'triangleCount',
  },
};

/** Returns a device with the largest buffers that the driver has, and the errors that it reports. */
async function openDevice() {
  const adapter = await gpu.requestAdapter();
  const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
  const requiredLimits = { maxBufferSize, maxStorageBufferBindingSize };
  const device = await adapter.requestDevice({ requiredLimits });
  const errors = [];
  device.addEventListener('uncapturederror', ({ error }) => errors.push(error.message));
  return { device, errors };
}

/** Returns a buffer with these contents. */
function bufferOf(device, array) {
  const buffer = device.createBuffer({ size: array.byteLength, usage: 4 | 8 });
  device.queue.writeBuffer(buffer, 0, array);
  return buffer;
}

/** Returns whether a buffer was destroyed: it cannot be copied from. */
async function isDestroyed(device, buffer) {
  device.pushErrorScope('validation');
  const target = device.createBuffer({ size: 16, usage: 8 });
  const encoder = device.createCommandEncoder();
  encoder.copyBufferToBuffer(buffer, 0, target, 0, 16);
  device.queue.submit([encoder.finish()]);
  return (await device.popErrorScope()) !== null;
}

for (const [key, { triangulate, generate, arrays, count }] of Object.entries(DIMENSIONS)) {
  const D = Number(key);
  const [simplices, neighbors] = arrays;

  /** The mesh is that of a run from scratch on these points. */
  async function assertIsMeshOf(mesh, points) {
    const expected = await triangulate(points, { backend: 'cpu' });
    const read = await mesh.read(simplices);
    assert.equal(canonical(read, D + 1), canonical(expected[simplices], D + 1));
    assert.equal(mesh[count], expected[simplices].length / (D + 1));
    assert.equal(mesh.hullCount, (await mesh.read('hull')).length / (D === 3 ? 3 : 1));
    assert.equal((await mesh.read('hull')).length, expected.hull.length);
    assert.deepEqual(mesh.duplicateOf, expected.duplicateOf);
    assert.equal(mesh.dimension, expected.dimension);
    const across = await mesh.read(neighbors);
    across.forEach((u, i) => {
      if (u < 0) return;
      if (D === 2) assert.equal(across[u], i);
      else assert.ok(across.subarray(4 * u, 4 * u + 4).includes(i >> 2));
    });
  }

  test(`${D}D: a mesh on the device follows its points`, { timeout: 600_000 }, async () => {
    const { device, errors } = await openDevice();
    const triangulator = await createTriangulator({ device, backend: 'gpu' });
    const run = (points, options) => triangulator[`delaunay${D}d`](points, options);
    const random = randomFrom(D);
    let points = await generate('uniform', 500, { seed: 3 });
    points.copyWithin(D * 499, 0, D);
    const mesh = await run(points, { resident: true });
    assert.equal(mesh.stats.update, null);
    let repaired = 0;
    for (const share of [0, 1e-3, 1e-3, 1e-2, 0.5, 1e-3]) {
      points = move(points, D, share, random);
      points.copyWithin(D * 499, 0, D);
      const { buffers } = mesh;
      await mesh.update(points);
      await assertIsMeshOf(mesh, points);
      const { backend, fallback, update } = mesh.stats;
      assert.deepEqual([backend, fallback], ['gpu', null]);
      if (update.restarted === null) repaired++;
      if (share === 0) assert.deepEqual([update.inverted, update.flips], [0, 0]);
      // The old buffers are freed, and the new ones are there.
      assert.ok(await isDestroyed(device, buffers[simplices]));
      assert.ok(!(await isDestroyed(device, mesh.buffers[simplices])));
    }
    assert.ok(repaired >= 4, `${repaired} of 6 steps were repaired`);

    // Duplicates part, and points from a buffer of the device, in single precision.
    const rounded = new Float32Array(move(points, D, 1e-3, random));
    const reports = [];
    await mesh.update(bufferOf(device, rounded), { onProgress: (report) => reports.push(report) });
    await assertIsMeshOf(mesh, rounded);
    assert.equal(mesh.stats.update.inserted, 1);
    assert.equal(reports.at(-1).fraction, 1);
    assert.ok(reports.some(({ phase }) => phase === 'lattice'));

    // What the CPU makes is on the device all the same.
    const flat = points.map((x, i) => (i % D === 0 ? 0.5 : x));
    await mesh.update(flat);
    assert.equal(mesh.dimension, D - 1);
    assert.equal(mesh[count], 0);
    await mesh.update(points);
    await assertIsMeshOf(mesh, points);
    assert.equal(mesh.stats.update.restarted, 'degenerate');
    assert.deepEqual(errors, []);
    triangulator.dispose();
    await assert.rejects(mesh.update(points), { code: 'DISPOSED' });
    await assertIsMeshOf(mesh, points);
  });

  test(`${D}D: after an error the mesh on the device is what it was`, {
    timeout: 600_000,
  }, async () => {
    const { device, errors } = await openDevice();
    const triangulator = await createTriangulator({ device, backend: 'gpu' });
    const run = (points, options) => triangulator[`delaunay${D}d`](points, options);
    const points = await generate('uniform', 300, { seed: 4 });
    const moved = move(points, D, 1e-3, randomFrom(1));
    const mesh = await run(points, { resident: true });
    const { buffers, stats } = mesh;
    const isUnchanged = () => mesh.buffers === buffers && mesh.stats === stats;

    await assert.rejects(mesh.update(points.slice(D)), { code: 'BAD_INPUT' });
    await assert.rejects(mesh.update(bufferOf(device, new Float32Array(4 * D))), {
      code: 'BAD_INPUT',
    });
    await assert.rejects(mesh.update(bufferOf(device, new Float32Array(D + 1))), {
      code: 'BAD_INPUT',
    });
    const unreadable = device.createBuffer({ size: 36, usage: 128 });
    await assert.rejects(mesh.update(unreadable), { code: 'BAD_INPUT' });
    const holed = moved.slice();
    holed[D * 7 + 1] = Number.POSITIVE_INFINITY;
    await assert.rejects(mesh.update(holed), { code: 'NOT_FINITE', index: 7 });
    // Before the device starts, and while it is at work.
    for (const last of ['lattice', 'phase 1']) {
      const controller = new AbortController();
      const aborted = mesh.update(moved, {
        signal: controller.signal,
        onProgress({ phase }) {
          if (phase === last) setTimeout(() => controller.abort());
        },
      });
      await assert.rejects(aborted, { code: 'ABORTED' });
    }
    assert.ok(isUnchanged());
    await assertIsMeshOf(mesh, points);

    // One at a time; others can read meanwhile.
    const updated = mesh.update(moved);
    await assert.rejects(mesh.update(points), { code: 'BAD_INPUT', message: /being updated/ });
    const read = await mesh.read(simplices);
    await updated;
    const expected = await triangulate(points, { backend: 'cpu' });
    assert.equal(canonical(read, D + 1), canonical(expected[simplices], D + 1));
    await assertIsMeshOf(mesh, moved);

    // Who destroys a mesh does not disturb what is under way.
    const late = mesh.update(points);
    const reading = mesh.read('hull');
    const last = mesh.buffers;
    mesh.destroy();
    assert.ok((await reading).length > 0);
    await assert.rejects(late, { code: 'DISPOSED' });
    await assert.rejects(mesh.update(points), { code: 'DISPOSED' });
    assert.ok(await isDestroyed(device, last[simplices]));
    assert.deepEqual(errors, []);

    // The device gets lost: before an update, and in the middle of one.
    const doomed = await run(points, { resident: true });
    const during = doomed.update(moved, { onProgress: () => device.destroy() });
    const isLoss = ({ code }) => ['DEVICE_LOST', 'GPU'].includes(code);
    await assert.rejects(during, isLoss);
    await assert.rejects(doomed.update(moved), isLoss);
    triangulator.dispose();
  });

  test(`${D}D: the GPU keeps what it has updated`, { timeout: 600_000 }, async () => {
    const triangulator = await createTriangulator({ gpu, backend: 'gpu' });
    const run = (points) => triangulator[`delaunay${D}d`](points);
    const random = randomFrom(2);
    let points = await generate('uniform', 300, { seed: 5 });
    const [mesh, other] = [await run(points), await run(points)];
    const steps = [];
    for (const which of [mesh, mesh, mesh, other, mesh, mesh]) {
      points = move(points, D, 1e-3, random);
      await which.update(points);
      const expected = await triangulate(points, { backend: 'cpu' });
      assert.equal(canonical(which[simplices], D + 1), canonical(expected[simplices], D + 1));
      assert.equal(which[neighbors].length, expected[neighbors].length);
      assert.equal(which.hull.length, expected.hull.length);
      assert.deepEqual(which.duplicateOf, expected.duplicateOf);
      assert.deepEqual([which.stats.backend, which.stats.fallback], ['gpu', null]);
      steps.push(which.stats.update.restarted);
    }
    assert.deepEqual(steps, ['not-resident', null, null, 'not-resident', 'not-resident', null]);

    // After an error, too, and not after another run.
    const holed = points.slice();
    holed[3] = Number.NaN;
    await assert.rejects(mesh.update(holed), { code: 'NOT_FINITE' });
    await assert.rejects(mesh.update(points.slice(D)), { code: 'BAD_INPUT' });
    await mesh.update(points);
    assert.equal(mesh.stats.update.restarted, null);
    await run(points);
    await mesh.update(points);
    assert.equal(mesh.stats.update.restarted, 'not-resident');

    // What the CPU has to make is the CPU's from then on.
    const flat = points.map((x, i) => (i % D === 0 ? 0.5 : x));
    await mesh.update(flat);
    assert.deepEqual([mesh.dimension, mesh.stats.backend], [D - 1, 'cpu']);
    await mesh.update(points);
    assert.equal(mesh.stats.update.restarted, 'not-resident');
    triangulator.dispose();
  });
}
