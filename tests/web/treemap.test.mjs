// Treemaps with exact areas: gdel-wasm/treemap.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { randomFrom } from './moving.mjs';
import { importFrom, project } from './package.mjs';

const folder = project();
const { GdelError } = await importFrom(folder);
const { default: treemap, treemapSync } = await importFrom(folder, 'treemap.js');

const isError = (code, message) => (error) => {
  assert.ok(error instanceof GdelError, String(error));
  assert.equal(error.code, code, error.message);
  if (message) assert.match(error.message, message);
  return true;
};

/** The area of a polygon, positive if it is counter-clockwise on a screen. */
const areaOf = (polygon) =>
  polygon.reduce((sum, [x, y], i) => {
    const [x1, y1] = polygon[(i + 1) % polygon.length];
    return sum + (y * x1 - x * y1) / 2;
  }, 0);

const HEXAGON = Array.from({ length: 6 }, (_, i) => [
  Math.cos((i * Math.PI) / 3),
  Math.sin((i * Math.PI) / 3),
]);
const AREA = Math.abs(areaOf(HEXAGON));

/** Checks that cells fill an area, each with the share of its value. */
function expectExact(cells, area, tolerance = 1e-3) {
  const used = cells.filter((cell) => cell);
  const sum = used.reduce((sum, { value }) => sum + value, 0);
  for (const cell of used) {
    const wanted = (cell.value / sum) * area;
    assert.ok(Math.abs(areaOf(cell) - cell.area) <= 1e-9 * area, `${cell.area}`);
    assert.ok(Math.abs(cell.area / wanted - 1) <= 1.001 * tolerance, `${cell.area} ${wanted}`);
  }
  const total = used.reduce((sum, cell) => sum + cell.area, 0);
  assert.ok(Math.abs(total / area - 1) < 1e-9, `${total}`);
  return used;
}

/** Checks that cells are those of the power diagram: each corner is nearest to the site of its cell. */
function expectPowerDiagram(cells, size) {
  const used = cells.filter((cell) => cell);
  const power = ({ site: [sx, sy], weight }, [x, y]) => (x - sx) ** 2 + (y - sy) ** 2 - weight;
  for (const cell of used) {
    for (const corner of cell) {
      const own = power(cell, corner);
      for (const other of used)
        assert.ok(own <= power(other, corner) + 1e-9 * size ** 2, `${corner} ${other.index}`);
    }
  }
}

test('nothing works at once before the module is loaded', async () => {
  assert.throws(() => treemapSync([1, 2]), isError('NOT_LOADED', /await load\(\) first/));
  await treemap.load();
  assert.equal(treemapSync([1, 2]).cells.length, 2);
});

test('areas are those of the values, in a worker and at once', async () => {
  const random = randomFrom(3);
  const values = Array.from({ length: 300 }, () => 100 ** random());
  const phases = new Set();
  const map = await treemap(values, {
    shape: HEXAGON,
    onProgress: ({ phase, fraction }) => {
      phases.add(phase);
      assert.ok(fraction >= 0 && fraction <= 1);
    },
  });
  assert.deepEqual([...phases], ['transport']);
  assert.ok(map.error <= 1e-3 && map.steps > 0);
  expectExact(map.cells, AREA);
  expectPowerDiagram(map.cells, 1);
  map.cells.forEach((cell, i) => {
    assert.deepEqual([cell.item, cell.value, cell.index], [values[i], values[i], i]);
    assert.equal(cell.children, null);
  });
  assert.deepEqual(treemapSync(values, { shape: HEXAGON }).cells, map.cells);
  assert.deepEqual((await treemap(values, { shape: HEXAGON })).cells, map.cells);
  // Clockwise, it is the same shape.
  const other = treemapSync(values, { shape: [...HEXAGON].reverse() });
  expectExact(other.cells, AREA);
});

test('a smaller tolerance is kept', () => {
  const map = treemapSync([5, 3, 1, 1, 1], { tolerance: 1e-9 });
  assert.ok(map.error <= 1e-9, `${map.error}`);
  expectExact(map.cells, 1, 1e-9);
});

