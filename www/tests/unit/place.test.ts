import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { frameOf } from '../../src/geometry/mesh';
import { keepOf, levelOf, spreadAlong } from '../../src/geometry/plane';
import { Sample } from '../../src/geometry/range';
import { axisFacing, detectUp, fromScreen, toScreen, UPS, type Up } from '../../src/geometry/up';
import { closeTo } from './close';

/** The same points everywhere. */
function randomNumbers(seed: number): () => number {
  let state = seed;
  return () => {
    state = (state * 1103515245 + 12345) % 2 ** 31;
    return state / 2 ** 31;
  };
}

/** The corners of a box. */
function box(extents: readonly number[]): number[] {
  const points: number[] = [];
  for (let corner = 0; corner < 8; corner++)
    for (const axis of [0, 1, 2]) points.push((corner >> axis) & 1 ? extents[axis] : 0);
  return points;
}

/** Points on ellipsoids, each given by its middle and its radii, with y up; turned so that `up` is. */
function figure(up: Up, ellipsoids: readonly (readonly number[])[]): number[] {
  const random = randomNumbers(7);
  const points: number[] = [];
  for (const [x, y, z, a, b, c] of ellipsoids) {
    for (let i = 0; i < 1000; i++) {
      const [angle, height] = [2 * Math.PI * random(), 2 * random() - 1];
      const radius = Math.sqrt(1 - height * height);
      // Nothing is below the ground.
      const above = Math.max(0, y + b * height);
      const [right, near] = [a * radius * Math.cos(angle), c * radius * Math.sin(angle)];
      points.push(...fromScreen(up, [x + right, above, z + near]));
    }
  }
  return points;
}

const MODEL = { axis: 'y', unless: 'it stands or lies' } as const;
const SURVEY = { axis: 'z', unless: 'it stands' } as const;

describe('the frame', () => {
  test('is the bounding box of points without outliers', () => {
    const { center, scale } = frameOf(box([2, 4, 4]));
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
    const spread = spreadAlong([0, 0, 1], positions);
    const plane = { normal: [0, 0, 1], keep: null } as const;
    const level = levelOf(plane, spread);
    const below = positions.filter((x, i) => i % 3 === 2 && x < level).length;
    assert.ok(Math.abs(below - 5000) < 100, `${below} below`);
    const share = keepOf(plane, spread);
    assert.ok(share > 0.4 && share < 0.7, `the slider is at ${share}`);
  });

  test('opens the object even where half of the points lie on the wall in front', () => {
    const positions = Float32Array.from({ length: 3000 }, (_, i) => (i % 2 ? 1 : (i % 600) / 600));
    const share = keepOf({ normal: [0, 0, 1], keep: null }, spreadAlong([0, 0, 1], positions));
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

  test('of land is across it, whatever the format says, but not of a wall in a survey', () => {
    for (const [axis, up] of ['x', 'y', 'z'].entries()) {
      const extents = [10, 12, 14];
      extents[axis] = 1;
      assert.equal(detectUp(box(extents), MODEL), up);
      assert.equal(detectUp(box(extents), SURVEY), 'z');
    }
  });

  test('of a box is that of custom', () => {
    assert.equal(detectUp(box([1, 1, 1]), MODEL), 'y');
    assert.equal(detectUp(box([1, 1, 1]), SURVEY), 'z');
    assert.equal(detectUp([], SURVEY), 'z');
    assert.equal(detectUp([1, 2, 3], MODEL), 'y');
  });

  test('of a figure with a flat foot is opposite to the foot', () => {
    for (const up of UPS)
      for (const custom of [MODEL, SURVEY])
        assert.equal(detectUp(figure(up, [[0, 0, 0, 1, 1, 1]]), custom), up);
  });

  test('of a figure on two feet is that of custom, however flat a triangle on its belly is', () => {
    // Head, belly, hands that reach forward, and small feet.
    const [head, belly] = [
      [0, 1.75, 0, 0.12, 0.15, 0.12],
      [0, 1.1, 0, 0.35, 0.5, 0.28],
    ];
    const hands = [-0.7, 0.7].map((x) => [x, 1.3, 0.25, 0.07, 0.07, 0.05]);
    const feet = [-0.2, 0.2].map((x) => [x, 0.02, 0.05, 0.08, 0.08, 0.2]);
    const man = [head, belly, ...hands, ...feet];
    assert.equal(detectUp(figure('y', man), MODEL), 'y');
    assert.equal(detectUp(figure('z', man), MODEL), 'z');
  });

  test('does not follow dirt below the foot', () => {
    const points = figure('z', [[0, 0, 0, 1, 1, 1]]);
    for (let i = 0; i < 1000; i++) points.push(...points.slice(3 * i, 3 * i + 3));
    points.push(0, 0, -0.4);
    assert.equal(detectUp(points, MODEL), 'z');
  });

  test('is what a format says for certain', () => {
    const points = figure('y', [[0, 0, 0, 1, 1, 1]]);
    assert.equal(detectUp(points, { axis: 'z', unless: 'never' }), 'z');
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
