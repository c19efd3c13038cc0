// Weighted points: the option `weights` or `radii`, and `mesh.hidden`.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { dimensionsOf, rejectsOf } from './dimensions.mjs';
import { canonical, randomFrom } from './moving.mjs';
import { importFrom, project } from './package.mjs';

const gdel = await importFrom(project());
const { createTriangulator, delaunay2d, delaunay3d, delaunay3dSync, load3d } = gdel;

const DIMENSIONS = dimensionsOf(gdel);
const rejects = rejectsOf(gdel);

for (const [key, { triangulate, generate, verify, arrays }] of Object.entries(DIMENSIONS)) {
  const D = Number(key);
  const [simplices] = arrays;
  const inOrder = (mesh) => canonical(mesh[simplices], D + 1);

  test(`${D}D: weights hide points, and the mesh is proven`, async () => {
    const points = await generate('uniform', 2000, { seed: 3 });
    const random = randomFrom(7);
    const weights = Float64Array.from({ length: 2000 }, () => 0.02 * random());
    const mesh = await triangulate(points, { weights });
    assert.ok(mesh.hidden.length > 100 && mesh.hidden.length < 2000, `${mesh.hidden.length}`);
    assert.ok(mesh.hidden.every((v, i, all) => i === 0 || all[i - 1] < v));
    assert.equal(new Set(mesh[simplices]).size + mesh.hidden.length, 2000);
    assert.deepEqual(mesh.weights, weights);
    assert.equal(mesh.stats.backend, 'cpu');
    assert.match(mesh.stats.fallback, /weighted/);
    const report = await verify(points, mesh);
    assert.ok(
      report.passed,
      JSON.stringify(report.checks.filter(({ state }) => state === 'failed')),
    );
    const { weights: _, ...others } = mesh;
    assert.ok(!(await verify(points, { ...others, weights: undefined })).passed);

    // Radii are the roots of weights, and only differences of these count.
    const radii = Float32Array.from(weights, Math.sqrt);
    const squares = Array.from(radii, (r) => r * r + 1);
    const [a, b] = [
      await triangulate(points, { radii }),
      await triangulate(points, { weights: squares }),
    ];
    assert.equal(inOrder(a), inOrder(b));
    assert.equal((await triangulate(points, { radii, backend: 'cpu' })).stats.fallback, null);
  });

  test(`${D}D: equal weights change nothing`, async () => {
    const points = await generate('uniform', 500, { seed: 4 });
    const [mesh, plain] = [
      await triangulate(points, { weights: new Array(500).fill(-3) }),
      await triangulate(points),
    ];
    assert.equal(inOrder(mesh), inOrder(plain));
    assert.deepEqual([mesh.hidden, mesh.weights], [new Uint32Array(0), null]);
    assert.deepEqual([plain.hidden, plain.weights], [new Uint32Array(0), null]);
    assert.equal((await mesh.nearest(points)).length, 500);
  });

  test(`${D}D: power diagrams and power distances`, async () => {
    const points = await generate('uniform', 300, { seed: 6 });
    const random = randomFrom(8);
    const weights = Float64Array.from({ length: 300 }, () => 0.03 * random());
    const mesh = await triangulate(points, { weights });
    assert.ok(mesh.hidden.length > 10);
    const power = (query, i) => {
      let squared = -weights[i];
      for (let axis = 0; axis < D; axis++) squared += (query[axis] - points[D * i + axis]) ** 2;
      return squared;
    };
    const queries = await generate('uniform', 200, { seed: 7 });
    const isHidden = new Set(mesh.hidden);
    const nearest = await mesh.nearest(queries);
    const { [simplices]: containing } = await mesh.locate(queries);
    nearest.forEach((found, q) => {
      const query = queries.subarray(D * q, D * q + D);
      const distances = Array.from(weights, (_, i) =>
        isHidden.has(i) ? Infinity : power(query, i),
      );
      assert.equal(found, distances.indexOf(Math.min(...distances)));
      assert.ok(containing[q] < mesh[simplices].length / (D + 1));
    });

    const clip = [...Array(D).fill(0), ...Array(D).fill(1)];
    const { volumes, neighbors, cells } = await mesh.voronoi({ clip });
    assert.ok(Math.abs(volumes.reduce((sum, volume) => sum + volume) - 1) < 1e-12);
    for (const i of mesh.hidden) assert.deepEqual([volumes[i], cells[i + 1] - cells[i]], [0, 0]);
    assert.ok(neighbors.every((i) => !isHidden.has(i)));
    const shares = new Float64Array(300);
    const places = await generate('uniform', 20_000, { seed: 9 });
    for (const i of await mesh.nearest(places)) shares[i] += 1 / 20_000;
    shares.forEach((share, i) => {
      assert.ok(Math.abs(share - volumes[i]) < 0.003, `${i}: ${share} ${volumes[i]}`);
    });
    const { vertexSimplex } = await mesh.topology();
    assert.ok(mesh.hidden.every((i) => vertexSimplex[i] === -1));
  });

  test(`${D}D: files have the weights, and which points are hidden`, async () => {
    const points = await generate('uniform', 100, { seed: 15 });
    const random = randomFrom(16);
    const weights = Float64Array.from({ length: 100 }, () => 0.05 * random());
    const mesh = await triangulate(points, { weights });
    assert.ok(mesh.hidden.length > 0);
    const text = (bytes) => Buffer.from(bytes).toString('latin1');
    const filesOf = async (mesh) => {
      const { node } = await (D === 3 ? mesh.toTetGen() : mesh.toTriangle());
      return [text(node), text(await mesh.toVTU()), text(await mesh.toNPZ())];
    };
    const [node, vtu, npz] = await filesOf(mesh);
    const rows = node.split('\n');
    assert.match(rows[0], /^100 [23] 1 0 # index x y( z)? weight$/);
    const written = rows.slice(1, 101).map((row) => Number(row.split(' ').at(-1)));
    assert.deepEqual(written, [...weights]);
    assert.match(
      vtu,
      /<PointData>.*"Float64" Name="weight".*"UInt8" Name="hidden".*<\/PointData>/s,
    );
    // Each array after its length.
    const data = vtu.slice(vtu.indexOf('_', vtu.indexOf('<AppendedData')) + 1);
    const flags = Array.from(data.slice(16 + 800, 16 + 900), (flag) => flag.charCodeAt(0));
    assert.deepEqual(
      flags.flatMap((flag, i) => (flag ? [i] : [])),
      [...mesh.hidden],
    );
    assert.match(npz, /weight\.npy.*'<f8'.*\(100,\).*hidden\.npy.*'<u4'/s);
    assert.ok(npz.includes(text(new Uint8Array(mesh.hidden.slice().buffer))));
    for (const file of await filesOf(await triangulate(points))) {
      assert.doesNotMatch(file, /weight|hidden/);
    }
  });

  test(`${D}D: weights that change`, async () => {
    const points = await generate('uniform', 500, { seed: 13 });
    const random = randomFrom(14);
    const mesh = await triangulate(points);
    for (const size of [0.05, 0, 0.01, 0.1]) {
      const weights = Float64Array.from({ length: 500 }, () => size * random());
      await mesh.updateWeights(weights);
      const scratch = await triangulate(points, { weights });
      assert.equal(inOrder(mesh), inOrder(scratch));
      assert.deepEqual([mesh.hidden, mesh.weights], [scratch.hidden, scratch.weights]);
      assert.equal((mesh.points ?? mesh.coords).length, D * 500);
      assert.equal(mesh.stats.thread, scratch.stats.thread);
    }
    assert.ok(mesh.hidden.length > 0);
    // Points that move keep their weights, or get others.
    for (const change of [{}, { weights: 0.1 }, { radii: 0.2 }, { weights: 0 }, { radii: 0.1 }]) {
      const own = (mesh.points ?? mesh.coords).map((x) => x + 0.01 * random());
      const options = Object.fromEntries(
        Object.entries(change).map(([name, size]) => [
          name,
          Float64Array.from({ length: 500 }, () => size * random()),
        ]),
      );
      const kept = mesh.weights;
      await mesh.update(own, options);
      const scratch = await triangulate(
        own,
        Object.keys(change).length > 0 ? options : { weights: kept },
      );
      assert.equal(inOrder(mesh), inOrder(scratch));
      assert.deepEqual([mesh.hidden, mesh.weights], [scratch.hidden, scratch.weights]);
      assert.deepEqual(mesh.points ?? mesh.coords, own);
    }
    await rejects(
      mesh.update([[...Array(D).fill(0)]]),
      'BAD_INPUT',
      /the mesh has 500 points, not 1/,
    );
    const before = inOrder(mesh);
    await rejects(mesh.updateWeights([1, 2]), 'BAD_INPUT', /2 weights for 500 points/);
    await rejects(mesh.updateWeights(), 'BAD_INPUT', /0 weights/);
    assert.equal(inOrder(mesh), before);
  });

  test(`${D}D: transport finds the weights for given volumes`, async () => {
    const points = await generate('uniform', 400, { seed: 11 });
    const random = randomFrom(12);
    const masses = Float64Array.from({ length: 400 }, () => 100 ** random());
    const mesh = await triangulate(points);
    const clip = [...Array(D).fill(-0.5), ...Array(D).fill(1)];
    const phases = new Set();
    const found = await mesh.transport({
      masses,
      normalize: true,
      clip,
      onProgress: ({ phase }) => phases.add(phase),
    });
    assert.deepEqual([...phases], ['transport']);
    assert.ok(found.error <= 1e-3 && found.steps > 0);
    const weighted = await triangulate(points, { weights: found.weights });
    const { volumes } = await weighted.voronoi({ clip });
    const share = 1.5 ** D / masses.reduce((sum, mass) => sum + mass);
    volumes.forEach((volume, i) => {
      assert.ok(Math.abs(volume - share * masses[i]) <= 1.001e-3 * share * masses[i], `${i}`);
      assert.ok(Math.abs(volume - found.volumes[i]) <= 1e-9, `${i}`);
    });
    // Equal masses; the weights of a mesh do not count.
    const [own, others] = [await mesh.transport({ clip }), await weighted.transport({ clip })];
    assert.deepEqual(own.weights, others.weights);

    const controller = new AbortController();
    const onProgress = () => controller.abort();
    const aborted = mesh.transport({
      clip,
      tolerance: 1e-9,
      signal: controller.signal,
      onProgress,
    });
    await rejects(aborted, 'ABORTED');
    assert.deepEqual((await mesh.transport({ clip })).weights, own.weights);

    await rejects(mesh.transport({ masses, clip }), 'BAD_INPUT', /sum of the masses/);
    await rejects(mesh.transport({ masses: [1] }), 'BAD_INPUT', /400 numbers/);
    const negative = masses.map((mass, i) => (i === 7 ? -1 : mass));
    await rejects(mesh.transport({ masses: negative }), 'BAD_INPUT', /mass 7/);
    await rejects(mesh.transport({ clip: 'none' }), 'BAD_INPUT', /without bounds/);
    await rejects(mesh.transport({ tolerance: 0 }), 'BAD_INPUT', /between 0 and 1/);
    await mesh.remove([3]);
    await rejects(mesh.transport(), 'BAD_INPUT', /compact/);
  });

  test(`${D}D: what needs a Delaunay triangulation says so`, async () => {
    const points = await generate('uniform', 100, { seed: 5 });
    const mesh = await triangulate(points, {
      weights: Array.from({ length: 100 }, (_, i) => i / 1e4),
    });
    const before = inOrder(mesh);
    const needs = /weighted points/;
    const values = new Float64Array(100);
    await rejects(mesh.interpolate(values, points), 'BAD_INPUT', needs);
    await rejects(mesh.contours(values, [1]), 'BAD_INPUT', needs);
    await rejects(mesh.alphaShape(), 'BAD_INPUT', needs);
    await rejects(mesh.spanningTree(), 'BAD_INPUT', needs);
    await rejects(mesh.surface(), 'BAD_INPUT', needs);
    await rejects(mesh.insert(points), 'BAD_INPUT', needs);
    await rejects(mesh.remove([0]), 'BAD_INPUT', needs);
    if (D === 2) assert.throws(() => mesh.find(0, 0), needs);
    assert.equal(inOrder(mesh), before);
    // Files are written all the same.
    assert.ok((await mesh.toVTU()).length > 0);
    const plain = await triangulate(points);
    await rejects(plain.update(points, { weights: [1] }), 'BAD_INPUT', /1 weights for 100 points/);
    await rejects(plain.insert(points, { weights: [1] }), 'BAD_INPUT', /triangulate anew/);
  });

  test(`${D}D: bad weights`, async () => {
    const points = await generate('uniform', 3, { seed: 1 });
    const bad = (options, message) => rejects(triangulate(points, options), 'BAD_INPUT', message);
    await bad({ weights: [1, 2] }, /2 weights for 3 points/);
    await bad({ weights: [1, Number.NaN, 2] }, /weight 1 is NaN/);
    await bad({ weights: [1, 2, Infinity] }, /weight 2 is Infinity/);
    await bad({ radii: [1, -2, 3] }, /radius 1 is -2/);
    await bad({ radii: [1e200, 1, 3] }, /weight 0/);
    await bad({ weights: 'heavy' }, /an array of numbers/);
    await bad({ weights: [1, 2, 3], radii: [1, 2, 3] }, /radii/);
    await bad({ weights: [1, 2, 3], rescale: true }, /rescale/);
  });
}

test('in the calling thread, and not at once', async () => {
  const triangulator = await createTriangulator({ backend: 'cpu', worker: false });
  const points = [0, 0, 4, 0, 0, 4, 1, 1];
  const mesh = await triangulator.delaunay2d(points, { radii: [3, 3, 3, 1] });
  assert.deepEqual([...mesh.hidden], [3]);
  triangulator.dispose();
  await load3d();
  assert.throws(
    () => delaunay3dSync([0, 0, 0], { weights: [1] }),
    /do not have the option weights/,
  );
});

test('the heaviest of equal points stands for the others', async () => {
  const points = [0, 0, 4, 0, 0, 4, 1, 1, 1, 1, 1, 1];
  const mesh = await delaunay2d(points, { weights: [0, 0, 0, 1, 3, 3] });
  assert.deepEqual([...mesh.duplicateOf], [-1, -1, -1, 4, -1, 4]);
  const flat = await delaunay3d([0, 0, 0, 1, 0, 0, 0, 1, 0], { weights: [0, 1, 2] });
  assert.deepEqual([flat.dimension, flat.hidden.length], [2, 0]);
  assert.ok((await flat.toPLY()).length > 0);
});
