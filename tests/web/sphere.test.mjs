// Points on a sphere in the installed package: what d3-geo-voronoi answers, and what holds for every sphere.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { importFrom, project } from './package.mjs';

const { delaunaySphere, GdelError, SphereMesh, SphereVoronoi } = await importFrom(project());

const sum = (numbers) => numbers.reduce((a, b) => a + b, 0);
const near = (a, b, error = 1e-12) => assert.ok(Math.abs(a - b) <= error, `${a}, not ${b}`);
const sorted = (numbers) => [...numbers].sort((a, b) => a - b);

/** Twenty places all over the sphere, or on a part of it. */
const places = (scale) =>
  Array.from({ length: 20 }, (_, i) => [
    (((i * 73.25) % 360) - 180) * scale,
    (((i * 41.5) % 170) - 85) * scale,
  ]);

const OCTAHEDRON = [
  [0, 0],
  [90, 0],
  [180, 0],
  [-90, 0],
  [0, 90],
  [0, -90],
];
/** Four places around a fifth, as the tests of d3-geo-voronoi have them. */
const FIVE = [
  [10, 0],
  [10, 10],
  [3, 5],
  [-2, 5],
  [0, 0],
];

/** The pairs of an array. */
const pairs = (array) =>
  Array.from({ length: array.length / 2 }, (_, i) => [...array.slice(2 * i, 2 * i + 2)]);

/** Asserts what every sphere has: triangles that close up, and cells that cover it. */
async function check(sphere, count) {
  assert.ok(sphere instanceof SphereMesh);
  const { triangles, halfedges, duplicateOf, outer, points } = sphere;
  const vertices = duplicateOf.filter((of) => of === -1).length;
  assert.equal(duplicateOf.length, count);
  assert.equal(points.length, 3 * count);
  assert.equal(triangles.length, vertices > 2 ? 3 * (2 * vertices - 4) : 0);
  assert.equal(outer.length, triangles.length / 3);
  const next = (e) => (e % 3 === 2 ? e - 2 : e + 1);
  halfedges.forEach((h, e) => {
    assert.equal(halfedges[h], e);
    assert.deepEqual([triangles[h], triangles[next(h)]], [triangles[next(e)], triangles[e]]);
  });
  const voronoi = await sphere.voronoi();
  assert.ok(voronoi instanceof SphereVoronoi);
  assert.equal(voronoi.areas.length, count);
  if (count > 0) near(sum(voronoi.areas), 4 * Math.PI, 1e-9);
  assert.ok(voronoi.vertices.length >= (2 * triangles.length) / 3);
  return voronoi;
}

test('twenty places have the areas of d3-geo-voronoi', async () => {
  const expected = {
    1: [0.404502545, 0.669464306, 0.994116156, 0.924627037, 0.457187881, 0.521734175],
    0.25: [3.023609635, 0.11715167, 0.069338394, 0.068912477, 2.186661921, 0.201097524],
  };
  for (const scale of [1, 0.25]) {
    const sphere = await delaunaySphere(places(scale));
    const { areas } = await check(sphere, 20);
    for (const [i, area] of expected[scale].entries()) near(areas[i], area, 1e-7);
  }
});

test('few points, one circle and antipodes share the sphere', async () => {
  const equator = [0, 72, 144, -144, -72].map((lon) => [lon, 0]);
  const antipodes = [
    [10, 20],
    [-170, -20],
  ];
  for (const sites of [
    OCTAHEDRON,
    equator,
    antipodes,
    [[5, 10]],
    equator.slice(0, 2),
    equator.slice(0, 3),
  ]) {
    const sphere = await delaunaySphere(sites);
    const { areas } = await check(sphere, sites.length);
    if (sites.length !== 3) for (const area of areas) near(area, (4 * Math.PI) / sites.length);
    assert.deepEqual(await sphere.nearest(sites), Int32Array.from(sites.keys()));
    for (const [i, [lon, lat]] of sites.entries()) assert.equal(sphere.find(lon, lat), i);
  }
  const none = await delaunaySphere([]);
  await check(none, 0);
  assert.equal(none.find(1, 2), -1);
  assert.deepEqual(await none.nearest([[1, 2]]), Int32Array.of(-1));
});

