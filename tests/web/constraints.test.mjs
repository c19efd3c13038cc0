// Constraints in 2D: the options `edges`, `rings`, `polygons`, `fill` and `crossings`.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { rejectsOf } from './dimensions.mjs';
import { canonical, randomFrom } from './moving.mjs';
import { importFrom, project } from './package.mjs';

const gdel = await importFrom(project());
const { createTriangulator, delaunay2d, delaunay2dSync, delaunay3d } = gdel;
const { generate2d, load2d, loadConstraints, readShapes, verify2d } = gdel;
const rejects = rejectsOf(gdel);

/** A square with a square hole, and a point in the hole. */
const POINTS = [0, 0, 9, 0, 9, 9, 0, 9, 3, 3, 6, 3, 6, 6, 3, 6, 5, 5];
const RINGS = [
  [0, 1, 2, 3],
  [4, 5, 6, 7, 4],
];
const HOUSE = [
  [0, 0],
  [4, 0],
  [4, 3],
  [2, 5],
  [0, 3],
  [0, 0],
];

/** Returns the area of triangles, and checks the orientation of each. */
function areaOf(mesh, triangles = mesh.insideTriangles()) {
  let sum = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => {
      const v = triangles[t + k];
      return [mesh.coords[2 * v], mesh.coords[2 * v + 1]];
    });
    const doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    assert.ok(doubled < 0);
    sum -= doubled / 2;
  }
  return sum;
}

/** Verifies a mesh, and that the verifier looks at its constraints. */
async function prove(mesh) {
  const report = await verify2d(mesh.coords, mesh);
  const failed = report.checks.filter(({ outcome }) => outcome !== 'passed');
  assert.ok(report.passed, JSON.stringify(failed));
  const { edges, segments } = mesh.constraints;
  if (edges.length === 0) return;
  const lacking = { ...mesh, constraints: { edges: edges.slice(2), segments } };
  assert.ok(!(await verify2d(mesh.coords, lacking)).passed);
}

test('rings of points, with a hole', async () => {
  const mesh = await delaunay2d(POINTS, { rings: RINGS });
  await prove(mesh);
  assert.equal(mesh.triangles.length, 3 * 12);
  assert.equal(areaOf(mesh), 81 - 9);
  assert.equal(areaOf(mesh, mesh.triangles), 81);
  const { edges, inside, regions, segments, zeroLength, added, moved } = mesh.constraints;
  assert.deepEqual([...edges], [0, 1, 0, 3, 1, 2, 2, 3, 4, 5, 4, 7, 5, 6, 6, 7]);
  assert.equal(segments.length, edges.length);
  assert.deepEqual([zeroLength, added, moved], [0, 0, 0]);
  assert.equal(new Set(regions).size, 2);
  regions.forEach((region, t) => {
    assert.equal(region === regions[inside.indexOf(1)], inside[t] === 1);
  });
  const isEdge = (a, b) => mesh.constraints.isEdge(a, b);
  assert.ok(isEdge(7, 4) && isEdge(4, 7) && !isEdge(0, 4));
  assert.throws(() => isEdge(0, 9), /the index of a point, not 9/);
  assert.match(mesh.stats.fallback, /constraints/);
  assert.equal(mesh.stats.backend, 'cpu');

  const areas = { all: 81, nonzero: 81, evenodd: 72, enclosed: 81 };
  for (const [fill, area] of Object.entries(areas))
    assert.equal(areaOf(await delaunay2d(POINTS, { rings: RINGS, fill })), area, fill);
  const turned = [RINGS[0], [7, 6, 5, 4]];
  assert.equal(areaOf(await delaunay2d(POINTS, { rings: turned, fill: 'nonzero' })), 72);
  const holes = [
    [4, 5],
    [100, 100],
  ];
  assert.equal(areaOf(await delaunay2d(POINTS, { rings: RINGS, fill: 'enclosed', holes })), 72);
  // Files have the triangles inside: three corners each.
  const text = new TextDecoder().decode(await mesh.toOBJ());
  assert.equal(text.match(/^f /gm).length, 8);
  const { neigh } = await mesh.toTriangle();
  assert.match(new TextDecoder().decode(neigh), /^8 3\n/);
});

