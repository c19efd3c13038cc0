// What is derived from meshes, in the installed package: location, nearest vertices, interpolation,
// Voronoi cells, alpha shapes, spanning trees.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { abortOf } from './abort.mjs';
import { importFrom, project } from './package.mjs';

const folder = project();
const { delaunay2d, delaunay3d, GdelError, generate, generate2d, SpanningTree, Voronoi2 } =
  await importFrom(folder);

test('the examples of the documentation run', () => {
  const installed = join(folder, 'node_modules/gdel-wasm/docs/answers.md');
  const blocks = [...readFileSync(installed, 'utf8').matchAll(/^```js\n([^`]*)^```$/gm)];
  assert.ok(blocks.length >= 6);
  const check = "import assert from 'node:assert';\nconsole.assert = assert.ok;\n";
  writeFileSync(join(folder, 'answers.mjs'), check + blocks.map(([, code]) => code).join(''));
  execFileSync(process.execPath, [...process.execArgv, 'answers.mjs'], { cwd: folder });
});

/** A cube with its middle. */
const CUBE = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [i & 1, (i >> 1) & 1, i >> 2]);
CUBE.push([0.5, 0.5, 0.5]);
/** A square with its middle. */
const SQUARE = [
  [0, 0],
  [2, 0],
  [0, 2],
  [2, 2],
  [1, 1],
];

const cube = await delaunay3d(CUBE);
const square = await delaunay2d(SQUARE);

/** The promise is rejected with a GdelError of this code, whose message says this. */
async function rejects(promise, code, message) {
  await assert.rejects(promise, (error) => {
    assert.ok(error instanceof GdelError, String(error));
    assert.equal(error.code, code, error.message);
    assert.match(error.message, message);
    return true;
  });
}

const sum = (numbers) => numbers.reduce((a, b) => a + b, 0);
const near = (a, b, error = 1e-12) => assert.ok(Math.abs(a - b) <= error, `${a}, not ${b}`);
const sorted = (numbers) => [...numbers].sort((a, b) => a - b);

/** For each simplex, whether a point is on the inner side of, or on, every facet; by floating point. */
function contains(coordinates, simplex, query) {
  const D = query.length;
  const corners = Array.from(simplex, (v) => coordinates.slice(D * v, D * v + D));
  const side = (replaced) => {
    const [a, ...others] = corners.map((corner, k) => (k === replaced ? query : corner));
    const [u, v, w] = others.map((p) => p.map((x, axis) => x - a[axis]));
    if (D === 2) return u[0] * v[1] - u[1] * v[0];
    return (
      u[0] * (v[1] * w[2] - v[2] * w[1]) +
      u[1] * (v[2] * w[0] - v[0] * w[2]) +
      u[2] * (v[0] * w[1] - v[1] * w[0])
    );
  };
  const whole = Math.sign(side(-1));
  return corners.every((_, k) => side(k) * whole >= -1e-12);
}

for (const [D, triangulate, generated] of [
  [2, delaunay2d, generate2d],
  [3, delaunay3d, generate],
]) {
  test(`${D}D: locations and nearest vertices are those of brute force`, async () => {
    const points = await generated('uniform', 300, { seed: 1 });
    const mesh = await triangulate(points);
    const queries = (await generated('uniform', 200, { seed: 2 })).map((x) => 1.2 * x - 0.1);
    const located = await mesh.locate(queries);
    const [simplices, facets] =
      D === 2 ? [located.triangles, located.halfedges] : [located.tetrahedra, located.facets];
    assert.ok(simplices instanceof Int32Array && facets instanceof Int32Array);
    const nearest = await mesh.nearest(queries);
    const coordinates = Array.from(points);
    const vertices = D === 2 ? mesh.triangles : mesh.tetrahedra;
    const across = D === 2 ? mesh.halfedges : mesh.neighbors;
    let outside = 0;
    for (let q = 0; q < simplices.length; q++) {
      const query = Array.from(queries.slice(D * q, D * q + D));
      const t = simplices[q];
      if (t >= 0) {
        const simplex = vertices.slice((D + 1) * t, (D + 1) * (t + 1));
        assert.ok(contains(coordinates, simplex, query));
        assert.equal(facets[q], -1);
      } else {
        outside++;
        assert.equal(across[facets[q]], -1, 'the facet is on the hull');
      }
      const distance = (v) => sum(query.map((x, axis) => (x - points[D * v + axis]) ** 2));
      const all = Array.from({ length: 300 }, (_, v) => distance(v));
      assert.equal(nearest[q], all.indexOf(Math.min(...all)));
      if (D === 2) {
        assert.equal(mesh.find(...query), nearest[q]);
        assert.equal(mesh.find(...query, 299), nearest[q]);
      }
    }
    assert.ok(outside > 5 && outside < 195);
  });

  test(`${D}D: the k nearest vertices are those of brute force`, async () => {
    const points = await generated('uniform', 50, { seed: 1 });
    const mesh = await triangulate(points);
    const queries = await generated('uniform', 20, { seed: 2 });
    for (const k of [1, 3, 60]) {
      const nearest = await mesh.nearest(queries, { k });
      assert.equal(nearest.length, 20 * k);
      for (let q = 0; q < 20; q++) {
        const distance = (v) =>
          sum(Array.from({ length: D }, (_, k) => (queries[D * q + k] - points[D * v + k]) ** 2));
        const all = Array.from({ length: 50 }, (_, v) => v);
        all.sort((v, w) => distance(v) - distance(w) || v - w);
        const expected = Array.from({ length: k }, (_, i) => all[i] ?? -1);
        assert.deepEqual(Array.from(nearest.subarray(k * q, k * q + k)), expected);
      }
    }
    for (const k of [0, 1.5, '2', 2 ** 40])
      await assert.rejects(mesh.nearest(queries, { k }), { code: 'BAD_INPUT' });
  });

  test(`${D}D: edges, facets and neighbours are those of the simplices`, async () => {
    const N = D + 1;
    const points = await generated('uniform', 200, { seed: 3 });
    points.copyWithin(D * 199, 0, D);
    const mesh = await triangulate(points);
    const simplices = D === 2 ? mesh.triangles : mesh.tetrahedra;
    const topology = await mesh.topology();
    const facesOf = (list, size) => {
      const faces = [];
      for (let i = 0; i < list.length; i += size)
        faces.push(`${Array.from(list.subarray(i, i + size)).sort((a, b) => a - b)}`);
      return faces.sort();
    };
    const edges = new Set();
    const facets = new Set();
    const stars = Array.from({ length: 200 }, () => []);
    for (let t = 0; t < simplices.length / N; t++) {
      const simplex = simplices.subarray(N * t, N * t + N);
      for (const v of simplex) {
        stars[v].push(t);
        facets.add(`${Array.from(simplex.filter((w) => w !== v)).sort((a, b) => a - b)}`);
        for (const w of simplex) if (v < w) edges.add(`${[v, w]}`);
      }
    }
    assert.deepEqual(facesOf(topology.edges, 2), [...edges].sort());
    assert.deepEqual(facesOf(topology.facets, D), [...facets].sort());
    for (let v = 0; v < 200; v++) {
      const [start, end] = topology.neighborOffsets.subarray(v, v + 2);
      const expected = new Set(
        stars[v].flatMap((t) => Array.from(simplices.slice(N * t, N * t + N))),
      );
      expected.delete(v);
      assert.deepEqual(
        Array.from(topology.neighbors.subarray(start, end)),
        [...expected].sort((a, b) => a - b),
      );
      assert.equal(topology.vertexSimplex[v], stars[v][0] ?? -1);
    }
    assert.equal(topology.vertexSimplex[199], -1, 'a duplicate');
  });

  test(`${D}D: the geometry of simplices`, async () => {
    const N = D + 1;
    const points = await generated('uniform', 200, { seed: 4 });
    const mesh = await triangulate(points);
    const simplices = D === 2 ? mesh.triangles : mesh.tetrahedra;
    const geometry = await mesh.geometry();
    const { circumcenters, circumradii, volumes, radiusRatios, angles } = geometry;
    for (let t = 0; t < simplices.length / N; t++) {
      for (const v of simplices.subarray(N * t, N * t + N)) {
        const offsets = Array.from(
          { length: D },
          (_, k) => points[D * v + k] - circumcenters[D * t + k],
        );
        near(Math.hypot(...offsets), circumradii[t], 1e-9 * (1 + circumradii[t]));
      }
      assert.ok(radiusRatios[t] > 0 && radiusRatios[t] <= 1 + 1e-9);
    }
    const { volumes: cells } = await mesh.voronoi({ clip: 'hull' });
    near(sum(Array.from(volumes)), sum(Array.from(cells)), 1e-9);
    const perSimplex = D === 2 ? 3 : 6;
    assert.equal(angles.length, (perSimplex * simplices.length) / N);
    assert.ok(angles.every((angle) => angle > 0 && angle < Math.PI));
    if (D === 2) near(sum(Array.from(angles)), (Math.PI * simplices.length) / 3, 1e-9);
  });

  test(`${D}D: linear functions are interpolated by all methods`, async () => {
    const points = await generated('uniform', 500, { seed: 3 });
    const mesh = await triangulate(points);
    const queries = await generated('uniform', 100, { seed: 4 });
    const linear = (all, i) =>
      1 + sum(Array.from({ length: D }, (_, k) => (k + 2) * all[D * i + k]));
    const values = Float64Array.from({ length: 500 }, (_, i) => linear(points, i));
    for (const method of ['linear', 'laplace', 'sibson', undefined]) {
      const { values: found, outside } = await mesh.interpolate(values, queries, { method });
      assert.ok(found instanceof Float64Array && found.length === 100);
      const inside = found.filter((value) => !Number.isNaN(value)).length;
      assert.ok(inside > 50 && inside < 100);
      assert.equal(outside, 100 - inside);
      found.forEach((value, i) => {
        if (!Number.isNaN(value)) near(value, linear(queries, i), 1e-10);
      });
    }
  });

  test(`${D}D: contours of a coordinate are where it has the level`, async () => {
    const points = await generated('uniform', 300, { seed: 6 });
    const mesh = await triangulate(points);
    const values = Float64Array.from({ length: 300 }, (_, i) => points[D * i + 1]);
    const [half, none] = await mesh.contours(values, [0.5, 7]);
    assert.equal(half.level, 0.5);
    assert.ok(half.vertices.length > 0 && none.vertices.length === 0);
    for (let i = 1; i < half.vertices.length; i += D) near(half.vertices[i], 0.5, 1e-12);
    // A level below all values: closed along the hull.
    const [all] = await mesh.contours(values, [-1], { closed: true });
    const at = (v) => all.vertices.subarray(D * v, D * v + D);
    if (D === 2) {
      assert.deepEqual([...all.lineOffsets], [0, all.lines.length]);
      assert.equal(all.lines[0], all.lines.at(-1));
      assert.equal(all.lines.length - 1, mesh.hull.length);
      assert.equal(half.lineOffsets.length, 2);
    } else {
      assert.equal(all.triangles.length, mesh.hull.length);
      const six = (_, t) => {
        const [a, b, c] = [0, 1, 2].map((k) => at(all.triangles[3 * t + k]));
        return (
          a[0] * (b[1] * c[2] - b[2] * c[1]) +
          a[1] * (b[2] * c[0] - b[0] * c[2]) +
          a[2] * (b[0] * c[1] - b[1] * c[0])
        );
      };
      const volume = sum(Array.from({ length: all.triangles.length / 3 }, six)) / 6;
      near(volume, sum((await mesh.voronoi({ clip: 'hull' })).volumes), 1e-9);
    }
    await rejects(mesh.contours([1], [0]), 'BAD_INPUT', /the values/);
    await rejects(mesh.contours(values, 3), 'BAD_INPUT', /the levels/);
    await rejects(mesh.contours(values, [3], { closed: 1 }), 'BAD_INPUT', /closed/);
  });

  test(`${D}D: clipped Voronoi cells fill the box and the hull`, async () => {
    const points = await generated('uniform', 400, { seed: 5 });
    const mesh = await triangulate(points);
    const box = [...Array(D).fill(-1), ...Array(D).fill(2)];
    near(sum((await mesh.voronoi({ clip: box })).volumes), 3 ** D, 1e-9);
    const smallest = Array.from({ length: D }, (_, axis) => {
      const all = Array.from({ length: 400 }, (_, i) => points[D * i + axis]);
      return Math.max(...all) - Math.min(...all);
    });
    const extent = smallest.reduce((a, b) => a * b);
    near(sum((await mesh.voronoi({ clip: 'box' })).volumes), extent, 1e-9);
    assert.ok(sum((await mesh.voronoi({ clip: 'hull' })).volumes) < extent);
    const { volumes, cells, neighbors, areas, facets, facetOffsets, vertices, centroids } =
      await mesh.voronoi();
    const unbounded = volumes.filter((volume) => volume === Infinity).length;
    assert.ok(unbounded > 5 && unbounded < 200);
    assert.equal(cells.length, 401);
    assert.equal(centroids.length, D * 400);
    assert.equal(cells[400], neighbors.length);
    assert.equal(areas.length, neighbors.length);
    assert.equal(facetOffsets.length, neighbors.length + 1);
    assert.equal(facetOffsets.at(-1), facets.length);
    // Both points of a facet are at the same distance from its vertices.
    for (let i = 0; i < 400; i++) {
      for (let f = cells[i]; f < cells[i + 1]; f++) {
        const corners = facets.slice(facetOffsets[f], facetOffsets[f + 1]);
        const distance = (p, v) =>
          Math.hypot(
            ...Array.from({ length: D }, (_, k) => points[D * p + k] - vertices[D * v + k]),
          );
        for (const v of corners) {
          const own = distance(i, v);
          near(own, distance(neighbors[f], v), 1e-9 * Math.max(1, own));
        }
      }
    }
  });

  test(`${D}D: alpha shapes`, async () => {
    const points = await generated('uniform', 500, { seed: 6 });
    const mesh = await triangulate(points);
    const shape = await mesh.alphaShape({ criticalValues: true });
    assert.equal(shape.components, 1);
    assert.equal(new Set(shape.solid).size, shape.solid.length);
    // All points belong to the solid.
    const simplices = D === 2 ? mesh.triangles : mesh.tetrahedra;
    const used = new Set();
    for (const t of shape.solid) {
      for (const v of simplices.slice((D + 1) * t, (D + 1) * (t + 1))) used.add(v);
    }
    assert.equal(used.size, 500);
    assert.equal(shape.componentOf.filter((c) => c === 0).length, shape.solid.length);
    // The solid is a filter of the radii.
    const same = await mesh.alphaShape({ alpha: shape.alpha });
    assert.deepEqual(same.solid, shape.solid);
    assert.equal(same.criticalValues.length, 0);
    const filtered = shape.radii.filter((radius) => radius <= shape.alpha * (1 + 1e-9)).length;
    assert.equal(filtered, shape.solid.length);
    assert.ok(shape.criticalValues.every((value, i, all) => i === 0 || all[i - 1] < value));
    // Closed: each edge, or in 2D each vertex, as often in one direction as in the other.
    const balance = new Map();
    const add = (key, by) => balance.set(key, (balance.get(key) ?? 0) + by);
    for (let f = 0; f < shape.surface.length; f += D) {
      const corners = shape.surface.slice(f, f + D);
      if (D === 2) {
        add(corners[0], 1);
        add(corners[1], -1);
      } else {
        corners.forEach((a, k) => {
          const b = corners[(k + 1) % 3];
          add(`${Math.min(a, b)} ${Math.max(a, b)}`, a < b ? 1 : -1);
        });
      }
    }
    assert.ok(balance.size > 0 && [...balance.values()].every((value) => value === 0));
    assert.equal((await mesh.alphaShape({ alpha: 0 })).solid.length, 0);
    assert.equal(same.singularFacets.length + same.singularVertices.length, 0);
    const all = await mesh.alphaShape({ alpha: Infinity });
    assert.equal(all.solid.length * (D + 1), simplices.length);
  });

  test(`${D}D: singular faces of alpha shapes`, async () => {
    // A simplex, then in 3D a triangle, an edge and a vertex, far from each other.
    const unit = (axis, at) =>
      Array.from({ length: D }, (_, k) => (k === 0 ? at : 0) + (k === axis ? 1 : 0));
    const corners = (count, at) => Array.from({ length: count }, (_, i) => unit(i - 1, at));
    const lists = [D + 1, ...(D === 3 ? [3] : []), 2, 1].map((count, i) => corners(count, 9 * i));
    // They do not lie in a line.
    const points = lists.flatMap((list, i) =>
      list.map((p) => p.map((x, k) => x + (k ? i * i : 0))),
    );
    const mesh = await triangulate(points);
    const shape = await mesh.alphaShape({ alpha: 1, singular: true });
    assert.equal(shape.solid.length, 1);
    const facets = D === 3 ? [4, 5, 6] : [3, 4];
    assert.deepEqual([...shape.singularFacets].sort(), facets);
    assert.deepEqual([...shape.singularEdges], D === 3 ? [7, 8] : [...shape.singularFacets]);
    assert.deepEqual([...shape.singularVertices], [points.length - 1]);
    const points0 = await mesh.alphaShape({ alpha: 0, singular: true });
    assert.deepEqual([...points0.singularVertices], [...points.keys()]);
    assert.equal((await mesh.alphaShape({ alpha: 1 })).singularVertices.length, 0);
  });

  test(`${D}D: spanning trees are those of Prim's algorithm`, async () => {
    const points = await generated('uniform', 200, { seed: 7 });
    const tree = await (await triangulate(points)).spanningTree();
    assert.ok(tree instanceof SpanningTree);
    const distance = (p, q) =>
      Math.hypot(...Array.from({ length: D }, (_, k) => points[D * p + k] - points[D * q + k]));
    let total = 0;
    const open = new Map(Array.from({ length: 199 }, (_, i) => [i + 1, distance(0, i + 1)]));
    while (open.size > 0) {
      const [next, length] = [...open].reduce((a, b) => (a[1] < b[1] ? a : b));
      total += length;
      open.delete(next);
      for (const [v, old] of open) open.set(v, Math.min(old, distance(next, v)));
    }
    near(sum(tree.lengths), total, 1e-9);
    assert.equal(tree.edges.length, 2 * 199);
    for (const count of [1, 2, 10, 200, 1000]) {
      assert.equal(new Set(tree.clusters(count)).size, Math.min(count, 200));
    }
    assert.deepEqual(tree.clustersWithin(tree.lengths[180]), tree.clusters(19));
    assert.throws(() => tree.clusters(0), { code: 'BAD_INPUT' });
    assert.throws(() => tree.clustersWithin(Number.NaN), { code: 'BAD_INPUT' });
  });
}

