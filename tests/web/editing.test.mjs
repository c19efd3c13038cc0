// Points that come and go: `insert`, `remove` and `compact`, in a worker and in the calling thread.

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
  const arraysOf = (mesh) => arrays.map((name) => mesh[name]);
  const select = (points, indices) =>
    points.constructor.from([...indices].flatMap((i) => [...points.subarray(D * i, D * i + D)]));

  /** The mesh is that of a run from scratch on the points that were not removed, and proven. */
  async function assertIsMeshOf(mesh, points, removed = []) {
    assert.deepEqual(mesh[coordinates], points);
    const kept = Array.from({ length: points.length / D }, (_, i) => i).filter(
      (i) => !removed.includes(i),
    );
    const expected = await triangulate(select(points, kept));
    const renamed = expected[simplices].map((v) => kept[v]);
    assert.equal(canonical(mesh[simplices], D + 1), canonical(renamed, D + 1));
    const duplicateOf = Int32Array.from({ length: points.length / D }, (_, i) => i);
    expected.duplicateOf.forEach((of, i) => {
      duplicateOf[kept[i]] = of < 0 ? of : kept[of];
    });
    assert.deepEqual(mesh.duplicateOf, duplicateOf);
    assert.equal(mesh.dimension, expected.dimension);
    const report = await verify(points, mesh);
    assert.ok(report.passed, JSON.stringify(report.checks.filter(({ passed }) => !passed)));
    assert.equal(report.counts.unusedPoints, removed.length);
  }

  test(`${D}D: points come and go`, async () => {
    const all = await generate('uniform', 620, { seed: 5 });
    const mesh = await triangulate(all.slice(0, 600 * D));
    const before = arraysOf(mesh);
    const copies = before.map((array) => array.slice());
    const [first, second] = [all.slice(600 * D, 601 * D), all.slice(601 * D)];
    assert.deepEqual(await mesh.insert(first), Uint32Array.of(600));
    const update = (removed, inserted) =>
      assert.deepEqual(
        [mesh.stats.update.removed, mesh.stats.update.inserted, mesh.stats.update.restarted],
        [removed, inserted, null],
      );
    update(0, 1);
    // The old arrays belong to those who have them.
    assert.deepEqual(before, copies);
    await assertIsMeshOf(mesh, all.slice(0, 601 * D));

    // Rows and objects do as well.
    const rows = Array.from({ length: 19 }, (_, i) => [...second.subarray(D * i, D * i + D)]);
    await mesh.insert(rows.slice(0, 9));
    update(0, 9);
    await mesh.insert(
      rows.slice(9).map((at) => ({ at })),
      { point: ({ at }) => at },
    );
    update(0, 10);
    await assertIsMeshOf(mesh, all);

    assert.equal(await mesh.remove([7, 619]), undefined);
    update(2, 0);
    await mesh.remove(new Uint32Array([0, 300]));
    const removed = [7, 619, 0, 300];
    await assertIsMeshOf(mesh, all, removed);
    await mesh.remove([]);
    await mesh.insert([]);
    await assertIsMeshOf(mesh, all, removed);
    const { backend, milliseconds, thread } = mesh.stats;
    assert.deepEqual([backend, thread], ['cpu', 'worker']);
    assert.ok(milliseconds > 0);

    // What was removed is nowhere.
    const queries = select(all, [7, 619]);
    assert.ok([...(await mesh.nearest(queries))].every((v) => !removed.includes(v)));
    const { neighborOffsets, vertexSimplex } = await mesh.topology();
    const { cells } = await mesh.voronoi({ clip: 'box' });
    const tree = await mesh.spanningTree();
    const clusters = tree.clusters(1);
    for (const i of removed) {
      assert.equal(neighborOffsets[i], neighborOffsets[i + 1]);
      assert.equal(vertexSimplex[i], -1);
      if (D === 3) assert.equal(cells[i], cells[i + 1]);
      assert.equal(clusters[i], 2 ** 32 - 1);
    }
    assert.equal(clusters.filter((cluster) => cluster === 0).length, 616);
    if (D === 2) {
      assert.deepEqual(mesh.neighbors(0), []);
      assert.equal(mesh.find(all[10], all[11]), 5);
      assert.notEqual(mesh.find(all[0], all[1]), 0);
      assert.equal(mesh.find(all[10], all[11], 7), 5);
    }

    // The points move, a little and a lot.
    let moved = all;
    for (const share of [1e-3, 1]) {
      moved = move(moved, D, share, randomFrom(1));
      await mesh.update(moved);
      assert.equal(mesh.stats.update.restarted, 'not-resident');
      await assertIsMeshOf(mesh, moved, removed);
    }

    const kept = await mesh.compact();
    assert.equal(kept.length, 616);
    assert.ok(kept instanceof Uint32Array && !('kept' in mesh));
    await assertIsMeshOf(mesh, select(moved, kept));
    await mesh.remove([1]);
    await assertIsMeshOf(mesh, select(moved, kept), [1]);
  });

  test(`${D}D: duplicates, flat points and empty meshes`, async () => {
    const mesh = await triangulate([]);
    let points = new Float64Array(0);
    const insert = async (p) => {
      await mesh.insert([p]);
      points = Float64Array.of(...points, ...p);
    };
    const corner = (k) => Array.from({ length: D }, (_, axis) => (axis === k ? 1 : 0));
    for (let k = 0; k <= D; k++) {
      await insert(corner(k));
      await insert(corner(k));
      await assertIsMeshOf(mesh, points);
      assert.equal(mesh.dimension, k);
    }
    await mesh.remove([0]);
    await assertIsMeshOf(mesh, points, [0]);
    assert.equal(mesh.duplicateOf[1], -1);
    await mesh.remove([1]);
    await assertIsMeshOf(mesh, points, [0, 1]);
    assert.equal(mesh.dimension, D - 1);
    assert.equal(mesh.stats.update.restarted, 'degenerate');
    await mesh.remove(Array.from({ length: 2 * D }, (_, i) => i + 2));
    assert.equal(mesh.dimension, 0);
    if (D === 2) assert.equal(mesh.find(0, 0), -1);
    assert.deepEqual(await mesh.compact(), new Uint32Array(0));
    assert.equal(mesh[coordinates].length, 0);
  });

  test(`${D}D: precision`, async () => {
    const single = new Float32Array(await generate('uniform', 100, { seed: 6 }));
    const mesh = await triangulate(single);
    await mesh.insert(new Float32Array(D).fill(0.3));
    assert.ok(mesh[coordinates] instanceof Float32Array);
    await mesh.remove([3]);
    assert.ok(mesh[coordinates] instanceof Float32Array);
    await mesh.insert([new Array(D).fill(0.3)]);
    const points = Float64Array.of(
      ...single,
      ...new Float32Array(D).fill(0.3),
      ...new Array(D).fill(0.3),
    );
    // Not the same point.
    assert.equal(mesh.duplicateOf.at(-1), -1);
    await assertIsMeshOf(mesh, points, [3]);
  });

  test(`${D}D: after an error the mesh is what it was`, async () => {
    const points = await generate('uniform', 100, { seed: 9 });
    const mesh = await triangulate(points);
    await mesh.remove([5]);
    const before = [...arraysOf(mesh), mesh.stats];
    const bad = (promise, message) => rejects(promise, 'BAD_INPUT', message);
    await bad(mesh.remove([100]), /point 100 cannot be removed: there is no such point/);
    await bad(mesh.remove([3, 3]), /twice/);
    await bad(mesh.remove([5]), /removed before/);
    for (const index of [-1, 0.5, Number.NaN, 2 ** 32, '3', null, 3n])
      await bad(mesh.remove([index]), /is not the index of a point/);
    for (const indices of [3, undefined, null, 'all', {}])
      await bad(mesh.remove(indices), /indices must be an array/);
    await bad(mesh.insert(points.slice(1)), /multiple/);
    await bad(mesh.insert('points'));
    await bad(mesh.insert(points, 3), /options/);
    await bad(mesh.compact(3), /options/);
    const holed = points.slice(0, 3 * D);
    holed[D * 2] = Number.POSITIVE_INFINITY;
    await assert.rejects(mesh.insert(holed), { code: 'NOT_FINITE', index: 2 });
    await assert.rejects(mesh.insert(holed, { transfer: true }), (error) => {
      assert.equal(error.code, 'NOT_FINITE');
      assert.equal(error.points.length, 3 * D);
      return true;
    });
    assert.ok([...arraysOf(mesh), mesh.stats].every((value, i) => value === before[i]));

    // One change at a time: the next one goes on from its result.
    const first = mesh.insert(points.slice(0, D));
    await bad(mesh.remove([1]), /being updated/);
    await first;
    assert.equal(mesh.duplicateOf[100], 0);

    // Arrays that are broken, or not there any more.
    const broken = await triangulate(points);
    broken[simplices].fill(4_000_000_000);
    await broken.insert(points.slice(0, D));
    assert.equal(broken.stats.update.restarted, 'broken');
    structuredClone(0, { transfer: [broken[coordinates].buffer] });
    await bad(broken.remove([1]), /detached/);
  });

  test(`${D}D: a change can be aborted, and reports its progress`, async () => {
    const points = await generate('uniform', 20_000, { seed: 11 });
    const mesh = await triangulate(points.slice(0, 19_580 * D));
    const before = arraysOf(mesh);
    const start = (options) => mesh.insert(points.slice(19_580 * D), options);
    assert.deepEqual(await abortOf(start), { code: 'ABORTED', atOnce: true });
    await rejects(mesh.remove([1], { signal: AbortSignal.abort() }), 'ABORTED');
    assert.ok(arraysOf(mesh).every((array, i) => array === before[i]));
    const reports = [];
    await start({ onProgress: (report) => reports.push(report) });
    assert.equal(mesh.stats.update.restarted, null);
    assert.equal(reports.at(-1).fraction, 1);
    await assertIsMeshOf(mesh, points);
  });

  test(`${D}D: meshes of synchronous functions and of the calling thread`, async () => {
    const points = await generate('uniform', 200, { seed: 13 });
    const mesh = (await blocking())(points.slice(0, 199 * D));
    await mesh.insert(points.slice(199 * D));
    await assertIsMeshOf(mesh, points);

    const triangulator = await createTriangulator({ backend: 'cpu', worker: false });
    const here = await triangulator[`delaunay${D}d`](points);
    await here.remove([17]);
    await assertIsMeshOf(here, points, [17]);
    assert.equal(here.stats.thread, 'caller');
    triangulator.dispose();
    await rejects(here.insert(points), 'DISPOSED');
  });
}

test('a change needs what the run was asked for, and gives the same', async () => {
  const points = await gdel.generate('uniform', 100, { seed: 1 });
  const bare = await delaunay3d(points, { outputs: ['neighbors'] });
  await rejects(bare.insert(points), 'BAD_INPUT', /'duplicateOf'/);
  const mesh = await delaunay3d(points, { outputs: ['neighbors', 'duplicateOf'] });
  await mesh.remove([5]);
  assert.equal(mesh.hull.length, 0);
  assert.equal(mesh.neighbors.length, mesh.tetrahedra.length);
});
