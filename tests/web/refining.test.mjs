// Meshes with constraints are refined.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { rejectsOf } from './dimensions.mjs';
import { importFrom, project } from './package.mjs';

const gdel = await importFrom(project());
const { delaunay2d, verify2d } = gdel;

const square = (low, high) => [
  [low, low],
  [high, low],
  [high, high],
  [low, high],
];
const polygons = [[square(0, 9), square(3, 6)]];

const rejectsAs = rejectsOf(gdel);
const rejects = (promise, message) => rejectsAs(promise, 'BAD_INPUT', message);

/** The corners of the triangles inside. */
function all(mesh) {
  const points = Array.from(mesh.insideTriangles(), (v) => [
    mesh.coords[2 * v],
    mesh.coords[2 * v + 1],
  ]);
  return Array.from({ length: points.length / 3 }, (_, t) => points.slice(3 * t, 3 * t + 3));
}

const sides = ([a, b, c]) =>
  [
    [a, b],
    [b, c],
    [c, a],
  ].map(([p, q]) => Math.hypot(q[0] - p[0], q[1] - p[1]));

function smallestAngle(triangle) {
  const [a, b, c] = sides(triangle).sort((p, q) => p - q);
  return (Math.acos((b * b + c * c - a * a) / (2 * b * c)) * 180) / Math.PI;
}

test('no angle is below the bound', async () => {
  const mesh = await delaunay2d([], { polygons });
  const fine = await mesh.refine({ minAngle: 30 });
  assert.equal(mesh.coords.length, 16);
  assert.deepEqual([...fine.coords.slice(0, 16)], [...mesh.coords]);
  assert.ok(Math.min(...all(fine).map(smallestAngle)) > 29.999);
  const { refinement, segmentOf, segments, added } = fine.constraints;
  assert.ok(Math.abs(refinement.minAngle - Math.min(...all(fine).map(smallestAngle))) < 1e-6);
  assert.equal(refinement.pointsOnSegments + refinement.pointsInside, added);
  assert.equal(fine.coords.length, 16 + 2 * added);
  assert.equal(segmentOf.length, segments.length / 2);
  assert.deepEqual(new Set(segmentOf), new Set([0, 1, 2, 3, 4, 5, 6, 7]));
  const { passed } = await verify2d(fine.coords, fine);
  assert.ok(passed);
  // Such a mesh can be refined again, but not changed.
  const finer = await fine.refine({ maxArea: 0.5, minAngle: 30 });
  assert.ok(finer.constraints.added > added);
  assert.ok((await verify2d(finer.coords, finer)).passed);
  await rejects(fine.insert([[1, 1]]), /constraints/);
});

test('sizes and limits', async () => {
  const mesh = await delaunay2d([], { polygons });
  const longest = (refined) => Math.max(...all(refined).flatMap(sides));
  assert.ok(longest(await mesh.refine({ size: 0.5 })) <= 0.5);
  const graded = await mesh.refine({ size: [0.1, 3, 3, 3, 3, 3, 3, 3] });
  const count = (isThere) => all(graded).filter(([[x, y]]) => isThere(x + y)).length;
  assert.ok(count((sum) => sum < 4) > count((sum) => sum > 14));
  const limited = await mesh.refine({ maxArea: 0.01, maxPoints: 20 });
  assert.ok(limited.constraints.refinement.limited);
  assert.equal(limited.constraints.added, 20);
});

test('wrong options and meshes', async () => {
  const mesh = await delaunay2d([], { polygons });
  await rejects(mesh.refine({ minAngle: 40 }), /the smallest angle must be a number of degrees/);
  await rejects(mesh.refine({ minAngle: '30' }), /minAngle/);
  await rejects(mesh.refine({ maxArea: 0 }), /the largest area/);
  await rejects(mesh.refine({ size: [1] }), /1 values for 8 points/);
  await rejects(mesh.refine({ size: 'small' }), /size/);
  await rejects(mesh.refine({ maxPoints: -1 }), /maxPoints/);
  const plain = await delaunay2d(square(0, 1));
  await rejects(plain.refine(), /only meshes with constraints/);
  const flat = await delaunay2d(
    [
      [0, 0],
      [1, 1],
      [2, 2],
    ],
    { edges: [[0, 2]] },
  );
  assert.equal((await flat.refine()).triangles.length, 0);
});