test('places, values and contours inside of boundaries', async () => {
  const mesh = await delaunay2d(POINTS, { rings: RINGS });
  // Inside, on the boundary of the hole, in the hole, outside the hull.
  const queries = [1, 1, 3, 4.5, 4, 4, 20, 20];
  const { triangles, outside } = await mesh.locate(queries);
  assert.equal(outside, 1);
  assert.equal(mesh.constraints.inside[triangles[2]], 0);
  assert.deepEqual([...(await mesh.nearest(queries))], [0, 4, 4, 2]);
  const values = Array.from({ length: 9 }, (_, i) => 2 * POINTS[2 * i] - POINTS[2 * i + 1]);
  for (const method of ['linear', 'laplace', 'sibson']) {
    const found = await mesh.interpolate(values, queries, { method });
    assert.deepEqual(
      [...found.values].map((x) => Math.round(1e9 * x) / 1e9),
      [1, 1.5, NaN, NaN],
    );
    assert.equal(found.outside, 2);
  }
  const nearest = await mesh.interpolate(values, queries, { outside: 'nearest' });
  assert.deepEqual([...nearest.values], [1, 1.5, values[4], values[2]]);
  const grid = await mesh.interpolateGrid(values, { width: 9, height: 9 });
  assert.equal(grid.values.filter(Number.isNaN).length, 9);
  // The line y = x + 0.5 without its part in the hole.
  const heights = Array.from({ length: 9 }, (_, i) => POINTS[2 * i + 1] - POINTS[2 * i]);
  const [contour] = await mesh.contours(heights, [0.5]);
  const ends = [...contour.lines].map((v) => contour.vertices[2 * v]).sort((a, b) => a - b);
  assert.equal(ends[0], 0);
  assert.ok(ends.every((x) => x <= 3 || x >= 5.5) && ends.includes(3) && ends.includes(5.5), ends);
});

test('cells end at boundaries', async () => {
  const mesh = await delaunay2d(POINTS, { rings: RINGS });
  const { volumes, cells, neighbors } = await mesh.voronoi();
  assert.ok(Math.abs(volumes.reduce((sum, x) => sum + x) - 72) < 1e-12);
  // The point in the hole has no cell, and all others end at a boundary.
  assert.equal(cells[9] - cells[8], 0);
  for (let i = 0; i < 8; i++) assert.ok(neighbors.slice(cells[i], cells[i + 1]).includes(-1));
});

test('no value crosses a breakline', async () => {
  const points = [];
  for (let x = -4; x <= 4; x++) for (let y = -4; y <= 4; y++) if (x !== 0) points.push(x, y);
  points.push(0, -4, 0, 4);
  const count = points.length / 2;
  const mesh = await delaunay2d(points, { edges: [[count - 2, count - 1]] });
  const values = Array.from({ length: count }, (_, i) => (points[2 * i] < 0 ? 0 : 1));
  const found = await mesh.interpolate(values, [0, 0.5, 0.25, 0.5, 3.25, -0.5], {
    method: 'sibson',
  });
  for (const value of found.values) assert.ok(Math.abs(value - 1) < 1e-12);
});