test('ties and duplicates', async () => {
  const mesh = await delaunay2d([...SQUARE, [0, 0]]);
  const tree = await mesh.spanningTree();
  assert.deepEqual([...tree.edges.slice(0, 2)], [0, 5], 'a duplicate and its vertex');
  assert.equal(tree.lengths[0], 0);
  const clusters = tree.clusters(5);
  assert.equal(clusters[5], clusters[0]);
  assert.equal(mesh.find(1, 0), 0, 'as near to points 0, 1 and 4');
  assert.deepEqual([...(await mesh.nearest([[1, 0]]))], [0]);
  assert.equal(mesh.find(0, 0, 5), 0);
  assert.deepEqual(sorted(mesh.neighbors(4)), [0, 1, 2, 3]);
  assert.deepEqual(sorted(mesh.neighbors(0)), [1, 2, 4]);
  assert.deepEqual(mesh.neighbors(5), []);
  const voronoi = await mesh.voronoi({ clip: 'box' });
  assert.equal(voronoi.volumes[5], 0);
  assert.equal(voronoi.cellPolygon(5), null);
  const locations = await cube.locate([[0.5, 0.5, 0.5]]);
  assert.ok(
    cube.tetrahedra
      .slice(4 * locations.tetrahedra[0])
      .slice(0, 4)
      .includes(8),
  );
});

