// `mesh.ballComplex`: the alpha complex of balls.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { abortOf } from './abort.mjs';
import { dimensionsOf, rejectsOf } from './dimensions.mjs';
import { canonical, randomFrom } from './moving.mjs';
import { importFrom, project } from './package.mjs';

const gdel = await importFrom(project());
const { delaunay2d, delaunay3d } = gdel;

const DIMENSIONS = dimensionsOf(gdel);
const rejects = rejectsOf(gdel);

/** The names of the faces in a result, and how many vertices they have in so many dimensions. */
const facesOf = (D) => [
  ['facets', 'singularFacets', D],
  ['edges', 'singularEdges', 2],
  ['vertices', 'singularVertices', 1],
];

/** Returns the rows of an array, each one sorted and as text. */
const rowsOf = (array, width) =>
  Array.from({ length: array.length / width }, (_, i) =>
    [...array.subarray(width * i, width * (i + 1))].sort((a, b) => a - b).join(),
  );

/** Returns all faces of so many vertices of a simplex. */
function facesIn(simplex, count) {
  if (count === 0) return [[]];
  return [...simplex].flatMap((v, i) =>
    facesIn([...simplex].slice(i + 1), count - 1).map((face) => [v, ...face]),
  );
}

const keyOf = (face) => [...face].sort((a, b) => a - b).join();

/** Returns the number of the component of each item, by the lowest one in it. */
function joined(count, pairs) {
  const roots = Array.from({ length: count }, (_, i) => i);
  const find = (i) => (roots[i] === i ? i : (roots[i] = find(roots[i])));
  for (const [a, b] of pairs) {
    const [r, s] = [find(a), find(b)];
    roots[Math.max(r, s)] = Math.min(r, s);
  }
  return roots.map((_, i) => find(i));
}

