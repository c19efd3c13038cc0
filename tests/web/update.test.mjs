// Points that move: `update` of meshes that the CPU has made, in a worker and in the calling thread.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { abortOf } from './abort.mjs';
import { dimensionsOf, rejectsOf } from './dimensions.mjs';
import { canonical, move, randomFrom } from './moving.mjs';
import { importFrom, project } from './package.mjs';

const gdel = await importFrom(project());
const { createTriangulator, delaunay3d } = gdel;

const DIMENSIONS = dimensionsOf(gdel);
const rejects = rejectsOf(gdel);

for (const [key, { triangulate, blocking, generate, verify, arrays }] of Object.entries(
  DIMENSIONS,
)) {
  const D = Number(key);
  const [simplices, , , , coordinates] = arrays;
  const setOf = (mesh) => canonical(mesh[simplices], D + 1);
  const arraysOf = (mesh) => arrays.map((name) => mesh[name]);

  /** The mesh is that of a run from scratch on these points, and proven. */
  async function assertIsMeshOf(mesh, points, expected) {
    expected ??= await triangulate(points);
    assert.equal(setOf(mesh), setOf(expected));
    assert.deepEqual(mesh.duplicateOf, expected.duplicateOf);
    assert.equal(mesh.dimension, expected.dimension);
    assert.deepEqual(mesh[coordinates], points);
    const report = await verify(points, mesh);
    assert.ok(report.passed, JSON.stringify(report.checks.filter(({ passed }) => !passed)));
  }

  test(`${D}D: a mesh follows its points`, async () => {
    const random = randomFrom(D);
    let points = await generate('uniform', 600, { seed: 5 });
    const mesh = await triangulate(points);
    assert.equal(mesh.stats.update, null);
    for (const share of [0, 1e-3, 1]) {
      points = move(points, D, share, random);
      const before = arraysOf(mesh);
      const copies = before.map((array) => array.slice());
      assert.equal(await mesh.update(points), undefined);
      await assertIsMeshOf(mesh, points);
      // The old arrays belong to those who have them.
      assert.deepEqual(before, copies);
      assert.notEqual(mesh[simplices], before[0]);
      const { update, backend, milliseconds, thread } = mesh.stats;
      assert.deepEqual([backend, thread], ['cpu', 'worker']);
      assert.ok(milliseconds > 0);
      assert.equal(update.restarted, 'not-resident');
      if (D === 2) assert.equal(mesh.find(points[10], points[11]), 5);
    }
    // Single precision, rows and objects do as well.
    const rounded = new Float32Array(points);
    await mesh.update(rounded);
    await assertIsMeshOf(mesh, rounded);
    const rows = Array.from({ length: 600 }, (_, i) => points.slice(D * i, D * i + D));
    await mesh.update(rows);
    await assertIsMeshOf(mesh, points);
    await mesh.update(
      rows.map((at) => ({ at })),
      { point: ({ at }) => at },
    );
    await assertIsMeshOf(mesh, points);

    const moved = move(points, D, 1e-3, random);
    const given = moved.slice();
    await mesh.update(given, { transfer: true });
    assert.equal(given.length, 0);
    await assertIsMeshOf(mesh, moved);
  });

  test(`${D}D: points meet, part, become flat and leave the hull`, async () => {
    const points = await generate('uniform', 400, { seed: 7 });
    const last = (array) => array.subarray(-D);
    last(points).set(points.subarray(0, D));
    const mesh = await triangulate(points);
    assert.equal(mesh.duplicateOf[399], 0);

    const parted = points.slice();
    last(parted)[0] += 1e-3;
    await mesh.update(parted);
    await assertIsMeshOf(mesh, parted);

    await mesh.update(points);
    await assertIsMeshOf(mesh, points);

    const outside = points.slice();
    outside[0] = 3;
    await mesh.update(outside);
    await assertIsMeshOf(mesh, outside);

    const flat = points.map((x, i) => (i % D === 0 ? 0.5 : x));
    await mesh.update(flat);
    assert.equal(mesh.dimension, D - 1);
    await assertIsMeshOf(mesh, flat);
    await mesh.update(points);
    await assertIsMeshOf(mesh, points);

    const none = await triangulate([]);
    await none.update([]);
    assert.equal(none[simplices].length, 0);
  });

  test(`${D}D: after an error the mesh is what it was`, async () => {
    const points = await generate('uniform', 300, { seed: 9 });
    const moved = move(points, D, 1e-3, randomFrom(1));
    const mesh = await triangulate(points);
    const before = [...arraysOf(mesh), mesh.stats];
    const unchanged = () =>
      assert.ok([...arraysOf(mesh), mesh.stats].every((value, i) => value === before[i]));

    await rejects(mesh.update(points.slice(D)), 'BAD_INPUT', /300 points, not 299/);
    await rejects(mesh.update(points.slice(1)), 'BAD_INPUT', /multiple/);
    await rejects(mesh.update('points'), 'BAD_INPUT');
    await rejects(mesh.update(points, { transfer: 1 }), 'BAD_INPUT', /transfer/);
    await rejects(mesh.update(points, 3), 'BAD_INPUT', /options/);
    const holed = moved.slice();
    holed[D * 7] = Number.NaN;
    await assert.rejects(mesh.update(holed), { code: 'NOT_FINITE', index: 7 });
    await assert.rejects(mesh.update(holed, { transfer: true }), (error) => {
      assert.equal(error.code, 'NOT_FINITE');
      assert.equal(error.points.length, moved.length);
      return true;
    });
    unchanged();

    // One update at a time: the next one goes on from its result.
    const first = mesh.update(moved);
    await rejects(mesh.update(points), 'BAD_INPUT', /being updated/);
    await first;
    await assertIsMeshOf(mesh, moved);

    // Arrays that are broken, or not there any more.
    const broken = await triangulate(points);
    broken[simplices][5] = 4_000_000_000;
    await broken.update(moved);
    await assertIsMeshOf(broken, moved);
    structuredClone(0, { transfer: [broken[simplices].buffer] });
    await rejects(broken.update(points), 'BAD_INPUT', /detached/);
  });

  test(`${D}D: an update can be aborted, and reports its progress`, async () => {
    const points = await generate('uniform', 20_000, { seed: 11 });
    const moved = move(points, D, 1e-3, randomFrom(2));
    const mesh = await triangulate(points);
    const before = arraysOf(mesh);
    const start = (options) => mesh.update(moved, options);
    assert.deepEqual(await abortOf(start), { code: 'ABORTED', atOnce: true });
    await rejects(mesh.update(moved, { signal: AbortSignal.abort() }), 'ABORTED');
    const reason = new Error('mine');
    const onProgress = () => {
      throw reason;
    };
    await assert.rejects(mesh.update(moved, { onProgress }), (error) => error === reason);
    assert.ok(arraysOf(mesh).every((array, i) => array === before[i]));

    const reports = [];
    await mesh.update(moved, { onProgress: (report) => reports.push(report) });
    assert.equal(reports[0].phase, 'sort');
    assert.equal(reports.at(-1).fraction, 1);
    await assertIsMeshOf(mesh, moved);
  });

  test(`${D}D: meshes of synchronous functions and of the calling thread are updated`, async () => {
    const points = await generate('uniform', 200, { seed: 13 });
    const moved = move(points, D, 1e-3, randomFrom(3));
    const mesh = (await blocking())(points);
    await mesh.update(moved);
    await assertIsMeshOf(mesh, moved);
    assert.equal(mesh.stats.update.restarted, 'not-resident');

    const triangulator = await createTriangulator({ backend: 'cpu', worker: false });
    const here = await triangulator[`delaunay${D}d`](points);
    await here.update(moved);
    await assertIsMeshOf(here, moved);
    assert.equal(here.stats.thread, 'caller');
    assert.deepEqual(await abortOf((options) => here.update(points, options)), {
      code: 'ABORTED',
      atOnce: true,
    });
    triangulator.dispose();
    const last = setOf(here);
    await rejects(here.update(points), 'DISPOSED');
    assert.equal(setOf(here), last);
  });
}

test('an update needs what the run was asked for, and gives the same', async () => {
  const points = await gdel.generate('uniform', 100, { seed: 1 });
  const bare = await delaunay3d(points, { outputs: ['neighbors'] });
  await rejects(bare.update(points), 'BAD_INPUT', /'duplicateOf'/);
  const mesh = await delaunay3d(points, { outputs: ['neighbors', 'duplicateOf'] });
  await mesh.update(points);
  assert.equal(mesh.hull.length, 0);
  assert.equal(mesh.neighbors.length, mesh.tetrahedra.length);
});