/** Distances that floating point rounds to the same number, or in the wrong order. */
test('find compares distances exactly', async () => {
  const tiny = 2 ** -60;
  const mesh = await delaunay2d([
    [1, 1],
    [-1, 1 - tiny],
    [-1, -1],
    [1, -1 - 2 ** -52],
  ]);
  for (const [x, y] of [
    [0, 0],
    [tiny, 0],
    [-tiny, tiny],
    [0, 2 ** -53],
    [1e-300, -1e-300],
    [1e300, 1e300],
    [-1e200, 1],
  ]) {
    const [expected] = await mesh.nearest([[x, y]]);
    for (let start = 0; start < 4; start++) assert.equal(mesh.find(x, y, start), expected);
  }
});

test('flat points have answers in their own dimension', async () => {
  for (const [points, volumes] of [
    [[], [0, 0, 0, 0]],
    [[[1, 2, 3]], [0, 0, 0, 1]],
    [
      [
        [0, 0, 0],
        [1, 1, 1],
        [2, 2, 2],
      ],
      [Infinity, 8, Math.sqrt(12), 1],
    ],
    [CUBE.slice(0, 4), [Infinity, 1, 1, 1]],
  ]) {
    const mesh = await delaunay3d(points);
    const located = await mesh.locate([[0, 0, 0]]);
    assert.deepEqual([located.tetrahedra[0], located.facets[0], located.outside], [-1, -1, 1]);
    // The last of them, or none.
    const last = await mesh.nearest([[9, 9, 9]]);
    assert.deepEqual([...last], [points.length - 1]);
    const values = Float64Array.from(points, (_, i) => i + 1);
    for (const method of ['linear', 'laplace', 'sibson']) {
      const found = await mesh.interpolate(values, points, { method });
      assert.deepEqual([[...found.values], found.outside], [[...values], 0]);
      const beside = await mesh.interpolate(values, [[0, 0, 9]], { method, outside: -5 });
      assert.deepEqual([[...beside.values], beside.outside], [[-5], 1]);
    }
    for (const [i, clip] of ['none', 'box', 'hull', [0, 0, 0, 1, 1, 1]].entries()) {
      const total = sum((await mesh.voronoi({ clip })).volumes);
      assert.ok(total === volumes[i] || Math.abs(total - volumes[i]) < 1e-12, `${clip}: ${total}`);
    }
    assert.equal((await mesh.spanningTree()).edges.length, 2 * Math.max(0, points.length - 1));
  }
  assert.equal((await cube.locate([])).tetrahedra.length, 0);
  assert.equal((await square.nearest(new Float64Array(0))).length, 0);
});

