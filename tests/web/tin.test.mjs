// Terrain: triangles between a few of many points, which are near to all of them.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { rejectsOf } from './dimensions.mjs';
import { importFrom, project } from './package.mjs';

const folder = project();
const gdel = await importFrom(folder);
const { default: tin, tin: named } = await importFrom(folder, 'tin.js');

const rejects = rejectsOf(gdel);

/** A ridge along x = 4, by 10 × 10 points. */
const ridge = Array.from({ length: 100 }, (_, i) => {
  const [x, y] = [i % 10, Math.floor(i / 10)];
  return [x, y, 9 - Math.abs(x - 4)];
});

const hills = Float64Array.from({ length: 3 * 2500 }, (_, i) => {
  const k = Math.floor(i / 3);
  const [x, y] = [k % 50, Math.floor(k / 50)];
  return [x, y, 3 * Math.sin(x / 8) * Math.cos(y / 11)][i % 3];
});

const corner = ({ vertices }, v) => Array.from(vertices.subarray(3 * v, 3 * v + 3));

/** The largest distance of points from the triangles below or above them. */
function largestError(terrain, points) {
  let largest = 0;
  for (const [x, y, z] of points) {
    let error = Infinity;
    for (let t = 0; t < terrain.triangles.length; t += 3) {
      const corners = [0, 1, 2].map((k) => corner(terrain, terrain.triangles[t + k]));
      const shares = [0, 1, 2].map((k) => {
        const [a, b] = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
        return (a[0] - x) * (b[1] - y) - (a[1] - y) * (b[0] - x);
      });
      const whole = shares[0] + shares[1] + shares[2];
      assert.ok(whole > 0, 'a triangle is clockwise');
      if (shares.some((share) => share < 0)) continue;
      const height = corners.reduce((sum, [, , h], k) => sum + (h * shares[k]) / whole, 0);
      error = Math.abs(height - z);
    }
    largest = Math.max(largest, error);
  }
  return largest;
}

test('all points are near to the surface', async () => {
  assert.equal(named, tin);
  const rows = Array.from({ length: 2500 }, (_, i) => Array.from(hills.subarray(3 * i, 3 * i + 3)));
  const terrain = await tin(hills, { maxError: 0.1 });
  assert.ok(terrain.maxError <= 0.1 && terrain.maxError > 0.05, `${terrain.maxError}`);
  assert.ok(terrain.vertices.length / 3 < 500);
  assert.ok(Math.abs(largestError(terrain, rows) - terrain.maxError) < 1e-9);
  terrain.sources.forEach((i, v) => {
    assert.deepEqual(corner(terrain, v), rows[i]);
  });
  const { limited, duplicates, outside } = terrain;
  assert.deepEqual({ limited, duplicates, outside }, { limited: false, duplicates: 0, outside: 0 });
  // The points themselves are as they were, and may be of single precision.
  const single = await tin(Float32Array.from(hills), { maxError: 0.1 });
  assert.ok(single.vertices instanceof Float32Array && single.vertices.length < 1500);
});

test('the number of vertices has a limit', async () => {
  const few = await tin(hills, { maxPoints: 20 });
  assert.deepEqual([few.vertices.length, few.limited], [60, true]);
  const more = await tin(hills, { maxPoints: 40, maxError: 0.01 });
  assert.deepEqual(more.sources.subarray(0, 20), few.sources);
  assert.ok(more.maxError < few.maxError);
});

test('breaklines are edges', async () => {
  const points = [...ridge, [4.5, 0.5, 1], [4.5, 8.5, 1], [4.5, 8.5, 5]];
  const terrain = await tin(points, { maxError: 0.5, edges: [[100, 101]] });
  const [a, b] = [100, 101].map((i) => terrain.sources.indexOf(i));
  assert.ok(a >= 0 && b >= 0);
  assert.deepEqual([...terrain.edges], [Math.min(a, b), Math.max(a, b)]);
  assert.deepEqual([terrain.duplicates, terrain.otherHeights], [1, 1]);
  const crossing = {
    maxError: 9,
    edges: [
      [0, 98],
      [90, 8],
    ],
  };
  await assert.rejects(tin(ridge, crossing), { code: 'CROSSING_CONSTRAINTS' });
  const split = await tin(ridge, { ...crossing, crossings: 'split' });
  assert.equal(split.sources.filter((i) => i === -1).length, 1);
  assert.equal(split.edges.length, 8);
});

test('points outside rings do not count', async () => {
  const tower = [...ridge, [8.5, 8.5, 100]];
  const rings = [[0, 5, 55, 50]];
  const inside = await tin(tower, { maxError: 0, rings });
  assert.equal(inside.outside, 101 - 36);
  assert.ok(inside.triangles.every((v) => corner(inside, v)[0] <= 5));
  const whole = await tin(tower, { maxError: 0, rings, fill: 'all' });
  assert.ok(whole.sources.includes(100) && whole.outside === 0);
});

test('files', async () => {
  const terrain = await tin(ridge, { maxError: 0 });
  assert.ok(terrain instanceof gdel.Triangles);
  const text = new TextDecoder().decode(await terrain.toOBJ());
  assert.equal(text.match(/^f /gm).length, terrain.triangles.length / 3);
  const glb = await terrain.toGLB();
  assert.equal(new TextDecoder().decode(glb.subarray(0, 4)), 'glTF');
});

test('too few points, and points on a line', async () => {
  for (const points of [
    [],
    [[1, 2, 3]],
    [
      [0, 0, 0],
      [1, 1, 5],
      [2, 2, 0],
    ],
  ]) {
    const { triangles, maxError } = await tin(points, { maxError: 0 });
    assert.deepEqual([triangles.length, maxError], [0, 0]);
  }
});

test('wrong input, progress and abortion', async () => {
  const bad = (promise, message) => rejects(promise, 'BAD_INPUT', message);
  await bad(tin(ridge), /one of the options maxError and maxPoints is needed/);
  await bad(tin(ridge, {}), /one of the options maxError and maxPoints is needed/);
  await bad(tin(ridge, { maxError: '1' }), /the option maxError must be a number/);
  await bad(tin(ridge, { maxError: -1 }), /the largest error must be a number from 0 on/);
  await bad(tin(ridge, { maxError: NaN }), /the largest error must be a number from 0 on/);
  await bad(tin(ridge, { maxPoints: 1.5 }), /the option maxPoints/);
  await bad(tin(ridge, { maxError: 1, edges: [[0, 100]] }), /edge 0 has 100/);
  await bad(tin(ridge, { maxError: 1, polygons: [[]] }), /rings instead of polygons/);
  const broken = ridge.map(([x, y, z]) => [x, y, x === 3 ? NaN : z]);
  await rejects(tin(broken, { maxError: 1 }), 'NOT_FINITE', /point 3: the z coordinate/);
  const fractions = [];
  await tin(hills, { maxError: 0, onProgress: ({ fraction }) => fractions.push(fraction) });
  assert.ok(fractions.length > 0 && fractions.every((x, i) => i === 0 || x >= fractions[i - 1]));
  await rejects(tin(hills, { maxError: 0, signal: AbortSignal.abort() }), 'ABORTED');
});
