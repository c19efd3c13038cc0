// The interfaces of cdt2d, constrainautor and earcut.

import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { test } from 'node:test';
import { randomFrom } from './moving.mjs';
import { importFrom, project } from './package.mjs';

const folder = project();
const { Delaunator, GdelError } = await importFrom(folder);
const { cdt2d } = await importFrom(folder, 'cdt2d.js');
const { Constrainautor } = await importFrom(folder, 'constrainautor.js');
const { default: earcut, deviation, flatten, refine } = await importFrom(folder, 'earcut.js');

const throws = (run, code, message) =>
  assert.throws(run, (error) => {
    assert.ok(error instanceof GdelError, String(error));
    assert.equal(error.code, code, error.message);
    if (message) assert.match(error.message, message);
    return true;
  });

/** Returns twice the area of a triangle of points that are rows. */
const doubled = (points, [a, b, c]) =>
  (points[b][0] - points[a][0]) * (points[c][1] - points[a][1]) -
  (points[b][1] - points[a][1]) * (points[c][0] - points[a][0]);

/** Returns the area of triangles, each of which must be counter-clockwise. */
function areaOf(points, triangles) {
  let sum = 0;
  for (const triangle of triangles) {
    const area = doubled(points, triangle);
    assert.ok(area > 0, String(triangle));
    sum += area / 2;
  }
  return sum;
}

const threes = (flat) =>
  Array.from({ length: flat.length / 3 }, (_, t) => flat.slice(3 * t, 3 * t + 3));

/** Two diamonds, one in the other, and a point in the middle. */
const POINTS = [
  [-4, 0],
  [0, -4],
  [4, 0],
  [0, 4],
  [-1, 0],
  [0, -1],
  [1, 0],
  [0, 1],
  [0, 0],
];
const LOOPS = [0, 4].flatMap((first) =>
  [0, 1, 2, 3].map((i) => [first + i, first + ((i + 1) % 4)]),
);

test('nothing works before the module is loaded', async () => {
  throws(() => cdt2d(POINTS), 'NOT_LOADED', /loadConstraints/);
  throws(() => earcut([0, 0, 1, 0, 0, 1]), 'NOT_LOADED');
  await cdt2d.load();
  await Promise.all([earcut.load(), Constrainautor.load(), Delaunator.load()]);
});

test('cdt2d: triangles inside and outside', () => {
  const all = cdt2d(POINTS, LOOPS);
  assert.equal(all.length, 12);
  assert.equal(areaOf(POINTS, all), 32);
  const interior = cdt2d(POINTS, LOOPS, { exterior: false });
  assert.equal(areaOf(POINTS, interior), 30);
  const exterior = cdt2d(POINTS, LOOPS, { interior: false });
  assert.deepEqual(exterior, [
    [4, 5, 8],
    [4, 8, 7],
    [5, 6, 8],
    [6, 7, 8],
  ]);
  assert.deepEqual(cdt2d(POINTS, LOOPS, { interior: false, exterior: false }), []);
  for (const [a, b, c] of all) assert.ok(a < b && a < c);
  const hull = [
    [0, 3, -1],
    [1, 0, -1],
    [2, 1, -1],
    [3, 2, -1],
  ];
  const infinite = cdt2d(POINTS, LOOPS, { infinity: true });
  assert.deepEqual(infinite.slice(0, 12), all);
  assert.deepEqual(infinite.slice(12).sort(), hull);
  assert.deepEqual(cdt2d(POINTS, LOOPS, { exterior: false, infinity: true }), interior);
});

test('cdt2d: edges that are no loops, or that there are not', () => {
  const square = POINTS.slice(0, 4);
  assert.deepEqual(cdt2d(square, [[0, 2]]), [
    [0, 1, 2],
    [0, 2, 3],
  ]);
  assert.deepEqual(cdt2d(square, [[1, 3]]), [
    [0, 1, 3],
    [1, 2, 3],
  ]);
  assert.equal(cdt2d(square).length, 2);
  // The options may be the second argument; all is outside.
  assert.deepEqual(cdt2d(square, { exterior: false }), []);
  assert.equal(cdt2d(square, [[0, 2]], { interior: false }).length, 2);
  assert.deepEqual(cdt2d([]), []);
  assert.deepEqual(cdt2d([[1, 1]]), []);
  assert.deepEqual(cdt2d([[0, 0], [1, 1], [2, 2]], [[0, 2]]), []); // biome-ignore format: points
});