test('bad input is a typed error that says what is wrong', async () => {
  const queries = [
    [0, 0, 0],
    [1, Number.NaN, 0],
  ];
  await rejects(cube.locate(queries), 'NOT_FINITE', /query 1: the y coordinate is NaN/);
  await assert.rejects(cube.nearest(queries), { index: 1 });
  await rejects(square.locate([[0, Infinity]]), 'NOT_FINITE', /query 0: the y coordinate is inf/);
  await rejects(cube.locate([[0, 0]]), 'BAD_INPUT', /3 numbers/);
  await rejects(square.locate(new Float64Array(3)), 'BAD_INPUT', /multiple of 2/);
  await rejects(cube.interpolate([1, 2], [[0, 0, 0]]), 'BAD_INPUT', /9 numbers, one per point/);
  await rejects(
    square.interpolate([1, 2, '3', 4, 5], [[0, 0]]),
    'BAD_INPUT',
    /number 2 of the values/,
  );
  await rejects(
    cube.interpolate(new Float64Array(9), [[0, 0, 0]], { method: 'cubic' }),
    'BAD_INPUT',
    /linear, laplace, sibson/,
  );
  await rejects(cube.voronoi({ clip: 'sphere' }), 'BAD_INPUT', /none, box, hull, or 6 numbers/);
  await rejects(square.voronoi({ clip: [0, 0, 1] }), 'BAD_INPUT', /4 numbers/);
  await rejects(square.voronoi({ clip: [0, 1, 1, 1] }), 'BAD_INPUT', /along the y axis/);
  await rejects(cube.voronoi({ clip: [0, 0, 0, Infinity, 1, 1] }), 'BAD_INPUT', /along the x axis/);
  await rejects(cube.alphaShape({ alpha: -1 }), 'BAD_INPUT', /not negative/);
  await rejects(cube.alphaShape({ alpha: Number.NaN }), 'BAD_INPUT', /not negative/);
  await rejects(cube.alphaShape({ components: 0 }), 'BAD_INPUT', /an integer from 1 to/);
  await rejects(cube.alphaShape({ singular: 1 }), 'BAD_INPUT', /singular/);
  const bare = await delaunay3d(CUBE, { outputs: [] });
  await rejects(bare.locate([[0, 0, 0]]), 'BAD_INPUT', /this needs 'neighbors'/);
  assert.throws(() => square.find(0, 0, 5), { code: 'BAD_INPUT' });
  assert.equal(square.find(Number.NaN, 0), -1);
  assert.throws(() => square.neighbors(-1), { code: 'BAD_INPUT' });
  for (const [array, i, entry] of [
    ['tetrahedra', 3, 9],
    ['neighbors', 0, 999],
    ['duplicateOf', 1, 9],
  ]) {
    const tampered = await delaunay3d(CUBE);
    tampered[array][i] = entry;
    for (const ask of [
      () => tampered.locate([[0, 0, 0]]),
      () => tampered.nearest([[0, 0, 0]]),
      () => tampered.interpolate(new Float64Array(9), [[0, 0, 0]]),
      () => tampered.voronoi(),
      () => tampered.alphaShape(),
      () => tampered.ballComplex(),
      () => tampered.surface(),
      () => tampered.spanningTree(),
      () => tampered.topology(),
      () => tampered.geometry(),
    ])
      await rejects(ask(), 'BAD_INPUT', /exist/);
  }
  // The worker has survived all that.
  assert.equal((await cube.nearest([[0.9, 0.9, 0.9]]))[0], 7);
});

