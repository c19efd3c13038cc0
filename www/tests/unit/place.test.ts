import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { frameOf } from '../../src/geometry/mesh';
import { heightsAlong, keepOf, levelOf } from '../../src/geometry/plane';
import { Sample } from '../../src/geometry/range';
import { axisFacing, detectUp, fromScreen, toScreen, UPS } from '../../src/geometry/up';
import { closeTo } from './close';

/** The same points everywhere. */
function randomNumbers(seed: number): () => number {
  let state = seed;
  return () => {
    state = (state * 1103515245 + 12345) % 2 ** 31;
    return state / 2 ** 31;
  };
}

/** The corners and some points of a box, and the twelve triangles of its hull. */
function box(extents: readonly number[]) {
  const points: number[] = [];
  for (let corner = 0; corner < 8; corner++)
    for (const axis of [0, 1, 2]) points.push((corner >> axis) & 1 ? extents[axis] : 0);
  // prettier-ignore
  const hull = [
    0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3,
    5, 3, 7, 5,
  ];
  return { points, hull };
}

describe('the frame', () => {
  test('is the bounding box of points without outliers', () => {
    const { center, scale } = frameOf(box([2, 4, 4]).points);
    assert.deepEqual(center, [1, 2, 2]);
    closeTo(scale, 1 / 3, 9);
  });

  test('does not follow a few birds above a city', () => {
    const random = randomNumbers(3);
    const points: number[] = [];
    for (let i = 0; i < 10_000; i++) points.push(random(), random(), 0.1 * random());
    const still = frameOf(points);
    for (let i = 0; i < 30; i++) points.push(random(), random(), 500 * random());
    const { center, scale } = frameOf(points);
    assert.ok(Math.abs(center[2] - still.center[2]) < 0.05, `${center}`);
    assert.ok(scale > 0.9 * still.scale, `${scale}, not ${still.scale}`);
  });

  test('of points that nearly all coincide shows the others, too', () => {
    const points = new Array(3 * 1000).fill(1);
    points.push(5, 1, 1);
    assert.deepEqual(frameOf(points).center, [3, 1, 1]);
    assert.deepEqual(frameOf([]).center, [0.5, 0.5, 0.5]);
  });
});

describe('the cutting plane', () => {
  test('halves the points at first, however far the outliers are', () => {
    const random = randomNumbers(5);
    const positions = new Float32Array(3 * 10_000).map(() => random());
    positions.fill(-1000, 0, 60);
    const heights = heightsAlong([0, 0, 1], {
      positions,
      tetrahedra: new Uint32Array(),
      neighbors: new Int32Array(),
    });
    const plane = { normal: [0, 0, 1], keep: null } as const;
    const level = levelOf(plane, heights);
    const below = positions.filter((x, i) => i % 3 === 2 && x < level).length;
    assert.ok(Math.abs(below - 5000) < 100, `${below} below`);
    const share = keepOf(plane, heights);
    assert.ok(share > 0.4 && share < 0.7, `the slider is at ${share}`);
  });

  test('opens the object even where half of the points lie on the wall in front', () => {
    const positions = Float32Array.from({ length: 3000 }, (_, i) => (i % 2 ? 1 : (i % 600) / 600));
    const mesh = { positions, tetrahedra: new Uint32Array(), neighbors: new Int32Array() };
    const share = keepOf({ normal: [0, 0, 1], keep: null }, heightsAlong([0, 0, 1], mesh));
    assert.ok(share > 0.3 && share < 0.7, `the slider is at ${share}`);
  });

  test('lies along the axis that faces the camera, whichever axis is up', () => {
    for (const up of UPS) {
      const normal = axisFacing(up, [0.3, 0.9, 0.6]);
      assert.deepEqual(
        toScreen(up, normal).map((x) => x + 0),
        [0, 0, 1],
        up,
      );
    }
  });
});

describe('up', () => {
  test('is turned to the top of the screen, without mirroring', () => {
    for (const up of UPS) {
      const axis = [0, 0, 0];
      axis['xyz'.indexOf(up.replace('-', ''))] = up.startsWith('-') ? -1 : 1;
      assert.deepEqual(
        toScreen(up, axis as never).map((x) => x + 0),
        [0, 1, 0],
        up,
      );
      const [a, b, c] = [
        [1, 0, 0],
        [0, 1, 0],
        [0, 0, 1],
      ].map((each) => fromScreen(up, each as never));
      const determinant =
        a[0] * (b[1] * c[2] - b[2] * c[1]) -
        a[1] * (b[0] * c[2] - b[2] * c[0]) +
        a[2] * (b[0] * c[1] - b[1] * c[0]);
      assert.equal(determinant, 1, up);
    }
  });

  test('of land is across it, whatever the format says', () => {
    for (const [axis, up] of ['x', 'y', 'z'].entries()) {
      const extents = [10, 12, 14];
      extents[axis] = 1;
      const { points, hull } = box(extents);
      assert.equal(detectUp(points, hull, 'y'), up);
    }
  });

  test('of a box is that of custom', () => {
    const { points, hull } = box([1, 1, 1]);
    assert.equal(detectUp(points, hull, 'y'), 'y');
    assert.equal(detectUp(points, hull, 'z'), 'z');
  });

  test('of a figure with a flat foot is opposite to the foot', () => {
    for (const up of UPS) {
      // A half ball: the foot is its flat side.
      const points: number[] = [];
      const hull: number[] = [];
      const steps = 24;
      const at = (ring: number, step: number) => ring * steps + (step % steps);
      for (let ring = 0; ring < 6; ring++) {
        for (let step = 0; step < steps; step++) {
          const [a, e] = [(2 * Math.PI * step) / steps, (ring * Math.PI) / 12];
          const [x, y, z] = [Math.cos(a) * Math.cos(e), Math.sin(e), -Math.sin(a) * Math.cos(e)];
          points.push(...fromScreen(up, [x, y, z]));
        }
      }
      for (let step = 0; step < steps; step++) {
        for (let ring = 0; ring < 5; ring++) {
          const [p, q] = [at(ring, step), at(ring, step + 1)];
          const [r, s] = [at(ring + 1, step), at(ring + 1, step + 1)];
          hull.push(p, q, r, q, s, r);
        }
        if (step > 0) {
          hull.push(at(0, 0), at(0, step + 1), at(0, step));
          hull.push(at(5, 0), at(5, step), at(5, step + 1));
        }
      }
      assert.equal(detectUp(points, hull, 'y'), up);
    }
  });
});

test('percentiles of few numbers are the numbers', () => {
  const sample = new Sample(3, (i) => [5, 1, 3][i]);
  assert.deepEqual(
    [0, 0.5, 1].map((share) => sample.quantile(share)),
    [1, 3, 5],
  );
  assert.deepEqual(sample.range, [1, 5]);
});