test('equal places are duplicates, whatever their names', async () => {
  const sphere = await delaunaySphere([...OCTAHEDRON, [360, 0], [-180, 0], [77, 90]]);
  assert.deepEqual([...sphere.duplicateOf.slice(6)], [0, 2, 4]);
  const { areas, cellPolygon } = await check(sphere, 9);
  assert.deepEqual([...areas.slice(6)], [0, 0, 0]);
  assert.equal(sphere.find(-180, 1), 2);
  assert.equal(typeof cellPolygon, 'function');
});

test('geoVoronoi.find(): the nearest point', async () => {
  const sphere = await delaunaySphere(FIVE);
  assert.equal(sphere.find(1, 1), 4);
  assert.equal(sphere.find(1, 1, 4), 4);
  assert.equal(sphere.find(-170, 0), 3);
  assert.equal(sphere.find(Number.NaN, 0), -1);
  assert.throws(() => sphere.find(1, 1, 5), { code: 'BAD_INPUT' });
  // Four places that are as near to the pole as each other, but for rounding.
  const ring = await delaunaySphere([
    [0, -90],
    [-45, 35],
    [-135, 35],
    [135, 35],
    [45, 35],
  ]);
  const all = await ring.nearest([[0, 90]]);
  assert.equal(ring.find(0, 90), all[0]);
});

test('geoVoronoi.hull(): the points around a part of the sphere', async () => {
  const { hull, outer } = await delaunaySphere(FIVE);
  assert.deepEqual([...hull], [0, 1, 3, 4]);
  assert.equal(sum(outer), 2);
  assert.equal((await delaunaySphere(OCTAHEDRON)).hull.length, 0);
  assert.equal((await delaunaySphere(places(1))).hull.length, 0);
});

test('geoVoronoi.mesh() and links(): edges, lengths, the Urquhart graph', async () => {
  const key = (edges) => edges.map((edge) => sorted(edge).join('-')).sort();
  const { edges } = (await delaunaySphere(FIVE)).edges();
  // By their places: 3,5 – −2,5; 3,5 – 0,0; and so on.
  const expected = [
    [2, 3],
    [2, 4],
    [3, 4],
    [1, 3],
    [1, 2],
    [0, 2],
    [0, 4],
    [0, 1],
  ];
  assert.deepEqual(key(pairs(edges)), key(expected));
  const three = (
    await delaunaySphere([
      [0, 0],
      [10, 0],
      [0, 10],
    ])
  ).edges();
  const of = (v, w) => pairs(three.edges).findIndex(([a, b]) => a === v && b === w);
  assert.equal(three.edges.length, 6);
  assert.deepEqual(
    [of(1, 2), of(0, 1), of(0, 2)].map((e) => three.urquhart[e]),
    [0, 1, 1],
  );
  near(three.lengths[of(0, 1)], Math.PI / 18);
  const two = (
    await delaunaySphere([
      [0, 0],
      [180, 0],
    ])
  ).edges();
  assert.deepEqual([[...two.edges], [...two.urquhart]], [[0, 1], [1]]);
  near(two.lengths[0], Math.PI);
  // All of a sphere: three edges per point, less six.
  assert.equal((await delaunaySphere(places(1))).edges().edges.length, 2 * (3 * 20 - 6));
});

test('geoVoronoi.polygons(): closed rings around the points', async () => {
  const sphere = await delaunaySphere([
    [0, 0],
    [10, 0],
  ]);
  const two = await sphere.voronoi();
  const ring = two.cellPolygon(0);
  assert.deepEqual(ring[0], ring.at(-1));
  // The great circle half-way between both.
  for (const [lon, lat] of ring)
    assert.ok(Math.abs(lat) > 89.99 || Math.min(Math.abs(lon - 5), Math.abs(lon + 175)) < 1e-9);
  assert.equal([...two.cellPolygons()].length, 2);
  const one = await (await delaunaySphere([[5, 10]])).voronoi();
  assert.equal(one.cellPolygon(0), null);
  near(one.areas[0], 4 * Math.PI);
  const three = await (
    await delaunaySphere([
      [0, 0],
      [10, 0],
      [0, 10],
    ])
  ).voronoi();
  // The centres of both triangles, which are opposite each other.
  const centers = pairs(three.vertices.slice(0, 4)).sort((a, b) => b[1] - a[1]);
  near(centers[0][0], 5, 1e-6);
  near(centers[0][1], 4.981069, 1e-6);
  near(centers[1][0], -175, 1e-6);
  near(centers[1][1], -4.981069, 1e-6);
  const octahedron = await (await delaunaySphere(OCTAHEDRON)).voronoi();
  const polygon = octahedron.cellPolygon(0);
  const ends = new Set(polygon.map(([lon, lat]) => `${Math.round(lon)},${Math.round(lat)}`));
  assert.deepEqual([...ends].sort(), ['-45,-35', '-45,35', '45,-35', '45,35']);
  // Counter-clockwise as seen from outside.
  const area = polygon
    .slice(1)
    .reduce((all, [x, y], i) => all + polygon[i][0] * y - x * polygon[i][1], 0);
  assert.ok(area > 0);
  assert.throws(() => octahedron.cellPolygon(6), { code: 'BAD_INPUT' });
});