test('progress, aborts, and what the callback throws', async () => {
  const points = await generate('uniform', 20_000, { seed: 8 });
  const mesh = await delaunay3d(points);
  const starts = {
    locate: (options) => mesh.locate(points, options),
    nearest: (options) => mesh.nearest(points, options),
    interpolate: (options) => mesh.interpolate(new Float64Array(20_000), points, options),
    voronoi: (options) => mesh.voronoi(options),
    alpha: (options) => mesh.alphaShape(options),
    surface: (options) => mesh.surface(options),
    tree: (options) => mesh.spanningTree(options),
  };
  for (const [phase, start] of Object.entries(starts)) {
    const reports = [];
    await start({ onProgress: (progress) => reports.push(progress) });
    assert.ok(reports.every((report) => report.phase === phase));
    assert.equal(reports.at(-1).fraction, 1);
    assert.ok(reports.every(({ fraction }, i) => i === 0 || reports[i - 1].fraction <= fraction));
    assert.deepEqual(await abortOf(start), { code: 'ABORTED', atOnce: true }, phase);
    const thrown = new Error('mine');
    const throwing = () => {
      throw thrown;
    };
    await assert.rejects(start({ onProgress: throwing }), (error) => error === thrown);
    await assert.rejects(start({ signal: AbortSignal.abort() }), { code: 'ABORTED' });
  }
  assert.equal((await mesh.nearest(points.slice(0, 3)))[0], 0);
});