test('polygons bring their points', async () => {
  const hole = [
    [1, 1],
    [1, 2],
    [2, 2],
  ];
  // With heights, a ring that is not closed, one without points, and a polygon without rings.
  const polygons = [[HOUSE.map(([x, y]) => [x, y, 7]), hole, []], [], [hole]];
  const mesh = await delaunay2d([], { polygons });
  await prove(mesh);
  assert.equal(mesh.coords.length, 2 * (5 + 3 + 3));
  assert.equal(areaOf(mesh), 12 + 4);
  assert.equal(mesh.constraints.edges.length, 2 * (5 + 3));
  // They follow the given points, which are vertices, too.
  const points = new Float32Array([3, 1, 10, 10]);
  const both = await delaunay2d(points, { polygons: [[HOUSE]], edges: [0, 0] });
  await prove(both);
  assert.deepEqual([...both.coords.subarray(0, 6)], [3, 1, 10, 10, 0, 0]);
  assert.deepEqual([areaOf(both), both.constraints.zeroLength], [16, 1]);
  assert.equal(both.duplicateOf.length, 7);
  assert.equal(points.length, 4);
  // No polygons are no error, and a polygon in a line has no inside.
  for (const none of [
    [],
    [[]],
    [[[]]],
    [[[[1, 1]]]],
    [
      [
        [
          [0, 0],
          [1, 1],
          [2, 2],
          [0, 0],
        ],
      ],
    ],
  ]) {
    const mesh = await delaunay2d([], { polygons: none });
    assert.deepEqual([mesh.triangles.length, mesh.insideTriangles().length], [0, 0]);
    await prove(mesh);
  }
});

test('shapes of files', async () => {
  const geojson = JSON.stringify({
    type: 'Feature',
    geometry: { type: 'Polygon', coordinates: [HOUSE.map(([x, y]) => [x, y, 1])] },
    properties: null,
  });
  const bytes = new TextEncoder().encode(geojson);
  const shapes = await readShapes(bytes, { name: 'house.geojson' });
  assert.deepEqual(shapes.rings, [new Uint32Array([0, 1, 2, 3, 4])]);
  assert.deepEqual([shapes.fill, shapes.droppedZ, shapes.leftOut], ['evenodd', true, []]);
  const mesh = await delaunay2d(shapes.points, shapes);
  await prove(mesh);
  assert.equal(areaOf(mesh), 16);
  const svg = new Blob(["<svg><path d='M0 0h4v4h-4z M1 1v2h2v-2zM6 0l1 1'/><text/></svg>"]);
  const drawing = await readShapes(svg, { format: 'svg' });
  assert.deepEqual(
    [drawing.fill, drawing.leftOut, drawing.edges.length],
    ['nonzero', ['1 text'], 2],
  );
  assert.equal(areaOf(await delaunay2d(drawing.points, drawing)), 12);
  const poly = '4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n1\n1 2 2\n';
  const hollow = await readShapes(new TextEncoder().encode(poly), { format: '.poly' });
  assert.deepEqual([hollow.fill, hollow.holes], ['enclosed', [[2, 2]]]);
  assert.equal((await delaunay2d(hollow.points, hollow)).insideTriangles().length, 0);
  await rejects(readShapes(bytes, { format: 'svg' }), 'BAD_FILE', /line 1: /);
  await rejects(readShapes(bytes, { format: 'ply' }), 'UNKNOWN_FORMAT', /shapes/);
  await rejects(readShapes(bytes), 'UNKNOWN_FORMAT');
});

test('edges of many kinds', async () => {
  const pairs = [
    [0, 2],
    [8, 2],
  ];
  const flat = await delaunay2d(POINTS, { edges: Uint16Array.from(pairs.flat()) });
  const mesh = await delaunay2d(POINTS, { edges: pairs });
  await prove(mesh);
  assert.equal(canonical(flat.triangles, 3), canonical(mesh.triangles, 3));
  // The diagonal leads through three points.
  assert.deepEqual([...mesh.constraints.edges], [0, 4, 2, 6, 4, 8, 6, 8]);
  assert.ok(mesh.constraints.inside.every((inside) => inside === 1));
  const plain = await delaunay2d(POINTS, { edges: [] });
  const without = await delaunay2d(POINTS);
  assert.equal(canonical(plain.triangles, 3), canonical(without.triangles, 3));
  assert.equal(without.constraints, null);
  assert.ok(!plain.constraints.isEdge(0, 1) && plain.constraints.edges.length === 0);
  assert.equal(without.insideTriangles().length, without.triangles.length);
});