for (const [key, { triangulate, generate, arrays }] of Object.entries(DIMENSIONS)) {
  const D = Number(key);
  const [simplices] = arrays;

  /** Checks how the faces of a complex hang together. */
  function checkFaces(mesh, found) {
    const corners = (t) => mesh[simplices].subarray((D + 1) * t, (D + 1) * (t + 1));
    let larger = [...found.solid].map((t) => [...corners(t)]);
    for (const [name, singular, width] of facesOf(D)) {
      // In 2D, facets are edges.
      if (width === 2 && D === 2 && name === 'edges') {
        assert.deepEqual(rowsOf(found.edges, 2), rowsOf(found.facets, 2).sort(byNumbers));
        assert.deepEqual(
          rowsOf(found.singularEdges, 2),
          rowsOf(found.singularFacets, 2).sort(byNumbers),
        );
        continue;
      }
      const parts = new Set(rowsOf(found[name], width));
      assert.equal(parts.size, found[name].length / width, name);
      const below = new Set(larger.flatMap((face) => facesIn(face, width).map(keyOf)));
      assert.ok([...below].every((face) => parts.has(face)));
      const lone = [...parts].filter((face) => !below.has(face)).sort();
      assert.deepEqual(rowsOf(found[singular], width).sort(), lone, singular);
      larger = [...parts].map((face) => face.split(',').map(Number));
    }
    const ends = Array.from({ length: found.edges.length / 2 }, (_, e) =>
      found.edges.subarray(2 * e, 2 * e + 2),
    );
    assert.ok(ends.every(([a, b]) => a < b));
    const points = mesh.duplicateOf.length;
    const roots = joined(points, ends);
    const firsts = [...new Set(Array.from(found.vertices, (v) => roots[v]))];
    const isPart = new Set(found.vertices);
    const expected = roots.map((root, i) => (isPart.has(i) ? firsts.indexOf(root) : -1));
    assert.deepEqual([...found.componentOf], expected);
    assert.equal(found.components, firsts.length);
  }

  const distance = (points, i, j) =>
    Math.hypot(...Array.from({ length: D }, (_, k) => points[D * i + k] - points[D * j + k]));

  function byNumbers(a, b) {
    const [v, w] = [a.split(',').map(Number), b.split(',').map(Number)];
    return v[0] - w[0] || v[1] - w[1];
  }

  test(`${D}D: balls of a grid that touch exactly`, async () => {
    const length = 6 ** D;
    const grid = Array.from({ length }, (_, i) =>
      Array.from({ length: D }, (_, axis) => Math.floor(i / 6 ** axis) % 6),
    );
    const radii = new Array(length).fill(0.5);
    const mesh = await triangulate(grid, { radii });
    assert.equal(mesh.weights, null);
    const found = await mesh.ballComplex({ radii });
    const lattice = D * 5 * 6 ** (D - 1);
    assert.equal(found.edges.length, 2 * lattice);
    for (let e = 0; e < found.edges.length; e += 2) {
      const [p, q] = [grid[found.edges[e]], grid[found.edges[e + 1]]];
      assert.equal(Math.hypot(...p.map((x, axis) => x - q[axis])), 1);
    }
    assert.deepEqual(found.singularEdges, found.edges);
    assert.equal(found.facets.length, D === 2 ? 2 * lattice : 0);
    assert.deepEqual([found.solid.length, found.surface.length], [0, 0]);
    assert.deepEqual([found.vertices.length, found.singularVertices.length], [length, 0]);
    assert.deepEqual([found.components, found.alpha], [1, 0]);
    assert.ok(found.componentOf.every((c) => c === 0));
    assert.deepEqual(
      [found.edges, found.componentOf, found.solid].map((array) => array.constructor),
      [Uint32Array, Int32Array, Uint32Array],
    );

    // The next smaller double.
    for (const smaller of [
      { weights: new Float64Array(length).fill(0.25 - 2 ** -55) },
      { radii: new Float64Array(length).fill(0.5 - 2 ** -54) },
    ]) {
      const apart = await mesh.ballComplex(smaller);
      assert.deepEqual([apart.edges.length, apart.facets.length], [0, 0]);
      assert.deepEqual(
        apart.singularVertices,
        Uint32Array.from(radii, (_, i) => i),
      );
      assert.equal(apart.components, length);
      assert.deepEqual([...apart.componentOf], [...grid.keys()]);
    }
    // Balls that meet in the middle of squares.
    const weights = new Array(length).fill(0.5);
    const squares = await mesh.ballComplex({ weights });
    const count = (D === 2 ? 1 : 3) * 5 * 5 * 6 ** (D - 2);
    assert.equal(squares.edges.length, 2 * (lattice + count));
    if (D === 2) assert.equal(squares.solid.length, 2 * count);
    else assert.equal(squares.singularFacets.length, 3 * 2 * count);
    const none = await mesh.ballComplex({ weights: weights.map((w) => -w) });
    assert.deepEqual([none.vertices.length, none.components], [0, 0]);
    assert.ok(none.componentOf.every((c) => c === -1));
  });

  test(`${D}D: it has the components of the union of the balls, also of hidden ones`, async () => {
    const points = await generate('uniform', 400, { seed: 21 });
    const random = randomFrom(22);
    const radii = Float64Array.from(
      { length: 400 },
      () => (D === 2 ? 0.04 : 0.09) * random() ** 2 + 1e-3,
    );
    // Some within others.
    for (let i = 0; i < 20; i++) {
      for (let axis = 0; axis < D; axis++) points[D * i + axis] = points[D * (i + 50) + axis];
      points[D * i] += radii[i + 50] / 4;
      radii[i] = radii[i + 50] / 8;
    }
    // And some that are none, which the others hide.
    const weights = radii.map((r, i) => (i < 20 || i >= 40 ? r * r : -0.5));
    const mesh = await triangulate(points, { weights });
    const isHidden = new Set(mesh.hidden);
    assert.ok(isHidden.has(20) && isHidden.has(30) && isHidden.size >= 10);
    const found = await mesh.ballComplex();
    assert.ok(found.edges.length > 0 && found.singularVertices.length > 0);
    checkFaces(mesh, found);
    assert.ok(mesh.hidden.every((i) => found.componentOf[i] === -1));
    assert.ok(found.componentOf.subarray(0, 20).every((c) => c === -1));
    const balls = [...weights.keys()].filter((i) => weights[i] >= 0);
    const pairs = balls.flatMap((i) =>
      balls.filter((j) => distance(points, i, j) <= radii[i] + radii[j]).map((j) => [i, j]),
    );
    const roots = joined(400, pairs);
    assert.equal(found.components, new Set(balls.map((i) => roots[i])).size);
    const numbers = new Map();
    for (const v of found.vertices) {
      const number = numbers.get(roots[v]) ?? found.componentOf[v];
      numbers.set(roots[v], number);
      assert.equal(found.componentOf[v], number);
    }
    assert.equal(numbers.size, found.components);

    // Those of the mesh are the default.
    for (const options of [{ weights }, { weights: [...weights], alpha: 0 }, { weights: null }])
      assert.deepEqual(await mesh.ballComplex(options), found);
    for (const alpha of [0.05, 0.1, Infinity]) {
      const grown = await mesh.ballComplex({ alpha });
      checkFaces(mesh, grown);
      assert.ok(grown.solid.length > found.solid.length && grown.alpha === alpha);
      const all = grown.solid.length * (D + 1) === mesh[simplices].length;
      assert.equal(all, alpha === Infinity);
    }
    // Other weights of the mesh are other balls.
    await mesh.updateWeights(weights.map((w) => 2 * w));
    const doubled = await mesh.ballComplex();
    checkFaces(mesh, doubled);
    assert.ok(doubled.edges.length > found.edges.length);
  });

  test(`${D}D: without weights it is the alpha shape, with equal radii, too`, async () => {
    const points = await generate('uniform', 600, { seed: 23 });
    const mesh = await triangulate(points);
    for (const alpha of [0, 1 / 32, 1 / 16, 1 / 8, Infinity]) {
      const shape = await mesh.alphaShape({ alpha, singular: true });
      const found = await mesh.ballComplex({ alpha });
      checkFaces(mesh, found);
      assert.deepEqual(found.solid, shape.solid);
      assert.equal(canonical(found.surface, D), canonical(shape.surface, D));
      for (const [, singular, width] of facesOf(D))
        assert.equal(canonical(found[singular], width), canonical(shape[singular], width));
      if (alpha === Infinity) continue;
      const radii = new Float32Array(600).fill(alpha);
      const equal = await triangulate(points, { radii });
      const { alpha: _, ...others } = found;
      const { alpha: zero, ...balls } = await equal.ballComplex({ radii });
      assert.equal(zero, 0);
      assert.deepEqual(balls, others);
      // The mesh has none.
      assert.equal((await equal.ballComplex()).edges.length, 0);
    }
  });

  test(`${D}D: duplicates, removed points, and arrays that stay what they are`, async () => {
    const points = await generate('uniform', 50, { seed: 24 });
    for (let axis = 0; axis < D; axis++) points[D * 7 + axis] = points[D * 3 + axis];
    const mesh = await triangulate(points);
    await mesh.remove([5]);
    const radii = new Float64Array(50).fill(0.3);
    const found = await mesh.ballComplex({ radii });
    assert.deepEqual(
      [3, 5, 7].map((i) => found.componentOf[i]),
      [0, -1, -1],
    );
    assert.ok(!found.vertices.includes(5) && found.vertices.length === 48);
    assert.ok(radii.length === 50 && radii.every((r) => r === 0.3));
    assert.equal(mesh[simplices].length > 0, true);
  });

  test(`${D}D: what is not possible`, async () => {
    const points = await generate('uniform', 30, { seed: 25 });
    const weights = Array.from({ length: 30 }, (_, i) => i / 1e4);
    const mesh = await triangulate(points, { weights });
    const bad = (options, message) => rejects(mesh.ballComplex(options), 'BAD_INPUT', message);
    for (const alpha of [-1, Number.NaN, '1', 'auto', null])
      await bad({ alpha }, /option alpha must be a number that is not negative/);
    await bad({ weights: [1, 2] }, /2 weights for 30 points/);
    await bad({ radii: [] }, /0 radii for 30 points/);
    await bad({ weights: weights.with(3, Number.NaN) }, /weight 3 is NaN/);
    await bad({ radii: weights.with(4, -2) }, /radius 4 is -2/);
    await bad({ radii: weights.with(5, Infinity) }, /radius 5 is Infinity/);
    await bad({ radii: weights.with(6, 1e200) }, /weight 6/);
    await bad({ weights: 'heavy' }, /an array of numbers/);
    await bad({ weights, radii: weights }, /left out beside/);
    await bad({ weights: weights.map((w) => w + 1) }, /other weights/);
    await bad({ weights: weights.fill(1) }, /other weights/);
    await bad([], /an object/);
    await bad({ signal: 'no' }, /AbortSignal/);
    const plain = await triangulate(points);
    const others = plain.ballComplex({ weights: mesh.weights });
    await rejects(others, 'BAD_INPUT', /other weights/);
    const stopped = { signal: AbortSignal.abort() };
    await rejects(mesh.ballComplex(stopped), 'ABORTED');
    assert.equal((await mesh.ballComplex({ weights: mesh.weights })).vertices.length > 0, true);
  });

  test(`${D}D: progress and aborts`, async () => {
    const points = await generate('uniform', 20_000, { seed: 26 });
    const mesh = await triangulate(points);
    const reports = [];
    await mesh.ballComplex({ alpha: 0.05, onProgress: (report) => reports.push(report) });
    assert.ok(reports.every(({ phase }) => phase === 'alpha'));
    assert.equal(reports.at(-1).fraction, 1);
    const start = (options) => mesh.ballComplex({ alpha: 0.05, ...options });
    assert.deepEqual(await abortOf(start), { code: 'ABORTED', atOnce: true });
    assert.ok((await start()).solid.length > 0);
  });
}