// What the documentation of d3-delaunay says of `find`, Voronoi cells and clipping.

test('find: the search starts at the given point, and collinear points are no exception', async () => {
  const lines = await delaunay2d([0, 1, 2, 3, 4].map((i) => [i, 2 * i]));
  assert.equal(lines.find(1.2, 1.9), 1);
  assert.equal(lines.find(9, 9, 2), 4);
  assert.deepEqual(sorted(lines.neighbors(2)), [1, 3]);
  assert.deepEqual(lines.neighbors(0), [1]);
  const one = await delaunay2d([[5, 5]]);
  assert.equal(one.find(0, 0), 0);
  const two = await delaunay2d([
    [0, 0],
    [1, 0],
    [1, 0],
  ]);
  assert.equal(two.find(-1, 0), 0);
  assert.equal(two.find(2, 0), 1);
  assert.equal((await delaunay2d([])).find(0, 0), -1);
});

test('cells are closed convex polygons within the bounds', async () => {
  const voronoi = await square.voronoi({ clip: [-1, -1, 3, 3] });
  assert.ok(voronoi instanceof Voronoi2);
  const polygons = [...voronoi.cellPolygons()];
  assert.deepEqual(
    polygons.map(({ index }) => index),
    [0, 1, 2, 3, 4],
  );
  // The cell in the middle stands on a corner.
  const middle = polygons[4];
  assert.equal(middle.length, 5);
  assert.deepEqual(middle[0], middle[4]);
  assert.deepEqual(middle.slice(1).map(String).sort(), ['0,1', '1,0', '1,2', '2,1']);
  for (const polygon of polygons) {
    // All turn in the same direction as the triangles.
    for (let k = 0; k + 2 < polygon.length; k++) {
      const [[ax, ay], [bx, by], [cx, cy]] = polygon.slice(k, k + 3);
      assert.ok((bx - ax) * (cy - ay) - (by - ay) * (cx - ax) < 0, JSON.stringify(polygon));
    }
  }
  near(sum(voronoi.volumes), 16);
  assert.deepEqual([...voronoi.circumcenters].length, 2 * 4);
});

test('cells outside the bounds are empty, and neighbours are clipped', async () => {
  const mesh = await delaunay2d([
    [0, 0],
    [4, 0],
    [0, 4],
    [4, 4],
    [2, 9],
  ]);
  const voronoi = await mesh.voronoi({ clip: [-1, -1, 1.5, 1.5] });
  assert.deepEqual(
    [...voronoi.cellPolygons()].map(({ index }) => index),
    [0],
  );
  assert.equal(voronoi.cellPolygon(4), null);
  assert.deepEqual([...voronoi.neighborsOf(0)], []);
  const wide = await mesh.voronoi({ clip: [-1, -1, 5, 5] });
  assert.deepEqual(sorted(wide.neighborsOf(0)), [1, 2]);
});

test('contains says which point is nearest, whatever the bounds are', async () => {
  const voronoi = await square.voronoi({ clip: [0, 0, 0.1, 0.1] });
  assert.ok(voronoi.contains(4, 1.2, 1.1) && !voronoi.contains(0, 1.2, 1.1));
  assert.ok(voronoi.contains(3, 99, 99));
  assert.ok(!voronoi.contains(0, Number.NaN, 0));
  const mesh = await delaunay2d([
    [0, 0],
    [1, 0],
    [0, 1],
    [1, 0],
  ]);
  const coincident = await mesh.voronoi({ clip: [-1, -1, 2, 2] });
  assert.ok(!coincident.contains(3, 1, 0) && coincident.contains(1, 1, 0));
  assert.equal(coincident.cellPolygon(3), null);
});

test('without bounds, cells on the hull are unbounded and have no polygon', async () => {
  const voronoi = await square.voronoi();
  assert.equal(voronoi.cellPolygon(0), null);
  assert.equal(voronoi.cellPolygon(4).length, 5);
  assert.deepEqual(sorted(voronoi.neighborsOf(4)), [0, 1, 2, 3]);
  assert.throws(() => voronoi.cellPolygon(5), { code: 'BAD_INPUT' });
});

