// The class Delaunator beside that of the npm package delaunator.

import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import Theirs from 'delaunator';
import { importFrom, project } from './package.mjs';

const folder = project();
const main = await importFrom(folder);
const { delaunay2d, GdelError } = main;
const subpath = createRequire(join(folder, 'main.js')).resolve('gdel-wasm/delaunator');
const { default: Delaunator, ...named } = await import(pathToFileURL(subpath));

test('gdel-wasm/delaunator and the main entry export the same classes', () => {
  assert.equal(Delaunator, main.Delaunator);
  assert.equal(named.Delaunator, main.Delaunator);
  assert.equal(Delaunator.name, 'Delaunator');
  assert.equal(named.GdelError, main.GdelError);
});

test('before it is loaded, the error says what to do', async () => {
  assert.throws(
    () => new Delaunator([0, 0]),
    (error) =>
      error instanceof GdelError &&
      error.code === 'NOT_LOADED' &&
      /await Delaunator\.load\(\)/.test(error.message),
  );
  await Promise.all([Delaunator.load(), Delaunator.load()]);
});

/** The same in every run: 32 bits per call (mulberry32), as a number from 0 to 1. */
function random(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), seed | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

const list = (length, item) => Array.from({ length }, (_, i) => item(i));

/** The sign of det(b − a, c − a), exactly: doubles are integers times a power of two. */
function orient(coords, a, b, c) {
  const view = new DataView(new ArrayBuffer(8));
  const parts = [a, b, c]
    .flatMap((v) => [coords[2 * v], coords[2 * v + 1]])
    .map((x) => {
      view.setFloat64(0, x);
      const bits = view.getBigUint64(0);
      const exponent = (bits >> 52n) & 0x7ffn;
      const mantissa = (bits & 0xfffffffffffffn) | (exponent ? 1n << 52n : 0n);
      return { mantissa: bits >> 63n ? -mantissa : mantissa, exponent: exponent || 1n };
    });
  const used = parts.filter(({ mantissa }) => mantissa !== 0n).map(({ exponent }) => exponent);
  // biome-ignore lint/complexity/useMathMinMax: Math.min takes no big integers.
  const min = used.reduce((x, y) => (x < y ? x : y), used[0] ?? 1n);
  const [ax, ay, bx, by, cx, cy] = parts.map(({ mantissa, exponent }) =>
    mantissa === 0n ? 0n : mantissa << (exponent - min),
  );
  const det = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
  return det > 0n ? 1 : det < 0n ? -1 : 0;
}

/** What delaunator's documentation promises, and that every distinct point is a vertex. */
function keepsTheContract({ coords, triangles, halfedges, hull, trianglesLen }) {
  assert.equal(trianglesLen, triangles.length);
  assert.equal(halfedges.length, triangles.length);
  const next = (e) => (e % 3 === 2 ? e - 2 : e + 1);
  const outer = new Map();
  for (const [e, twin] of halfedges.entries()) {
    if (twin === -1) {
      assert.ok(!outer.has(triangles[e]), 'the hull turns once');
      outer.set(triangles[e], triangles[next(e)]);
      continue;
    }
    assert.equal(halfedges[twin], e);
    assert.equal(triangles[e], triangles[next(twin)]);
    assert.equal(triangles[twin], triangles[next(e)]);
  }
  for (let t = 0; t < triangles.length; t += 3)
    assert.equal(orient(coords, ...triangles.subarray(t, t + 3)), -1, `triangle ${t / 3}`);
  if (triangles.length) {
    assert.equal(hull.length, outer.size);
    for (const [i, v] of hull.entries()) assert.equal(outer.get(v), hull[(i + 1) % hull.length]);
    // Euler: 2n − 2 − h triangles, with all distinct points.
    const distinct = new Set(
      list(coords.length / 2, (i) => `${coords[2 * i] + 0} ${coords[2 * i + 1] + 0}`),
    ).size;
    assert.equal(triangles.length / 3, 2 * distinct - 2 - hull.length);
    for (const [i, v] of hull.entries()) {
      assert.notEqual(
        orient(coords, v, hull[(i + 1) % hull.length], hull[(i + 2) % hull.length]),
        1,
        'the hull is convex',
      );
    }
  }
}

/** Each triangle from its lowest vertex on, all in order. */
const canonical = ({ triangles }) => {
  const rows = [];
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = triangles.subarray(t, t + 3);
    rows.push(a < b && a < c ? [a, b, c] : b < c ? [b, c, a] : [c, a, b]);
  }
  return rows.map((row) => row.join(' ')).sort();
};

/** A hull from its lowest vertex on. */
const fromLowest = ({ hull }) => {
  const at = hull.indexOf(Math.min(...hull));
  return [...hull.subarray(at), ...hull.subarray(0, at)];
};

test('on points in general position, everything is as there', () => {
  const next = random(1);
  for (const count of [3, 4, 10, 100, 5000]) {
    const coords = Float64Array.from(list(2 * count, next));
    const [ours, theirs] = [new Delaunator(coords), new Theirs(coords)];
    keepsTheContract(ours);
    assert.deepEqual(canonical(ours), canonical(theirs));
    assert.deepEqual(fromLowest(ours), fromLowest(theirs));
    assert.equal(ours.coords, coords);
  }
});