test('flat points have triangles or edges in the place of simplices', async () => {
  const square = [0, 5, 0, 2, 5, 0, 0, 5, 2, 2, 5, 2, 1, 5, 1];
  const flat = await delaunay3d(square, { radii: [1, 1, 1, 1, 0.5] });
  assert.equal(flat.dimension, 2);
  // The balls of the corners touch, and the middle one meets all of them, but not where they touch.
  const lone = await flat.ballComplex();
  assert.deepEqual([lone.edges.length, lone.facets.length, lone.components], [16, 0, 1]);
  assert.deepEqual(lone.singularEdges, lone.edges);
  const equal = await delaunay3d(square);
  const sides = await equal.ballComplex({ radii: [1, 1, 1, 1, 1] });
  assert.deepEqual([sides.edges.length, sides.facets.length], [16, 12]);
  assert.deepEqual(sides.singularFacets, sides.facets);
  assert.deepEqual([sides.solid.length, sides.surface.length], [0, 2 * 12]);

  const line = await delaunay3d([0, 0, 0, 3, 3, 3, 9, 9, 9]);
  const lengths = [3, 3 * (Math.sqrt(3) - 1) + 1e-9, 1];
  await rejects(line.ballComplex({ radii: lengths }), 'BAD_INPUT', /other weights/);
  const weighted = await delaunay3d([0, 0, 0, 3, 3, 3, 9, 9, 9], { radii: lengths });
  const found = await weighted.ballComplex();
  assert.deepEqual([[...found.singularEdges], found.facets.length], [[0, 1], 0]);
  assert.deepEqual([[...found.singularVertices], found.components], [[2], 2]);
  assert.deepEqual([...found.componentOf], [0, 0, 1]);

  const inPlane = await delaunay2d([0, 0, 2, 2, 9, 9], { weights: [2, 2, 3] });
  const { facets, surface, components } = await inPlane.ballComplex();
  assert.deepEqual([[...facets].sort(), surface.length, components], [[0, 1], 4, 2]);
  const one = await (await delaunay2d([[1, 1]])).ballComplex({ radii: [0] });
  assert.deepEqual([...one.singularVertices, one.components], [0, 1]);
  const none = await (await delaunay3d([])).ballComplex({ weights: [] });
  assert.deepEqual([none.vertices.length, none.componentOf.length, none.components], [0, 0, 0]);
});