test('collinear points have stripes as cells, and one point has the box', async () => {
  const clip = [-1, -1, 5, 3];
  const one = await (await delaunay2d([[0, 0]])).voronoi({ clip });
  assert.deepEqual(one.cellPolygon(0), [
    [-1, 3],
    [5, 3],
    [5, -1],
    [-1, -1],
    [-1, 3],
  ]);
  assert.deepEqual([...one.centroids], [2, 1]);
  const points = [
    [3, 0],
    [0, 0],
    [1, 0],
    [1, 0],
  ];
  const voronoi = await (await delaunay2d(points)).voronoi({ clip });
  assert.deepEqual([...voronoi.volumes], [12, 6, 6, 0]);
  assert.deepEqual(voronoi.cellPolygon(3), null);
  assert.deepEqual(sorted(voronoi.neighborsOf(2)), [0, 1]);
  assert.deepEqual([...voronoi.neighborsOf(1)], [2]);
  assert.deepEqual(voronoi.cellPolygon(2).slice(1).map(String).sort(), [
    '0.5,-1',
    '0.5,3',
    '2,-1',
    '2,3',
  ]);
  assert.ok(voronoi.contains(0, 2.5, 99));
  // Far from the box, a stripe can be empty.
  const far = await (await delaunay2d([...points, [100, 0]])).voronoi({ clip });
  assert.equal(far.volumes[4], 0);
  assert.equal(far.cellPolygon(4), null);
  near(sum(far.volumes), 24);
});

test('queries on the border that rounding has put outside are inside, unless they are to be exact', async () => {
  const mesh = await delaunay2d([
    [0, 0],
    [0.3, 0.1],
    [0, 1],
  ]);
  const queries = [
    [0.03, 0.01],
    [0, -1],
  ];
  const located = await mesh.locate(queries);
  assert.deepEqual([[...located.triangles], located.outside], [[0, -1], 1]);
  assert.equal((await mesh.locate(queries, { exact: true })).outside, 2);
  const values = [1, 3, 5];
  for (const method of ['linear', 'laplace', 'sibson']) {
    const { values: found, outside } = await mesh.interpolate(values, queries, { method });
    assert.ok(Math.abs(found[0] - 1.2) < 1e-14 && Number.isNaN(found[1]) && outside === 1);
    const at = async (options) =>
      (await mesh.interpolate(values, queries, { method, ...options })).values[1];
    assert.equal(await at({ outside: -9 }), -9);
    assert.equal(await at({ outside: 'nearest' }), 1);
    // The function is linear.
    near(await at({ outside: 'linear' }), -3, 1e-12);
  }
  await rejects(mesh.interpolate(values, queries, { outside: 'far' }), 'BAD_INPUT', /a number/);
  await rejects(mesh.interpolate(values, queries, { exact: 1 }), 'BAD_INPUT', /true or false/);
});

test('equal points have the first value, the mean, or an error', async () => {
  const mesh = await delaunay2d([
    [0, 0],
    [1, 0],
    [0, 1],
    [0, 0],
  ]);
  const at = async (duplicates) =>
    (await mesh.interpolate([1, 1, 1, 9], [[0, 0]], { duplicates })).values[0];
  assert.deepEqual([await at(undefined), await at('first'), await at('mean')], [1, 1, 5]);
  await rejects(at('error'), 'BAD_INPUT', /points 0 and 3 are equal/);
  await rejects(at('last'), 'BAD_INPUT', /first, mean, error/);
  const tree = await mesh.spanningTree();
  assert.deepEqual(
    [[...tree.edges], [...tree.lengths]],
    [
      [0, 3, 0, 1, 0, 2],
      [0, 1, 1],
    ],
  );
  assert.deepEqual([...tree.clusters(3)], [0, 1, 2, 0]);
});

test('rescaled meshes scale their queries', async () => {
  const points = Array.from({ length: 400 }, (_, i) => [
    1000 * ((i * 0.754877666) % 1),
    (i * 0.569840290998) % 1,
  ]);
  const value = ([x, t]) => Math.sin(x / 160) * Math.cos(6 * t);
  const queries = points.slice(0, 100).map(([x, t]) => [100 + 0.8 * x, 0.15 + 0.7 * t]);
  const error = async (rescale) => {
    const mesh = await delaunay2d(points, { rescale });
    const { values, outside } = await mesh.interpolate(points.map(value), queries);
    assert.equal(outside, 0);
    assert.equal(mesh.find(...points[7]), 7);
    assert.deepEqual([...(await mesh.nearest(points.slice(7, 9)))], [7, 8]);
    const squares = queries.map((q, i) => (values[i] - value(q)) ** 2);
    return [Math.sqrt(sum(squares) / squares.length), mesh];
  };
  const [[asIs, plain], [all, mesh], [given]] = [
    await error(false),
    await error(true),
    await error([0.001, 1]),
  ];
  assert.ok(asIs > 5 * all && all < 0.05 && given < 0.05, `${asIs} ${all} ${given}`);
  assert.equal(plain.factors, null);
  assert.ok(mesh.factors[0] < 0.0011 && mesh.factors[1] > 1);
  const [index] = await mesh.insert([[500, 0.5]]);
  assert.deepEqual([index, mesh.find(500, 0.5)], [400, 400]);
  await rejects(delaunay2d(points, { rescale: [1, 0] }), 'BAD_INPUT', /2 positive numbers/);
});

