// The GPU backend in Node, by the npm package `webgpu` (Dawn) on Chromium's software driver.

import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { test } from 'node:test';
import { fingerprint } from './fingerprints.mjs';
import { importFrom, pinned, project } from './package.mjs';

const swiftshader = '/usr/lib/chromium/vk_swiftshader_icd.json';
if (!process.env.VK_DRIVER_FILES && existsSync(swiftshader))
  process.env.VK_DRIVER_FILES = swiftshader;
const { create } = await import('webgpu');

test('the mesh is the native one; a run can be aborted', { timeout: 600_000 }, async () => {
  const { createTriangulator, generate } = await importFrom(project());
  const triangulator = await createTriangulator({ gpu, backend: 'gpu' });
  assert.equal(triangulator.info.backend, 'gpu');
  assert.equal(triangulator.info.thread, 'caller');
  assert.match(triangulator.info.whyThread, /another thread/);
  const { kind, count, seed, fingerprint: expected } = pinned.find(({ count }) => count < 100);
  const points = await generate(kind, count, { seed });
  const mesh = await triangulator.delaunay3d(points);
  assert.equal(fingerprint(mesh.tetrahedra), expected);
  assert.equal(mesh.stats.backend, 'gpu');
  assert.equal(mesh.stats.fallback, null);
  assert.ok(mesh.stats.gpu.dispatches > 0);
  assert.ok(mesh.stats.adapter.maxStorageBufferBindingSize >= 128 * 2 ** 20);

  // What was not asked for is not read from the device.
  const hull = await triangulator.delaunay3d(points, { outputs: ['hull'] });
  assert.equal(fingerprint(hull.tetrahedra), expected);
  assert.equal(hull.hull.length, mesh.hull.length);
  assert.deepEqual([hull.neighbors.length, hull.duplicateOf.length], [0, 0]);
  assert.deepEqual(
    [mesh.neighbors.length, mesh.duplicateOf.length],
    [mesh.tetrahedra.length, count],
  );
  assert.ok(hull.stats.gpu.bytesRead < mesh.stats.gpu.bytesRead);

  const controller = new AbortController();
  const run = triangulator.delaunay3d(points, {
    signal: controller.signal,
    onProgress: () => controller.abort(),
  });
  await assert.rejects(run, { code: 'ABORTED' });
  triangulator.dispose();
  await assert.rejects(triangulator.delaunay3d(points), { code: 'DISPOSED' });
});

/** Kept, since Dawn's devices do not outlive their instance. */
const gpu = create([]);

/** Returns a device with the largest buffers that the driver has. */
async function openDevice() {
  const adapter = await gpu.requestAdapter();
  const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
  return adapter.requestDevice({ requiredLimits: { maxBufferSize, maxStorageBufferBindingSize } });
}

/** Notes submissions to a device from now on. Returns a function that ends this and returns them. */
function submissionsOf(device) {
  // Each of Dawn's objects for the queue has its own properties.
  const queue = Object.getPrototypeOf(device.queue);
  const { submit } = queue;
  const submissions = [];
  queue.submit = function (commands) {
    submissions.push(commands);
    return submit.call(this, commands);
  };
  return () => {
    queue.submit = submit;
    return submissions;
  };
}

/** Returns a buffer with these contents. */
function bufferOf(device, array, usage = 0) {
  const buffer = device.createBuffer({ size: array.byteLength, usage: usage | 4 | 8 });
  device.queue.writeBuffer(buffer, 0, array);
  return buffer;
}