test('random segments that do not cross, and breaklines in a ring', async () => {
  const points = await generate2d('uniform', 2000, { seed: 5 });
  const mesh = await delaunay2d(points);
  const random = randomFrom(3);
  // Edges of another triangulation of the same points: that of moved ones, where it is still one.
  const moved = await delaunay2d(points.map((x) => x + 1e-3 * random()));
  const edges = [];
  moved.halfedges.forEach((opposite, e) => {
    if (opposite < e && random() < 0.3)
      edges.push([moved.triangles[e], moved.triangles[e % 3 === 2 ? e - 2 : e + 1]]);
  });
  const found = await delaunay2d(points, { edges, crossings: 'split' });
  await prove(found);
  assert.equal(found.coords.length, points.length + 2 * found.constraints.added);
  assert.ok(found.constraints.edges.length >= edges.length);
  assert.notEqual(canonical(found.triangles, 3), canonical(mesh.triangles, 3));
});

test('crossings are errors that list pairs, or get points', async () => {
  const points = new Float32Array([0, 0, 3, 0, 3, 3, 0, 3]);
  const edges = [0, 2, 1, 3];
  await assert.rejects(delaunay2d(points, { edges }), (error) => {
    assert.ok(error instanceof gdel.GdelError);
    assert.equal(error.code, 'CROSSING_CONSTRAINTS');
    assert.match(error.message, /0–2 and 1–3/);
    assert.deepEqual(error.pairs, [
      [
        [0, 2],
        [1, 3],
      ],
    ]);
    return true;
  });
  const mesh = await delaunay2d(points, { edges, crossings: 'split' });
  await prove(mesh);
  assert.deepEqual([...mesh.coords], [0, 0, 3, 0, 3, 3, 0, 3, 1.5, 1.5]);
  assert.deepEqual([...mesh.constraints.segments], [0, 4, 4, 2, 1, 4, 4, 3]);
  assert.deepEqual([mesh.constraints.added, mesh.constraints.moved], [1, 0]);
  const bow = [[0, 2, 1, 3]];
  const split = await delaunay2d([0, 0, 3, 1, 3, 0, 0, 1], { rings: bow, crossings: 'split' });
  await prove(split);
  assert.ok(split.constraints.added >= 0);
});

test('what needs a Delaunay triangulation says so', async () => {
  const mesh = await delaunay2d(POINTS, { rings: RINGS });
  const before = canonical(mesh.triangles, 3);
  const needs = /constraints/;
  const values = new Float64Array(9);
  for (const method of ['sibson-c1', 'clough-tocher'])
    await rejects(mesh.interpolate(values, [1, 1], { method }), 'BAD_INPUT', needs);
  await rejects(mesh.voronoi({ clip: 'box' }), 'BAD_INPUT', needs);
  await rejects(mesh.alphaShape(), 'BAD_INPUT', needs);
  await rejects(mesh.ballComplex(), 'BAD_INPUT', needs);
  await rejects(mesh.update(POINTS), 'BAD_INPUT', needs);
  await rejects(mesh.insert([1, 1]), 'BAD_INPUT', needs);
  await rejects(mesh.remove([0]), 'BAD_INPUT', needs);
  await rejects(mesh.updateWeights(Array(mesh.duplicateOf.length).fill(0)), 'BAD_INPUT', needs);
  assert.throws(() => mesh.find(0, 0), needs);
  assert.equal(canonical(mesh.triangles, 3), before);
  assert.equal((await mesh.topology()).edges.length, 2 * 20);
  assert.equal((await mesh.geometry()).volumes.length, 12);
  const around = (await delaunay2d(POINTS)).neighbors(8);
  assert.deepEqual(mesh.neighbors(8).sort(), around.sort());
});

