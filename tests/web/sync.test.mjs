// The functions that are done when they return.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Worker } from 'node:worker_threads';
import { fingerprint } from './fingerprints.mjs';
import { importFrom, pinned, project } from './package.mjs';

const folder = project({
  'worker.mjs': `
    import { parentPort } from 'node:worker_threads';
    import { delaunay2dSync, load2d } from 'gdel-wasm';
    await load2d();
    parentPort.postMessage(delaunay2dSync([0, 0, 1, 0, 0, 1]).triangles.length);`,
});
const main = await importFrom(folder);
const { delaunay2d, delaunay2dSync, delaunay3d, delaunay3dSync, generate, generate2d } = main;
const { GdelError, load2d, load3d, Mesh2, Mesh3, verify } = main;

test('before they are loaded, the error says what to do', async () => {
  for (const [call, load] of [
    [() => delaunay3dSync([0, 0, 0]), /await load3d\(\) first/],
    [() => delaunay2dSync([0, 0]), /await load2d\(\) first/],
  ]) {
    assert.throws(call, (error) => {
      assert.ok(error instanceof GdelError);
      assert.equal(error.code, 'NOT_LOADED');
      assert.match(error.message, load);
      return true;
    });
  }
  await Promise.all([load3d(), load3d(), load2d()]);
});

test('the meshes are the native ones', async () => {
  for (const { kind, count, seed, fingerprint: expected } of pinned) {
    const points = await generate(kind, count, { seed });
    const mesh = delaunay3dSync(points);
    assert.equal(fingerprint(mesh.tetrahedra), expected, kind);
    assert.ok((await verify(points, mesh)).passed);
  }
});

test('the mesh is that of the asynchronous function, with the place in its statistics', async () => {
  const inputs = [await generate('ball', 500), await generate2d('disk', 500)];
  for (const [async, sync, Mesh, points] of [
    [delaunay3d, delaunay3dSync, Mesh3, inputs[0]],
    [delaunay2d, delaunay2dSync, Mesh2, inputs[1]],
  ]) {
    const [expected, found] = [await async(points), sync(points)];
    assert.ok(found instanceof Mesh);
    const { stats: _, ...arrays } = found;
    for (const [name, array] of Object.entries(arrays))
      assert.deepEqual(array, expected[name], name);
    assert.deepEqual(Object.keys(found.stats).sort(), Object.keys(expected.stats).sort());
    assert.equal(found.stats.thread, 'caller');
    assert.match(found.stats.whyThread, /synchronous/);
    assert.equal(found.stats.whyInlined, null);
    assert.equal(found.stats.backend, 'cpu');
    assert.equal(found.stats.fallback, null);
    assert.ok(found.stats.wasmBytes > 0 && found.stats.milliseconds >= 0);
    assert.ok((await found.toVTU()).length > 0);
  }
});

test('outputs, accessors and copies are as there', () => {
  const rows = [
    [0, 0, 0],
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ];
  const mesh = delaunay3dSync(rows, { outputs: ['hull'] });
  assert.deepEqual([mesh.hull.length, mesh.neighbors.length, mesh.duplicateOf.length], [12, 0, 0]);
  const objects = rows.map(([x, y, z]) => ({ x, y, z }));
  const point = ({ x, y, z }) => [x, y, z];
  assert.deepEqual(delaunay3dSync(objects, { point }).tetrahedra, mesh.tetrahedra);
  assert.equal(delaunay2dSync(objects, { point: ({ x, y }) => [x, y] }).triangles.length, 3);
  const points = Float64Array.from(rows.flat());
  const own = delaunay3dSync(points).points;
  assert.deepEqual(own, points);
  assert.notEqual(own.buffer, points.buffer);
});

test('an error leaves the functions usable', () => {
  for (const [sync, bad] of [
    [delaunay3dSync, [0, 0, NaN]],
    [delaunay2dSync, [0, Infinity]],
  ]) {
    assert.throws(() => sync(bad), { name: 'GdelError', code: 'NOT_FINITE', index: 0 });
    assert.equal(sync([]).dimension, 0);
  }
});

test('1000 runs need no more memory than a few', async () => {
  const points = await generate('uniform', 200);
  const bytes = [];
  for (let i = 0; i < 1000; i++) bytes.push(delaunay3dSync(points).stats.wasmBytes);
  assert.equal(bytes.at(-1), bytes[2]);
});

test('a worker of one’s own can use them', async () => {
  const worker = new Worker(new URL(`file://${folder}/worker.mjs`));
  const [length] = await new Promise((resolve, reject) => {
    worker.on('message', (length) => resolve([length]));
    worker.on('error', reject);
  });
  await worker.terminate();
  assert.equal(length, 3);
});