test("a mesh stays on the caller's device", { timeout: 600_000 }, async () => {
  const { createTriangulator, delaunay3d, generate, ResidentMesh3 } = await importFrom(project());
  const device = await openDevice();
  const triangulator = await createTriangulator({ device, backend: 'gpu' });
  assert.equal(triangulator.info.thread, 'worker');
  const points = await generate('uniform', 300, { seed: 3 });
  const expected = await delaunay3d(points, { backend: 'cpu' });
  const print = fingerprint(expected.tetrahedra);

  const mesh = await triangulator.delaunay3d(points, { resident: true });
  assert.ok(mesh instanceof ResidentMesh3);
  assert.equal(mesh.stats.backend, 'gpu');
  assert.equal(mesh.stats.fallback, null);
  assert.equal(mesh.dimension, 3);
  assert.deepEqual(mesh.duplicateOf, expected.duplicateOf);
  assert.equal(mesh.tetrahedronCount, expected.tetrahedra.length / 4);
  assert.equal(mesh.hullCount, expected.hull.length / 3);
  const { buffers } = mesh;
  assert.equal(buffers.tetrahedra.size, 4 * expected.tetrahedra.length);
  assert.equal(buffers.neighbors.size, buffers.tetrahedra.size);
  assert.equal(buffers.hull.size, 4 * expected.hull.length);
  assert.equal(buffers.vertexTetrahedron.size, 4 * 300);

  // Another run, with the same points from a buffer, does not change the first mesh.
  const other = await triangulator.delaunay3d(bufferOf(device, new Float32Array(points)));
  const rounded = await delaunay3d(new Float32Array(points), { backend: 'cpu' });
  assert.equal(fingerprint(other.tetrahedra), fingerprint(rounded.tetrahedra));
  assert.equal(other.neighbors.length, other.tetrahedra.length);
  assert.ok(other.stats.gpu.bytesRead >= 4 * (2 * other.tetrahedra.length + other.hull.length));

  const tetrahedra = await mesh.read('tetrahedra');
  assert.equal(fingerprint(tetrahedra), print);
  const unneeded = await mesh.read('neighbors');
  assert.equal(fingerprint(await mesh.read('tetrahedra', { reuse: unneeded })), print);
  assert.equal(unneeded.length, 0);
  const neighbors = await mesh.read('neighbors');
  assert.ok(neighbors instanceof Int32Array && neighbors.length === tetrahedra.length);
  neighbors.forEach((u, i) => {
    if (u >= 0) assert.ok(neighbors.subarray(4 * u, 4 * u + 4).includes(i >> 2));
  });
  const lowest = new Int32Array(300).fill(-1);
  for (let i = tetrahedra.length - 1; i >= 0; i--) lowest[tetrahedra[i]] = i >> 2;
  assert.deepEqual(await mesh.read('vertexTetrahedron'), lowest);
  assert.equal((await mesh.read('hull')).length, expected.hull.length);
  await assert.rejects(mesh.read('nothing'), { code: 'BAD_INPUT' });

  // Dawn frees memory in submissions: there is one, so that the next run does not have to.
  const submitted = submissionsOf(device);
  mesh.destroy();
  assert.deepEqual(submitted(), [[]]);
  await assert.rejects(mesh.read('hull'), { code: 'DISPOSED' });

  // Few points are the CPU's, and on the device all the same.
  const cpu = await triangulator.delaunay3d(points, { resident: true, backend: 'cpu' });
  assert.equal(cpu.stats.backend, 'cpu');
  assert.equal(fingerprint(await cpu.read('tetrahedra')), print);

  const wrong = bufferOf(device, new Float32Array(4));
  await assert.rejects(triangulator.delaunay3d(wrong), { code: 'BAD_INPUT' });
  const unreadable = device.createBuffer({ size: 36, usage: 128 });
  await assert.rejects(triangulator.delaunay3d(unreadable), { code: 'BAD_INPUT' });
  await assert.rejects(delaunay3d(points, { resident: true }), { code: 'BAD_INPUT' });
  await assert.rejects(createTriangulator({ device: {} }), { code: 'BAD_INPUT' });

  // The device remains the caller's, and the meshes remain.
  triangulator.dispose();
  assert.equal(fingerprint(await cpu.read('tetrahedra')), print);
  assert.ok(bufferOf(device, new Float32Array(4)));

  device.destroy();
  await assert.rejects(cpu.read('tetrahedra'), (error) =>
    ['DEVICE_LOST', 'GPU'].includes(error.code),
  );
});