test('queries have triangles, nearest points and values', async () => {
  const sites = places(1);
  const sphere = await delaunaySphere(sites, { backend: 'cpu' });
  const queries = Array.from({ length: 500 }, (_, i) => [
    (i * 37.7) % 360,
    ((i * 17.3) % 180) - 90,
  ]);
  const vector = ([lon, lat]) => {
    const [l, p] = [(lon * Math.PI) / 180, (lat * Math.PI) / 180];
    return [Math.cos(p) * Math.cos(l), Math.cos(p) * Math.sin(l), Math.sin(p)];
  };
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const nearest = await sphere.nearest(queries);
  const { triangles, outside } = await sphere.locate(queries);
  const { values, outside: none } = await sphere.interpolate(new Float64Array(20).fill(7), queries);
  assert.deepEqual([outside, none], [0, 0]);
  queries.forEach((query, i) => {
    const own = sites.map((site) => dot(vector(site), vector(query)));
    near(own[nearest[i]], Math.max(...own));
    assert.equal(sphere.find(query[0], query[1], i % 20), nearest[i]);
    assert.ok(triangles[i] >= 0);
    near(values[i], 7);
  });
  const heights = sites.map(([, lat]) => lat);
  const own = await sphere.interpolate(heights, sites);
  for (const [i, height] of heights.entries()) near(own.values[i], height);
  const part = await delaunaySphere(FIVE);
  const beyond = await part.interpolate([1, 2, 3, 4, 5], [...FIVE, [100, 0]]);
  for (let i = 0; i < 5; i++) near(beyond.values[i], i + 1);
  assert.ok(Number.isNaN(beyond.values[5]) && beyond.outside === 1);
  assert.deepEqual((await part.locate([[100, 0]])).triangles, Int32Array.of(-1));
});

test('what is wrong is said', async () => {
  const error = (code, message) => (thrown) => {
    assert.ok(thrown instanceof GdelError, String(thrown));
    assert.equal(thrown.code, code);
    assert.match(thrown.message, message);
    return true;
  };
  await assert.rejects(delaunaySphere([0, 0, 1]), error('BAD_INPUT', /multiple of 2/));
  await assert.rejects(
    delaunaySphere([
      [0, 0],
      [Number.NaN, -1],
    ]),
    error('NOT_FINITE', /point 1/),
  );
  await assert.rejects(
    delaunaySphere(OCTAHEDRON, { backend: 'other' }),
    error('BAD_INPUT', /backend/),
  );
  const sphere = await delaunaySphere(OCTAHEDRON);
  await assert.rejects(sphere.nearest([[0, Infinity]]), error('NOT_FINITE', /query 0/));
  await assert.rejects(sphere.interpolate([1, 2], [[0, 0]]), error('BAD_INPUT', /6 numbers/));
  await assert.rejects(
    delaunaySphere(OCTAHEDRON, { signal: AbortSignal.abort() }),
    (thrown) => thrown.name === 'AbortError' || thrown.code === 'ABORTED',
  );
});

test('progress goes up', async () => {
  const fractions = [];
  await delaunaySphere(places(1), { onProgress: ({ fraction }) => fractions.push(fraction) });
  assert.deepEqual(fractions, sorted(fractions));
  assert.equal(fractions.at(-1), 1);
});

test('items of any kind have places by a function', async () => {
  const cities = FIVE.map(([x, y], i) => ({ name: `city ${i}`, at: { x, y } }));
  const expected = await delaunaySphere(FIVE);
  const sphere = await delaunaySphere(cities, { point: ({ at }) => [at.x, at.y] });
  assert.deepEqual(sphere.points, expected.points);
  assert.deepEqual(sphere.triangles, expected.triangles);
  const own = new Error('mine');
  await assert.rejects(
    delaunaySphere(cities, {
      point: () => {
        throw own;
      },
    }),
    own,
  );
  await assert.rejects(delaunaySphere(cities, { point: 'at' }), /point/);
});