test('cdt2d: what it takes for granted', () => {
  // Points on edges, equal points, edges that overlap or are given twice.
  const points = [...POINTS, [0, 0], [-2, 0]];
  const triangles = cdt2d(points, [[0, 2], [2, 8], [9, 0], [0, 2], [4, 4]]); // biome-ignore format: edges
  assert.equal(areaOf(points, triangles), 32);
  assert.ok(!triangles.flat().includes(9) && triangles.flat().includes(10));
  throws(() => cdt2d(POINTS.slice(0, 4), [[0, 2], [1, 3]]), 'CROSSING_CONSTRAINTS'); // biome-ignore format: edges
  throws(() => cdt2d(POINTS, [[0, 99]]), 'BAD_INPUT', /99/);
  throws(() => cdt2d([[0, Number.NaN]]), 'NOT_FINITE');
});

test('constrainautor: edges of a triangulation of delaunator', () => {
  const points = [
    [150, 50],
    [50, 200],
    [150, 350],
    [250, 200],
  ];
  const del = Delaunator.from(points);
  const { triangles, halfedges } = del;
  const con = new Constrainautor(del);
  assert.equal(con.findEdge(0, 2), Infinity);
  const e = con.constrainOne(0, 2);
  assert.ok(del.triangles === triangles && del.halfedges === halfedges);
  assert.deepEqual([triangles[e], triangles[e % 3 === 2 ? e - 2 : e + 1]], [0, 2]);
  assert.ok(con.isConstrained(e) && con.isConstrained(halfedges[e]));
  assert.equal(con.constrainOne(2, 0), halfedges[e]);
  assert.ok(!con.isConstrained(halfedges.indexOf(-1)));
  halfedges.forEach((opposite, e) => {
    if (opposite !== -1) assert.equal(halfedges[opposite], e);
  });
  const hull = con.findEdge(0, 1);
  const back = con.findEdge(1, 0);
  assert.equal(hull, -back);
  assert.deepEqual([con.delaunify(true), con.untriangulatedPoints()], [con, []]);
  throws(() => con.constrainOne(1, 3), 'CROSSING_CONSTRAINTS');
  // An error changes nothing.
  assert.equal(con.findEdge(0, 2), e);
  throws(() => new Constrainautor({}), 'BAD_INPUT', /Delaunator output/);
});

test('constrainautor: all edges at once, through points, and between equal ones', () => {
  const random = randomFrom(11);
  const points = Array.from({ length: 200 }, () => [
    Math.floor(8 * random()),
    Math.floor(8 * random()),
  ]);
  const del = Delaunator.from(points);
  const edges = [];
  const index = new Map(points.map((point, i) => [String(point), i]));
  for (let y = 0; y < 8; y++)
    if (index.has(`0,${y}`) && index.has(`7,${y}`))
      edges.push([index.get(`0,${y}`), index.get(`7,${y}`)]);
  assert.ok(edges.length > 2);
  const con = new Constrainautor(del, edges);
  assert.equal(con.untriangulatedPoints().length, 200 - new Set(points.map(String)).size);
  // All points of these rows are joined to the next.
  for (const [a] of edges) {
    const [, y] = points[a];
    const row = points.flatMap(([x, v]) => (v === y ? [x] : []));
    const xs = [...new Set(row)].sort();
    for (let k = 1; k < xs.length; k++) {
      const edge = con.findEdge(index.get(`${xs[k - 1]},${y}`), index.get(`${xs[k]},${y}`));
      assert.ok(edge < Infinity && con.isConstrained(Math.abs(edge)));
    }
  }
  assert.equal(con.findEdge(...edges[1]), Infinity);
});

/** Triangulates a polygon of rings, and returns the triangles; checks the area and the orientation. */
function earcutOf(rings, area) {
  const { vertices, holes, dimensions } = flatten(rings);
  const triangles = earcut(vertices, holes, dimensions);
  const points = rings.flat();
  assert.equal(areaOf(points, threes(triangles)), area);
  if (area > 0) assert.ok(deviation(vertices, holes, dimensions, triangles) < 1e-15);
  return triangles;
}