test('on grids, with ties and collinear hull edges, the contract holds and the sizes are as there', () => {
  for (const side of [2, 3, 10, 50]) {
    const coords = list(side * side, (i) => [i % side, Math.floor(i / side)]).flat();
    const [ours, theirs] = [new Delaunator(coords), new Theirs(coords)];
    keepsTheContract(ours);
    assert.equal(ours.triangles.length, theirs.triangles.length);
    assert.deepEqual(fromLowest(ours), fromLowest(theirs));
  }
});

test('duplicates are no vertices', () => {
  const next = random(2);
  const coords = list(1000, () => Math.floor(next() * 15));
  const ours = new Delaunator(coords);
  keepsTheContract(ours);
  assert.equal(ours.triangles.length, new Theirs(coords).triangles.length);
  for (const [i, other] of ours.duplicateOf.entries()) {
    assert.equal(ours.triangles.includes(i), other === -1);
    if (other >= 0)
      assert.deepEqual(coords.slice(2 * i, 2 * i + 2), coords.slice(2 * other, 2 * other + 2));
  }
});

test('fewer than three points and collinear ones have a hull in order and no triangles, as there', () => {
  const cases = [
    [],
    [1, 2],
    [3, 4, 1, 2],
    [1, 2, 3, 4],
    [0, 0, 0, 0, 0, 0],
    [2, 2, 0, 0, 1, 1, 3, 3],
    [5, 1, 5, 7, 5, -2, 5, 0],
    [4, 0, 2, 0, 3, 0, 1, 0, 2, 0],
  ];
  for (const coords of cases) {
    const [ours, theirs] = [new Delaunator(coords), new Theirs(coords)];
    assert.equal(ours.triangles.length, 0);
    assert.equal(ours.halfedges.length, 0);
    const places = ({ hull }) => [...hull].map((v) => coords.slice(2 * v, 2 * v + 2));
    assert.deepEqual(places(ours), places(theirs), String(coords));
    assert.equal(ours.dimension, new Set(places(ours).map(String)).size > 1 ? 1 : 0);
  }
});

test('nearly collinear and nearly equal points keep the contract', () => {
  const next = random(3);
  const up = (x, ulps) => x + ulps * 2 ** (Math.floor(Math.log2(Math.abs(x) || 2 ** -1022)) - 52);
  const inputs = {
    'a line off by single bits': list(300, (i) => [
      1 + i / 7,
      up(2 + (3 * i) / 7, Math.floor(3 * next()) - 1),
    ]),
    'a line and one point far away': [
      ...list(200, (i) => [i / 3, (i / 3) * 0.1 + 0.7]),
      [1e9, -1e9],
    ],
    'two nearly equal lines': list(200, (i) => [i % 100, i < 100 ? 0 : 1e-14]),
    'clusters of neighbouring numbers': list(300, (i) => [
      up(100 + (i % 10), i % 7),
      up(300 + (i % 3), i % 5),
    ]),
    'a circle in rounded numbers': list(500, (i) => [
      Math.cos((i * Math.PI) / 250),
      Math.sin((i * Math.PI) / 250),
    ]),
    'a sliver with a large offset': list(100, (i) => [
      5e6 + i * 1e-3,
      6e6 + i * 2e-3 + (i % 2) * 1e-9,
    ]),
    'very small and very large': list(200, () => [
      next() * 10 ** (-300 * next()),
      next() * 10 ** (150 * next()),
    ]),
    denormal: list(60, (i) => [(i % 8) * 5e-324, Math.floor(i / 8) * 5e-324]),
    'a fan at one point': [[0, 0], ...list(100, (i) => [2 ** -i, 2 ** -i * (i + 1)])],
  };
  for (const [name, points] of Object.entries(inputs)) {
    const ours = Delaunator.from(points);
    assert.ok(ours.triangles.length > 0, name);
    try {
      keepsTheContract(ours);
    } catch (error) {
      throw new Error(name, { cause: error });
    }
  }
});

test('from, accessors, kinds of arrays, and update are as there', async () => {
  const points = [
    [0, 0],
    [3, 0],
    [0, 3],
    [3, 3],
    [1, 2],
  ];
  const objects = points.map(([x, y]) => ({ x, y }));
  const expected = canonical(Delaunator.from(points));
  assert.deepEqual(
    canonical(
      Delaunator.from(
        objects,
        (p) => p.x,
        (p) => p.y,
      ),
    ),
    expected,
  );
  for (const coords of [
    points.flat(),
    Float32Array.from(points.flat()),
    Int16Array.from(points.flat()),
  ]) {
    assert.deepEqual(canonical(new Delaunator(coords)), expected);
  }
  const ours = Delaunator.from(points);
  const theirs = Theirs.from(points);
  for (const delaunator of [ours, theirs]) {
    delaunator.coords[8] = 10;
    delaunator.update();
  }
  assert.deepEqual(canonical(ours), canonical(theirs));
  assert.deepEqual(canonical(ours), canonical(await delaunay2d(ours.coords)));
});

test('bad input is a typed error that leaves the class usable', () => {
  const throws = (coords, code) =>
    assert.throws(
      () => new Delaunator(coords),
      (error) => error instanceof GdelError && error.code === code,
    );
  throws(undefined, 'BAD_INPUT');
  throws([0, '1'], 'BAD_INPUT');
  throws([0, 1, NaN, 3], 'NOT_FINITE');
  throws({ length: 2 ** 40 }, 'TOO_MANY_POINTS');
  assert.equal(new Delaunator([0, 0, 1, 0, 0, 1]).triangles.length, 3);
});