test('rescaled points, and in 2D facets run as in their triangles', async () => {
  const points = [0, 0, 4, 0, 0, 1, 4, 1];
  const mesh = await delaunay2d(points, { rescale: [0.25, 1] });
  const touching = await mesh.ballComplex({ radii: new Array(4).fill(0.5) });
  assert.equal(touching.edges.length, 2 * 4);
  const all = await mesh.ballComplex({ alpha: Infinity });
  const halfedges = new Set();
  for (let e = 0; e < mesh.triangles.length; e++) {
    const next = e % 3 === 2 ? e - 2 : e + 1;
    if (mesh.halfedges[e] < 0 || e < mesh.halfedges[e])
      halfedges.add(`${mesh.triangles[e]},${mesh.triangles[next]}`);
  }
  for (let f = 0; f < all.facets.length; f += 2)
    assert.ok(halfedges.has(`${all.facets[f]},${all.facets[f + 1]}`));
  assert.equal(all.facets.length, 2 * halfedges.size);
  assert.equal(all.surface.length, 2 * 4);
});

test('constraints, and outputs that are missing', async () => {
  const constrained = await delaunay2d([0, 0, 1, 0, 0, 1], { edges: [0, 1] });
  await rejects(constrained.ballComplex(), 'BAD_INPUT', /constraints/);
  const bare = await delaunay3d([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1], { outputs: [] });
  await rejects(bare.ballComplex(), 'BAD_INPUT', /this needs 'neighbors'/);
});