test('values on a grid, weights for many columns, gradients and smooth interpolation', async () => {
  const xs = Array.from(
    { length: 200 },
    (_, i) => Math.abs(Math.sin(i * 12.9898) * 43758.5453) % 1,
  );
  const points = Float64Array.from(xs.flatMap((x, i) => [x, xs[(i + 67) % 200]]));
  const plane = (x, y) => 3 * x - 2 * y + 1;
  const values = Array.from({ length: 200 }, (_, i) => plane(points[2 * i], points[2 * i + 1]));
  const mesh = await delaunay2d(points);
  const grid = { width: 7, height: 5, bounds: [0.2, 0.3, 0.9, 0.8] };
  const centers = Array.from({ length: 35 }, (_, i) => [
    0.2 + 0.1 * ((i % 7) + 0.5),
    0.3 + 0.1 * (Math.floor(i / 7) + 0.5),
  ]);
  for (const method of ['linear', 'laplace', 'sibson', 'sibson-c1', 'clough-tocher']) {
    const found = await mesh.interpolateGrid(values, { ...grid, method });
    const single = await mesh.interpolate(values, centers, { method });
    assert.equal(found.outside, single.outside);
    centers.forEach(([x, y], i) => {
      near(found.values[i], single.values[i], 1e-12);
      if (!Number.isNaN(found.values[i])) near(found.values[i], plane(x, y), 1e-9);
    });
  }
  const gradients = await mesh.gradients(values);
  for (let i = 0; i < 200; i++) {
    near(gradients[2 * i], 3, 1e-9);
    near(gradients[2 * i + 1], -2, 1e-9);
  }
  const table = await mesh.interpolationWeights([...centers, [9, 9]], { method: 'sibson' });
  assert.equal(table.offsets.length, 37);
  assert.equal(table.offsets[36], table.offsets[35], 'no weights outside');
  assert.equal(table.outside, 1);
  const { values: expected } = await mesh.interpolate(values, centers, { method: 'sibson' });
  for (let q = 0; q < 35; q++) {
    let total = 0;
    for (let k = table.offsets[q]; k < table.offsets[q + 1]; k++)
      total += table.weights[k] * values[table.points[k]];
    near(total, expected[q], 1e-12);
  }
  const all = await mesh.interpolateGrid(values, { width: 1, height: 1 });
  assert.equal(all.values.length, 1);
  const scaled = await delaunay2d(points, { rescale: [1, 1000] });
  near((await scaled.gradients(values))[1], -2, 1e-9);
  near((await scaled.interpolateGrid(values, grid)).values[17], expected[17], 1e-9);
  const bad = { code: 'BAD_INPUT' };
  await assert.rejects(mesh.interpolateGrid(values, { width: 0, height: 5 }), bad);
  await assert.rejects(mesh.interpolateGrid(values, { width: 5 }), bad);
  await assert.rejects(mesh.interpolateGrid(values, { ...grid, bounds: [0, 0, 1] }), bad);
  await assert.rejects(mesh.interpolateGrid(values, { ...grid, bounds: [0, 0, 0, 1] }), bad);
  await assert.rejects(mesh.interpolateGrid(values, { width: 2 ** 20, height: 2 ** 20 }), bad);
  await assert.rejects(mesh.interpolationWeights(centers, { method: 'sibson-c1' }), bad);
  await assert.rejects(
    cube.interpolate(new Float64Array(9), [[0, 0, 0]], { method: 'clough-tocher' }),
    bad,
  );
  const solid = await cube.interpolateGrid(new Float64Array(9).fill(4), {
    width: 2,
    height: 3,
    depth: 4,
  });
  assert.equal(solid.values.length, 24);
  for (const value of solid.values) near(value, 4);
});

test('points in a plane have a hull and alpha shapes of their own dimension', async () => {
  const flat = await delaunay3d(SQUARE.map(([x, y]) => [x, 5, y]));
  assert.deepEqual([flat.dimension, flat.hull.length], [2, 0]);
  const all = await flat.alphaShape({ alpha: Infinity });
  assert.deepEqual([all.surface.length, all.solid.length, all.components], [3 * 8, 0, 1]);
  near((await flat.alphaShape()).alpha, 1);
  const lone = await flat.alphaShape({ alpha: 1, singular: true });
  assert.deepEqual([lone.singularFacets.length, lone.singularVertices.length], [3 * 4, 0]);
  const faces = new TextDecoder().decode(await flat.toOBJ()).match(/^f /gm);
  assert.equal(faces.length, 8);
  assert.ok((await flat.toSTL()).length > 80);
  const line = await delaunay3d([0, 1, 3].map((x) => [x, 0, 0]));
  const segments = await line.alphaShape({ alpha: 0.5, singular: true });
  assert.deepEqual([[...segments.singularEdges], segments.components], [[0, 1], 1]);
  assert.deepEqual([...segments.singularVertices], [2]);
  const inPlane = await (await delaunay2d([0, 1, 3].map((x) => [x, 0]))).alphaShape();
  assert.deepEqual([inPlane.surface.length, inPlane.components], [2 * 4, 1]);
  near(inPlane.alpha, 1);
});