test('the arrays of a mesh give their memory to the next one', { timeout: 600_000 }, async () => {
  const { createTriangulator, delaunay2d, delaunay3d, generate } = await importFrom(project());
  const triangulator = await createTriangulator({ gpu, backend: 'gpu' });
  const points = await generate('uniform', 320, { seed: 1 });
  const fewer = points.slice(0, 3 * 300);
  const old = await triangulator.delaunay3d(points);
  const { tetrahedra, neighbors, hull } = old;
  const bytes = tetrahedra.buffer.byteLength;
  assert.equal(bytes, tetrahedra.byteLength);

  const mesh = await triangulator.delaunay3d(fewer, { reuse: old });
  for (const array of [tetrahedra, neighbors, hull]) assert.equal(array.length, 0);
  assert.equal(old.points.length, 3 * 320);
  const expected = await delaunay3d(fewer, { backend: 'cpu' });
  assert.equal(fingerprint(mesh.tetrahedra), fingerprint(expected.tetrahedra));
  assert.equal(mesh.neighbors.length, expected.neighbors.length);
  assert.equal(mesh.hull.length, expected.hull.length);
  assert.equal(mesh.tetrahedra.buffer.byteLength, bytes);
  assert.equal(mesh.neighbors.buffer.byteLength, bytes);

  // What is too small, or far too large, is not taken. Fresh memory is a little larger, for next time.
  const large = await delaunay3d(await generate('uniform', 1000, { seed: 1 }), { backend: 'cpu' });
  const fresh = await triangulator.delaunay3d(fewer, { reuse: large });
  assert.equal(large.tetrahedra.length, 0);
  assert.equal(fingerprint(fresh.tetrahedra), fingerprint(mesh.tetrahedra));
  const room = fresh.tetrahedra.buffer.byteLength / fresh.tetrahedra.byteLength;
  assert.ok(room > 1 && room < 1.1);
  // A mesh whose memory was taken has none.
  const again = await triangulator.delaunay3d(fewer, { reuse: large });
  assert.equal(fingerprint(again.tetrahedra), fingerprint(mesh.tetrahedra));

  const flat = await triangulator.delaunay2d(fewer.slice(0, 600));
  const next = await triangulator.delaunay2d(fewer.slice(0, 598), { reuse: flat });
  assert.equal(flat.triangles.length, 0);
  assert.equal(flat.coords.length, 600);
  const expected2d = await delaunay2d(fewer.slice(0, 598), { backend: 'cpu' });
  assert.deepEqual(canonical2d(next.triangles), canonical2d(expected2d.triangles));

  // In a worker, which gets the memory.
  const elsewhere = await delaunay3d(points, { backend: 'cpu', reuse: mesh });
  assert.equal(mesh.tetrahedra.length, 0);
  assert.equal(elsewhere.tetrahedra.byteLength, bytes);
  await assert.rejects(delaunay3d(points, { reuse: 3 }), { code: 'BAD_INPUT' });
  triangulator.dispose();
});

// They are written to the device before their lattice is known, into buffers for those of the last run.
test('points that come after as many others', { timeout: 600_000 }, async () => {
  const { createTriangulator, delaunay2d, delaunay3d, generate } = await importFrom(project());
  const triangulator = await createTriangulator({ gpu, backend: 'gpu' });
  const check = async (points) => {
    const mesh = await triangulator.delaunay3d(points);
    assert.equal(mesh.stats.fallback, null);
    const expected = await delaunay3d(points, { backend: 'cpu' });
    assert.equal(fingerprint(mesh.tetrahedra), fingerprint(expected.tetrahedra));
  };
  const of = (seed, count) => generate('uniform', count, { seed });
  const [one, other] = await Promise.all([of(1, 343), of(2, 343)]);
  const grid = Float64Array.from(
    { length: 3 * 343 },
    (_, i) => Math.floor(Math.floor(i / 3) / 7 ** (i % 3)) % 7,
  );
  for (const points of [one, other, grid, one, Float32Array.from(other), grid, other])
    await check(points);
  const bad = one.with(1000, Infinity);
  await assert.rejects(triangulator.delaunay3d(bad), { code: 'NOT_FINITE', index: 333 });
  await check(other);

  // In two pieces.
  const many = await Promise.all([of(3, 23_000), of(4, 23_000)]);
  for (const points of many.map((coordinates) => coordinates.subarray(0, 2 * 34_000))) {
    const mesh = await triangulator.delaunay2d(points);
    assert.equal(mesh.stats.fallback, null);
    const expected = await delaunay2d(points, { backend: 'cpu' });
    assert.ok(canonical2d(mesh.triangles) === canonical2d(expected.triangles));
  }
  triangulator.dispose();
});

/** Returns the triangles in an order of their own: equal for equal meshes. */
function canonical2d(triangles) {
  const rows = [];
  for (let t = 0; t < triangles.length; t += 3)
    rows.push(
      triangles
        .slice(t, t + 3)
        .sort()
        .join(),
    );
  return rows.sort().join(' ');
}