test('relaxing makes cells rounder', () => {
  const random = randomFrom(4);
  const values = Array.from({ length: 200 }, () => 20 ** random());
  const roundness = (relax) => {
    const { cells } = treemapSync(values, { relax });
    expectExact(cells, 1);
    const of = (cell) => {
      const length = cell.reduce((sum, [x, y], i) => {
        const [x1, y1] = cell[(i + 1) % cell.length];
        return sum + Math.hypot(x1 - x, y1 - y);
      }, 0);
      return (4 * Math.PI * cell.area) / length ** 2;
    };
    return cells.reduce((sum, cell) => sum + of(cell), 0) / cells.length;
  };
  const [none, some] = [roundness(0), roundness(3)];
  assert.ok(none > 0.6 && some > none, `${none} ${some}`);
});

test('few cells, and none', () => {
  assert.deepEqual(treemapSync([]).cells, []);
  const [one] = expectExact(treemapSync([7], { shape: [0, 0, 4, 2] }).cells, 8);
  assert.equal(one.length, 4);
  assert.equal(one.weight, 0);
  expectExact(treemapSync([3, 1], { shape: HEXAGON }).cells, AREA);
  expectExact(treemapSync(Uint8Array.of(1, 2, 3)).cells, 1);
  expectExact(treemapSync([1, 1e6], { shape: HEXAGON }).cells, AREA);
});

test('a value of 0 has no cell, and is in its place all the same', () => {
  const { cells } = treemapSync([0, 2, 0, 1]);
  assert.deepEqual(
    cells.map((cell) => cell?.index ?? null),
    [null, 1, null, 3],
  );
  expectExact(cells, 1);
});

test('values and sites by functions', () => {
  const items = [
    { name: 'a', n: '1', at: [0.1, 0.5] },
    { name: 'b', n: '2', at: [0.9, 0.5] },
    { name: 'c', n: '3', at: [7, 7] },
    { name: 'd', n: '3', at: null },
  ];
  const { cells } = treemapSync(items, {
    value: ({ n }) => Number(n),
    site: ({ at }) => at,
    relax: 0,
  });
  expectExact(cells, 1);
  assert.deepEqual(
    cells.slice(0, 2).map(({ site }) => site),
    [
      [0.1, 0.5],
      [0.9, 0.5],
    ],
  );
  assert.ok(cells.slice(2).every(({ site }) => site.every((x) => x > 0 && x < 1)));
  assert.equal(cells[2].item, items[2]);
});

test('sites that are equal or in a line have cells of their own', () => {
  for (const [what, site] of Object.entries({
    equal: () => [0.5, 0.5],
    'equal in pairs': (_, i) => [0.25 + 0.5 * (i % 2), 0.5],
    'in a line': (_, i) => [(i + 1) / 8, 0.5],
    'in a line at an angle': (_, i) => [(i + 1) / 8, (i + 1) / 8],
    'on the boundary': (_, i) => [i / 6, 0],
  })) {
    for (const relax of [0, 2]) {
      const { cells } = treemapSync([1, 2, 3, 4, 5, 6, 1], { site, relax });
      assert.equal(expectExact(cells, 1).length, 7, what);
      expectPowerDiagram(cells, 1);
    }
  }
});

test('groups have cells, and what is in them has cells within', async () => {
  const groups = [
    { name: 'a', children: [{ value: 1 }, { value: 2 }, { value: 0 }] },
    { name: 'b', value: 5 },
    { name: 'c', children: [{ children: [{ value: 1 }, { value: 3 }] }, { value: 4 }] },
    { name: 'd', children: [{ value: 0 }] },
    { name: 'e', children: [], value: 2 },
  ];
  const { cells, error } = await treemap(groups, { shape: HEXAGON });
  assert.ok(error <= 1e-3);
  assert.deepEqual(
    cells.map((cell) => cell?.value ?? null),
    [3, 5, 8, null, 2],
  );
  const expectNested = (all, area) => {
    for (const cell of expectExact(all, area))
      if (cell.children) expectNested(cell.children, cell.area);
  };
  expectNested(cells, AREA);
  assert.deepEqual(
    cells[0].children.map((cell) => cell?.index ?? null),
    [0, 1, null],
  );
  assert.equal(cells[2].children[0].children.length, 2);
  assert.equal(cells[1].children, null);
  // Other names.
  const tree = { rows: [{ n: 1 }, { rows: [{ n: 2 }, { n: 3 }] }] };
  const named = treemapSync(tree.rows, { value: ({ n }) => n, children: ({ rows }) => rows });
  expectNested(named.cells, 1);
});