test('bad constraints', async () => {
  const bad = (options, message, code = 'BAD_INPUT') =>
    rejects(delaunay2d(POINTS, options), code, message);
  await bad({ edges: [0, 1, 2] }, /3 indices are no edges/);
  await bad({ edges: [0, 9] }, /edge 0 has 9, which is not the index of one of the 9 points/);
  await bad({ edges: [[0, 1], [2]] }, /edge 1 must be a pair of indices, not Array of length 1/);
  await bad({ edges: [[0, 1], 2] }, /edge 1 must be a pair of indices, not 2/);
  await bad({ edges: [0, -1] }, /edge 0 has -1/);
  await bad({ edges: [0, 0.5] }, /edge 0 has 0.5/);
  await bad({ edges: [0, Number.NaN] }, /edge 0 has NaN/);
  await bad({ edges: ['0', '1'] }, /edge 0 must be a pair of indices, not "0"/);
  await bad({ edges: 'all' }, /the option edges must be an array/);
  await bad({ rings: [0, 1, 2] }, /ring 0 must be an array of indices, not 0/);
  await bad({ rings: [[0, 1, 17]] }, /ring 0 has 17/);
  await bad({ polygons: HOUSE }, /ring 0 of polygon 0 must be an array of positions/);
  await bad({ polygons: [HOUSE] }, /position 0 in ring 0 of polygon 0 must be an array of numbers/);
  await bad(
    { polygons: [[[[1]]]] },
    /position 0 in ring 0 of polygon 0 must be two numbers or more/,
  );
  await bad({ polygons: [[[[1, Number.NaN]]]] }, /point 9/, 'NOT_FINITE');
  await bad({ edges: [], holes: [1, 2] }, /position 0 in the option holes must be an array/);
  await bad({ rings: RINGS, fill: 'odd' }, /the option fill must be one of all, evenodd/);
  await bad({ rings: RINGS, crossings: 'keep' }, /the option crossings/);
  await bad({ edges: [0, 1], weights: new Array(9).fill(1) }, /weights/);
  await bad({ edges: [0, 1], rescale: true }, /rescale/);
  await rejects(delaunay3d([0, 0, 0], { edges: [] }), 'BAD_INPUT', /2D only/);
});

test('before the function returns', async () => {
  await load2d();
  assert.throws(() => delaunay2dSync(POINTS, { rings: RINGS }), /await loadConstraints\(\) first/);
  await loadConstraints();
  const mesh = delaunay2dSync(POINTS, { rings: RINGS });
  assert.equal(areaOf(mesh), 72);
  await prove(mesh);
  assert.ok(mesh.stats.milliseconds >= 0 && mesh.stats.thread === 'caller');
  assert.throws(() => delaunay2dSync([0, 0, 3, 0, 3, 3, 0, 3], { edges: [0, 2, 1, 3] }), {
    code: 'CROSSING_CONSTRAINTS',
    pairs: [[[0, 2], [1, 3]]], // biome-ignore format: pairs
  });
  assert.throws(() => delaunay2dSync(POINTS, { edges: [0, 1, 2] }), /no edges/);
  assert.throws(() => delaunay2dSync(POINTS, { rings: RINGS, weights: [1] }), /weights/);
  await assert.rejects(mesh.update(POINTS), /constraints/);
});

test('in the calling thread, and aborted', async () => {
  const triangulator = await createTriangulator({ backend: 'cpu', worker: false });
  const mesh = await triangulator.delaunay2d(POINTS, { rings: RINGS });
  assert.deepEqual([areaOf(mesh), mesh.stats.fallback], [72, null]);
  triangulator.dispose();
  const signal = AbortSignal.abort(new Error('no'));
  await assert.rejects(delaunay2d(POINTS, { rings: RINGS, signal }), /no/);
});