test("a 2D mesh stays on the caller's device, or comes from there", {
  timeout: 600_000,
}, async () => {
  const { createTriangulator, delaunay2d, generate2d, ResidentMesh2 } = await importFrom(project());
  const device = await openDevice();
  const triangulator = await createTriangulator({ device, backend: 'gpu' });
  const points = await generate2d('uniform', 500, { seed: 3 });
  const expected = await delaunay2d(points, { backend: 'cpu' });
  const print = canonical2d(expected.triangles);

  const read = await triangulator.delaunay2d(points);
  assert.deepEqual([read.stats.backend, read.stats.fallback], ['gpu', null]);
  assert.equal(canonical2d(read.triangles), print);
  assert.deepEqual(read.hull, expected.hull);
  assert.deepEqual(read.duplicateOf, expected.duplicateOf);
  assert.equal(read.halfedges.length, expected.halfedges.length);

  const mesh = await triangulator.delaunay2d(points, { resident: true });
  assert.ok(mesh instanceof ResidentMesh2);
  assert.deepEqual([mesh.stats.backend, mesh.stats.fallback], ['gpu', null]);
  assert.equal(mesh.triangleCount, expected.triangles.length / 3);
  assert.equal(mesh.hullCount, expected.hull.length);
  assert.equal(mesh.buffers.halfedges.size, 4 * expected.halfedges.length);
  const triangles = await mesh.read('triangles');
  assert.equal(canonical2d(triangles), print);
  assert.deepEqual(await mesh.read('hull'), expected.hull);
  const halfedges = await mesh.read('halfedges');
  assert.ok(halfedges instanceof Int32Array && halfedges.length === triangles.length);
  halfedges.forEach((against, e) => {
    if (against >= 0) assert.equal(halfedges[against], e);
  });
  const lowest = new Int32Array(500).fill(-1);
  for (let i = triangles.length - 1; i >= 0; i--) lowest[triangles[i]] = Math.floor(i / 3);
  assert.deepEqual(await mesh.read('vertexTriangle'), lowest);
  mesh.destroy();
  await assert.rejects(mesh.read('hull'), { code: 'DISPOSED' });

  // What the CPU has made is on the device all the same.
  const line = await triangulator.delaunay2d([0, 0, 2, 2, 1, 1], { resident: true });
  assert.deepEqual([line.dimension, line.triangleCount], [1, 0]);
  assert.deepEqual(await line.read('hull'), new Uint32Array([0, 2, 1]));
  await assert.rejects(delaunay2d(points, { resident: true }), { code: 'BAD_INPUT' });
  triangulator.dispose();
});

/** Returns the sorted rows of an array, each one sorted: equal for equal sets. */
const setOf = (array, width) =>
  Array.from({ length: array.length / width }, (_, i) =>
    [...array.subarray(width * i, width * (i + 1))].sort((a, b) => a - b).join(),
  ).sort();