const square = (x, y, side) => [[x, y], [x + side, y], [x + side, y + side], [x, y + side]]; // biome-ignore format: points

test('earcut: polygons with holes, in either orientation, closed or not', () => {
  const rings = [square(0, 0, 100), square(20, 20, 60)];
  assert.equal(earcutOf(rings, 6400).length, 3 * 8);
  earcutOf([square(0, 0, 100).reverse(), square(20, 20, 60)], 6400);
  earcutOf([[...square(0, 0, 100), [0, 0]], [...square(20, 20, 60), [20, 20]]], 6400); // biome-ignore format: rings
  const vertices = flatten([square(0, 0, 2).map(([x, y]) => [x, y, 7])]);
  assert.deepEqual(vertices, {
    vertices: [0, 0, 7, 2, 0, 7, 2, 2, 7, 0, 2, 7],
    holes: [],
    dimensions: 3,
  });
  const flat = earcut(vertices.vertices, null, 3);
  assert.deepEqual(new Set(flat), new Set([0, 1, 2, 3]));
  refine(flat, vertices.vertices, 3);
  assert.equal(flat.length, 6);
  // A hole of one vertex is a point to use.
  assert.ok(earcutOf([square(0, 0, 4), [[1, 2]]], 16).includes(4));
});

test('earcut: holes that touch, collinear and repeated vertices, nothing', () => {
  const outer = square(0, 0, 12);
  // Each other in a vertex, along a side, the outer ring in a vertex and along a side.
  earcutOf([outer, square(2, 2, 2), square(4, 4, 2)], 144 - 8);
  earcutOf([outer, square(2, 2, 2), square(4, 2, 2)], 144 - 8);
  earcutOf([outer, [[0, 6], [3, 5], [3, 7]]], 144 - 3); // biome-ignore format: rings
  earcutOf([outer, square(0, 4, 2)], 144 - 4);
  // One that fills all.
  earcutOf([outer, outer], 0);
  // A vertex of a hole on a side of another one.
  earcutOf([outer, square(2, 2, 4), [[6, 4], [8, 3], [8, 5]]], 144 - 16 - 2); // biome-ignore format: rings
  earcutOf([[[0, 0], [1, 0], [2, 0], [2, 0], [2, 2], [1, 2], [0, 2], [0, 1]]], 4); // biome-ignore format: rings
  // A spike, there and back.
  earcutOf([[[0, 0], [4, 0], [8, 0], [4, 0], [4, 4], [0, 4]]], 16); // biome-ignore format: rings
  for (const nothing of [[], [1, 2], [1, 2, 3, 4], [0, 0, 1, 1, 2, 2], [1, 1, 1, 1, 1, 1]])
    assert.deepEqual(earcut(nothing), []);
  assert.deepEqual(flatten([[]]), { vertices: [], holes: [], dimensions: 2 });
});

test('earcut: random stars with holes, and sides that cross', () => {
  const random = randomFrom(17);
  for (let round = 0; round < 50; round++) {
    const count = 3 + Math.floor(40 * random());
    const star = (low, high) =>
      Array.from({ length: count }, (_, i) => {
        const [angle, radius] = [(2 * Math.PI * i) / count, low + (high - low) * random()];
        return [radius * Math.cos(angle), radius * Math.sin(angle)];
      });
    const { vertices, holes } = flatten([star(20, 50), star(1, 9)]);
    const triangles = earcut(vertices, holes);
    assert.equal(triangles.length, 3 * 2 * count);
    assert.ok(deviation(vertices, holes, 2, triangles) < 1e-12);
  }
  throws(() => earcut([0, 0, 2, 2, 2, 0, 0, 2]), 'CROSSING_CONSTRAINTS', /0–1 and 2–3/);
});

test('with require, and by their names', () => {
  const require = createRequire(join(folder, 'index.js'));
  for (const name of ['cdt2d', 'constrainautor', 'earcut']) {
    const module = require(`gdel-wasm/${name}`);
    assert.equal(typeof module.default, 'function');
    assert.equal(typeof module.default.load, 'function');
  }
  assert.equal(require('gdel-wasm/earcut').default.name, 'earcut');
});