test('on the way from equal areas, no cell vanishes', async () => {
  const random = randomFrom(5);
  const values = [0, ...Array.from({ length: 80 }, () => 100 ** random())];
  const map = await treemap(values, { shape: HEXAGON });
  const areas = [];
  for (const share of [0, 0.25, 0.5, 0.75, 1]) {
    const cells = await map.between(share);
    assert.equal(cells[0], null);
    expectPowerDiagram(cells, 1);
    areas.push(cells.slice(1).map((cell) => areaOf(cell)));
  }
  areas[0].forEach((area, i) => {
    assert.ok(Math.abs(area * 80 - AREA) < 2e-3 * AREA);
    assert.ok(Math.abs(areas[4][i] - map.cells[i + 1].area) < 1e-9);
    [1, 2, 3].forEach((at) => {
      const between = (1 - at / 4) * Math.sqrt(area) + (at / 4) * Math.sqrt(areas[4][i]);
      assert.ok(Math.sqrt(areas[at][i]) > between - 1e-9, `${i}`);
    });
  });
  await assert.rejects(map.between(2), isError('BAD_INPUT', /from 0 to 1/));
  const controller = new AbortController();
  controller.abort();
  await assert.rejects(map.between(0.5, { signal: controller.signal }), isError('ABORTED'));
});

test('3,000 cells are exact', async () => {
  const random = randomFrom(6);
  const values = Array.from({ length: 3000 }, () => 100 ** random());
  const { cells } = await treemap(values, { shape: [0, 0, 960, 500] });
  assert.equal(expectExact(cells, 960 * 500).length, 3000);
});

test('what is wrong is an error that says what and where', async () => {
  const bad = (items, options, message) =>
    assert.throws(() => treemapSync(items, options), isError('BAD_INPUT', message));
  bad([1, -2], {}, /value 1 must be a finite number from 0 on, not -2/);
  bad([1, 2, NaN], {}, /value 2/);
  bad([Infinity], {}, /value 0/);
  bad([{ value: 'x' }], {}, /value 0/);
  bad([{}], {}, /value 0 .*undefined/);
  bad([null], {}, /value 0/);
  bad([0, 0], {}, /all values are 0/);
  bad([1e308, 1e308], {}, /not finite/);
  bad('items', {}, /must be an array/);
  bad([1], { shape: [0, 0, 1] }, /corners/);
  bad([1], { shape: [1, 0, 0, 1] }, /inside/);
  bad(
    [1, 2],
    {
      shape: [
        [0, 0],
        [1, 1],
        [2, 2],
      ],
    },
    /inside/,
  );
  bad(
    [1, 2],
    {
      shape: [
        [0, 0],
        [4, 0],
        [4, 4],
        [3, 1],
      ],
    },
    /convex/,
  );
  bad(
    [1],
    {
      shape: [
        [0, 0],
        [1, 0],
        [1, NaN],
      ],
    },
    /corners/,
  );
  bad([1], { relax: -1 }, /relax/);
  bad([1], { tolerance: 1 }, /tolerance/);
  const loop = { children: [] };
  loop.children.push(loop);
  bad([loop], {}, /within itself/);
  await assert.rejects(treemap([1, -1]), isError('BAD_INPUT', /value 1/));
  assert.throws(() => treemapSync([1, -1]), { index: 1 });
});

test('values that differ by many orders of magnitude have cells, or an error that says so', () => {
  for (const small of [1e-3, 1e-6, 1e-9, 1e-12, 1e-18, 1e-300]) {
    try {
      expectExact(treemapSync([1, small, 1, 2, small]).cells, 1, 2e-3);
    } catch (error) {
      isError('BAD_INPUT', /too small|cells with these masses were not found/)(error);
      assert.ok(small < 1e-9, `${small}`);
    }
  }
});

test('a treemap can be aborted', async () => {
  const controller = new AbortController();
  const values = Array.from({ length: 2000 }, (_, i) => 1 + (i % 50));
  const aborted = treemap(values, {
    relax: 50,
    signal: controller.signal,
    onProgress: () => controller.abort(),
  });
  await assert.rejects(aborted, isError('ABORTED'));
  assert.equal((await treemap([1, 2])).cells.length, 2);
});
