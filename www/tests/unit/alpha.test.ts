import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { createTriangulator, generate2d, readPoints, type Triangulator } from 'gdel-wasm';
import { frameOf } from '../../src/geometry/mesh';
import { NOTHING_ABOUT } from '../../src/model/about';
import { AlphaRadii } from '../../src/model/alpha';
import type { DrawRequest } from '../../src/model/model';
import { Model2d } from '../../src/model/model2d';
import { Model3d } from '../../src/model/model3d';
import { torus } from '../models.mjs';

let triangulator: Triangulator;
before(async () => {
  triangulator = await createTriangulator({ backend: 'cpu' });
});
after(() => triangulator.dispose());

const AUTO = { kind: 'alpha', alpha: null } as const;

const REQUEST: DrawRequest = {
  filter: AUTO,
  plane: { normal: [1, 0, 0], keep: 1 },
  color: 'quality',
  skin: false,
  pieces: true,
  round: null,
  voronoi: false,
};

const spatial = (points: Float32Array | Float64Array) =>
  Model3d.make(triangulator, points, {}, NOTHING_ABOUT);
const flat = (points: Float32Array | Float64Array, options = {}) =>
  Model2d.make(triangulator, points, options, NOTHING_ABOUT, frameOf(points, 2));

async function scan(): Promise<Float32Array | Float64Array> {
  const file = new URL('../../../tests/data/bunny.ply', import.meta.url);
  const { points } = await readPoints(new Blob([readFileSync(fileURLToPath(file))]), {
    name: 'bunny.ply',
  });
  return points as Float32Array;
}

/** The simplices that a model shows, ascending. */
function shownBy(model: Model2d | Model3d, filter: DrawRequest['filter']): number[] {
  const { pieces, surface } = model.draw({ ...REQUEST, filter });
  return [...(pieces ?? surface!).owners].sort((a, b) => a - b);
}

describe('the radius of the filter alpha that suits is that of the package', () => {
  for (const [name, make] of [
    ['a torus', async () => spatial(Float64Array.from(torus(3000, 0.01).flat()))],
    ['a scan', async () => spatial(await scan())],
    ['a disk', async () => flat(await generate2d('disk', 500))],
    // All radii are the same up to rounding.
    ['a grid', async () => flat(Float64Array.from({ length: 800 }, (_, i) => 0.1 * gridOf(i)))],
    // Four points of a ring are flat up to rounding: what is measured of such tetrahedra says little.
    ['a sphere of rings', async () => spatial(rings())],
    ['points on a line', async () => flat(Float64Array.of(0, 0, 1, 1, 5, 5))],
    ['no points', async () => flat(new Float64Array())],
  ] as const) {
    test(name, async () => {
      const model = await make();
      const { alpha, solid } = await model.mesh.alphaShape({ alpha: 'auto' });
      await model.prepare(REQUEST);
      const { value, isAuto } = model.draw(REQUEST).alpha!;
      assert.deepEqual([value, isAuto], [alpha, true]);
      assert.deepEqual(shownBy(model, AUTO), [...solid]);
    });
  }
});

const gridOf = (i: number) => (i % 2 ? Math.floor(i / 40) : Math.floor(i / 2) % 20);

function rings(): Float64Array {
  const points: number[] = [];
  for (let latitude = -80; latitude <= 80; latitude += 20) {
    for (let longitude = 0; longitude < 360; longitude += 15) {
      const [u, v] = [latitude, longitude].map((angle) => (angle * Math.PI) / 180);
      points.push(Math.cos(u) * Math.cos(v), Math.cos(u) * Math.sin(v), Math.sin(u));
    }
  }
  return Float64Array.from(points);
}

test('until the radius is found all is shown, with the stops of the slider', async () => {
  const model = await flat(await generate2d('disk', 200));
  const filter = { kind: 'alpha', alpha: 'any' } as const;
  await model.prepare({ filter });
  const { alpha, shown, total } = model.draw({ ...REQUEST, filter });
  assert.equal(shown, total);
  assert.deepEqual([alpha!.value, alpha!.isAuto], [Infinity, true]);
  assert.ok(alpha!.stops.length > 10);
});

test('a radius is rounded as those that are measured', async () => {
  const model = await flat(Float64Array.of(0, 0, 0.3, 0, 0, 0.1));
  const radius = Math.hypot(0.3, 0.1) / 2;
  const shown = (alpha: number) => shownBy(model, { kind: 'alpha', alpha }).length;
  assert.deepEqual(
    [0.999999, 1, 1.000001].map((times) => shown(times * radius)),
    [0, 1, 1],
  );
});

describe('the package is asked', () => {
  /** The radii of a triangle, whose asker is replaced. */
  const radiiBy = (ask: ConstructorParameters<typeof AlphaRadii>[6]) => {
    const points = Float64Array.of(0, 0, 1, 0, 0, 1);
    const measures = {
      volume: Float32Array.of(0.5),
      circumradius: Float32Array.of(Math.SQRT1_2),
      radiusRatio: Float32Array.of(1),
    };
    const outside = Int32Array.of(-1, -1, -1);
    return new AlphaRadii(
      points,
      Uint32Array.of(0, 1, 2),
      outside,
      2,
      frameOf(points, 2),
      () => measures,
      ask,
    );
  };

  test('once for a mesh, and only for the radius that suits', async () => {
    let asked = 0;
    const radii = radiiBy(async () => {
      asked++;
      return { alpha: 0.75, solid: Uint32Array.of(0) };
    });
    await radii.prepare({ kind: 'all', alpha: null });
    await radii.prepare({ kind: 'carve', alpha: null });
    await radii.prepare({ kind: 'alpha', alpha: 0.5 });
    await radii.prepare({ kind: 'alpha', alpha: 'any' });
    assert.equal(asked, 0);
    await Promise.all([radii.prepare(AUTO), radii.prepare(AUTO)]);
    await radii.prepare(AUTO);
    assert.equal(asked, 1);
    assert.equal(radii.of(AUTO)!.value, 0.75);
  });

  test('again after it was interrupted', async () => {
    const radii = radiiBy(async (signal) => {
      signal?.throwIfAborted();
      return { alpha: 0.75, solid: Uint32Array.of(0) };
    });
    await assert.rejects(radii.prepare(AUTO, AbortSignal.abort()), { name: 'AbortError' });
    await radii.prepare(AUTO);
    assert.equal(radii.of(AUTO)!.value, 0.75);
  });

  test('not about weighted points, where the page has a rule of its own', async () => {
    const points = await generate2d('disk', 200);
    const weights = Array.from({ length: 200 }, (_, i) => 1e-6 * i);
    const model = await flat(points, { weights });
    await model.prepare(REQUEST);
    const { value, isAuto } = model.draw(REQUEST).alpha!;
    assert.ok(isAuto && value > 0.05 && value < 1, `${value}`);
  });
});