for (const D of [3, 2]) {
  test(`answers of a ${D}D mesh on the device are those of a mesh elsewhere`, {
    timeout: 600_000,
  }, async () => {
    const gdel = await importFrom(project());
    const device = await openDevice();
    const triangulator = await gdel.createTriangulator({ device, backend: 'gpu' });
    const [run, here] =
      D === 3
        ? [(p, o) => triangulator.delaunay3d(p, o), gdel.delaunay3d]
        : [(p, o) => triangulator.delaunay2d(p, o), gdel.delaunay2d];
    const generate = D === 3 ? gdel.generate : gdel.generate2d;
    const points = await generate('uniform', 300, { seed: 3 });
    // A duplicate, which resolves to what stands for it.
    points.set(points.subarray(0, D), 7 * D);
    const queries = (await generate('uniform', 100, { seed: 4 })).map((x) => 1.5 * x - 0.25);
    const values = Float64Array.from({ length: 300 }, (_, i) => Math.sin(i));
    const mesh = await run(points, { resident: true });
    assert.equal(mesh.stats.backend, 'gpu');

    /** Asks everything of both meshes. */
    async function compare(points) {
      const expected = await here(points, { backend: 'cpu' });
      assert.deepEqual(await mesh.nearest(queries), await expected.nearest(queries));
      assert.deepEqual(
        await mesh.nearest(queries, { k: 3 }),
        await expected.nearest(queries, { k: 3 }),
      );
      for (const method of ['linear', 'laplace', 'sibson']) {
        const { values: found } = await mesh.interpolate(values, queries, { method });
        const { values: others } = await expected.interpolate(values, queries, { method });
        found.forEach((value, i) => {
          const other = others[i];
          assert.ok(Number.isNaN(other) ? Number.isNaN(value) : Math.abs(value - other) < 1e-12);
        });
        assert.ok(found.some(Number.isNaN) && !found.every(Number.isNaN));
      }
      const [simplices, facets] = D === 3 ? ['tetrahedra', 'facets'] : ['triangles', 'halfedges'];
      const located = await mesh.locate(queries);
      const others = await expected.locate(queries);
      const read = await mesh.read(simplices);
      const corners = (array, t) =>
        [...array.subarray((D + 1) * t, (D + 1) * (t + 1))].sort().join();
      located[simplices].forEach((t, i) => {
        const other = others[simplices][i];
        assert.equal(t < 0, other < 0);
        assert.equal(located[facets][i] < 0, t >= 0);
        if (t >= 0) assert.equal(corners(read, t), corners(expected[simplices], other));
      });
      const [topology, ofOthers] = [await mesh.topology(), await expected.topology()];
      assert.deepEqual(topology.neighbors, ofOthers.neighbors);
      assert.deepEqual(setOf(topology.edges, 2), setOf(ofOthers.edges, 2));
      const sizes = (await expected.geometry()).volumes.slice().sort();
      (await mesh.geometry()).volumes.sort().forEach((size, i) => {
        assert.ok(Math.abs(size - sizes[i]) < 1e-12);
      });
      assert.ok(sizes.length > 300);
      const volumes = await mesh.voronoi({ clip: 'box' });
      (await expected.voronoi({ clip: 'box' })).volumes.forEach((volume, i) => {
        assert.ok(Math.abs(volume - volumes.volumes[i]) < 1e-12);
      });
      const [shape, other] = [await mesh.alphaShape(), await expected.alphaShape()];
      assert.equal(shape.alpha, other.alpha);
      assert.deepEqual(setOf(shape.surface, D), setOf(other.surface, D));
      const radii = new Float64Array(points.length / D).fill(0.05);
      const [balls, same] = [
        await mesh.ballComplex({ radii }),
        await expected.ballComplex({ radii }),
      ];
      assert.deepEqual([balls.edges, balls.componentOf], [same.edges, same.componentOf]);
      const tree = await mesh.spanningTree();
      assert.deepEqual(tree.edges, (await expected.spanningTree()).edges);
      assert.equal(tree.clusters(5)[7], tree.clusters(5)[0]);
    }
    await compare(points);
    // The arrays are read again once the points have moved.
    const moved = points.map((x, i) => x + (i % 5) * 1e-3);
    await mesh.update(moved);
    await compare(moved);

    await assert.rejects(mesh.locate([[Number.NaN, 0, 0].slice(0, D)]), {
      code: 'NOT_FINITE',
      index: 0,
    });
    await assert.rejects(mesh.nearest([[0]]), { code: 'BAD_INPUT' });
    await assert.rejects(mesh.interpolate([1], queries), { code: 'BAD_INPUT' });
    await assert.rejects(mesh.alphaShape({ alpha: -1 }), { code: 'BAD_INPUT' });
    await assert.rejects(mesh.voronoi({ signal: AbortSignal.abort() }), { code: 'ABORTED' });
    const reports = [];
    await mesh.spanningTree({ onProgress: (report) => reports.push(report) });
    assert.deepEqual(reports.at(-1), { phase: 'tree', fraction: 1 });

    // What the CPU has made is on the device all the same, and flat points have empty answers.
    const flat = await run(new Float64Array(4 * D), { resident: true });
    assert.deepEqual(await flat.nearest(queries.subarray(0, D)), new Int32Array([0]));
    assert.deepEqual((await flat.alphaShape()).alpha, 0);
    // Points from a buffer of the device.
    const single = new Float32Array(points);
    const buffered = await run(bufferOf(device, single), { resident: true });
    assert.deepEqual(await buffered.nearest(single), await (await here(single)).nearest(single));

    mesh.destroy();
    await assert.rejects(mesh.nearest(queries), { code: 'DISPOSED' });
    triangulator.dispose();
  });
}
