// The interfaces of d3-weighted-voronoi, d3-voronoi-map and d3-voronoi-treemap.

import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { test } from 'node:test';
import { randomFrom } from './moving.mjs';
import { importFrom, project } from './package.mjs';

const folder = project();
const { GdelError } = await importFrom(folder);
const weighted = await importFrom(folder, 'd3-weighted-voronoi.js');
const map = await importFrom(folder, 'd3-voronoi-map.js');
const { voronoiTreemap } = await importFrom(folder, 'd3-voronoi-treemap.js');
const { weightedVoronoi } = weighted;
const { voronoiMapSimulation, voronoiMapInitialPositionPie, voronoiMapInitialPositionRandom } = map;

const throws = (run, code, message) =>
  assert.throws(run, (error) => {
    assert.ok(error instanceof GdelError, String(error));
    assert.equal(error.code, code, error.message);
    if (message) assert.match(error.message, message);
    return true;
  });

/** d3-polygon's area: positive if the polygon is counter-clockwise on a screen. */
const areaOf = (polygon) =>
  polygon.reduce((sum, [x, y], i) => {
    const [x1, y1] = polygon[(i + 1) % polygon.length];
    return sum + (y * x1 - x * y1) / 2;
  }, 0);
const sumOf = (polygons) => polygons.reduce((sum, polygon) => sum + areaOf(polygon), 0);
const isNear = (a, b, tolerance = 1e-9) =>
  assert.ok(Math.abs(a - b) <= tolerance * Math.max(1, Math.abs(b)), `${a} is not ${b}`);

const SQUARE = [
  [0, 0],
  [0, 1],
  [1, 1],
  [1, 0],
];
const HEXAGON = Array.from({ length: 6 }, (_, i) => [
  100 + 100 * Math.cos((-i * Math.PI) / 3),
  100 + 100 * Math.sin((-i * Math.PI) / 3),
]);

test('nothing works before the module is loaded', async () => {
  throws(() => weightedVoronoi()([]), 'NOT_LOADED', /load/);
  const simulation = voronoiMapSimulation([{ weight: 1 }]).stop();
  throws(() => simulation.state(), 'NOT_LOADED', /load/);
  throws(() => voronoiTreemap()({ children: [{ value: 1 }] }), 'NOT_LOADED', /load/);
  await Promise.all([weightedVoronoi.load(), voronoiMapSimulation.load(), voronoiTreemap.load()]);
});

test('require gives the same', () => {
  const require = createRequire(join(folder, 'main.cjs'));
  assert.equal(typeof require('gdel-wasm/d3-weighted-voronoi').weightedVoronoi.load, 'function');
  assert.equal(typeof require('gdel-wasm/d3-voronoi-map').voronoiMapSimulation.load, 'function');
  assert.equal(typeof require('gdel-wasm/d3-voronoi-treemap').voronoiTreemap.load, 'function');
  assert.equal(typeof require('gdel-wasm/treemap').treemap.load, 'function');
});

test('the errors have the names that they had', () => {
  assert.equal(weighted.d3WeightedVoronoiError, GdelError);
  assert.equal(map.d3VoronoiMapError, GdelError);
});

// Both layouts have the same methods for what they fill.
for (const [name, make] of Object.entries({
  weightedVoronoi: () => weightedVoronoi(),
  voronoiMapSimulation: () => voronoiMapSimulation([{ weight: 1 }]).stop(),
  voronoiTreemap: () => voronoiTreemap(),
})) {
  test(`${name}: clip, extent and size belong together`, () => {
    const layout = make();
    assert.deepEqual(layout.clip(), SQUARE);
    assert.deepEqual(layout.extent(), [
      [0, 0],
      [1, 1],
    ]);
    assert.deepEqual(layout.size(), [1, 1]);
    assert.equal(layout.clip(HEXAGON), layout);
    assert.deepEqual(layout.clip(), HEXAGON);
    isNear(layout.size()[0], 200);
    isNear(layout.size()[1], 100 * Math.sqrt(3));
    assert.equal(
      layout.extent([
        [1, 2],
        [4, 6],
      ]),
      layout,
    );
    assert.deepEqual(layout.clip(), [
      [1, 2],
      [1, 6],
      [4, 6],
      [4, 2],
    ]);
    assert.deepEqual(layout.size(), [3, 4]);
    assert.equal(layout.size([5, 7]), layout);
    assert.deepEqual(layout.extent(), [
      [0, 0],
      [5, 7],
    ]);
  });

  test(`${name}: a clip polygon may be of either orientation, and of one that is not convex the hull counts`, () => {
    const layout = make();
    const clockwise = [...SQUARE].reverse();
    const before = structuredClone(clockwise);
    assert.ok(areaOf(layout.clip(clockwise).clip()) > 0);
    assert.deepEqual(clockwise, before);
    const dented = [
      [0, 0],
      [0, 4],
      [4, 4],
      [3, 1],
    ];
    const star = [...dented.slice(0, 3), [1, 3.5], [4, 0]];
    isNear(areaOf(layout.clip(star).clip()), 16);
    assert.equal(layout.clip().length, 4);
    throws(() => layout.clip([[0, 0]]), 'BAD_INPUT', /corners/);
    throws(
      () =>
        layout.clip([
          [0, 0],
          [1, 1],
          [2, 2],
        ]),
      'BAD_INPUT',
      /inside/,
    );
  });
}

test('weightedVoronoi: accessors', () => {
  const layout = weightedVoronoi();
  const datum = { x: 1, y: 2, weight: 3 };
  assert.deepEqual([layout.x()(datum), layout.y()(datum), layout.weight()(datum)], [1, 2, 3]);
  const x = () => 7;
  for (const name of ['x', 'y', 'weight']) {
    assert.equal(layout[name](x), layout);
    assert.equal(layout[name](), x);
  }
});

test('weightedVoronoi: a heavier site has more', () => {
  const data = [
    { x: 0.25, y: 0.5, weight: 0 },
    { x: 0.75, y: 0.5, weight: 0.1 },
  ];
  const cells = weightedVoronoi()(data);
  assert.equal(cells.length, 2);
  // The line between is moved by the difference of the weights over twice the distance.
  isNear(areaOf(cells[0]), 0.4);
  isNear(areaOf(cells[1]), 0.6);
  cells.forEach((cell, i) => {
    assert.equal(cell.length, 4);
    assert.equal(cell.site.originalObject, data[i]);
    const { x, y, weight } = cell.site;
    assert.deepEqual({ x, y, weight }, data[i]);
  });
});

test('weightedVoronoi: of equal sites, the heaviest has the cell, the first of several', () => {
  const at = { x: 0.5, y: 0.5 };
  const find = (...weights) =>
    weightedVoronoi()(weights.map((weight) => ({ ...at, weight }))).map(
      ({ site }) => site.originalObject.weight,
    );
  assert.deepEqual(find(0, 0), [0]);
  assert.deepEqual(find(1, 3, 2), [3]);
  assert.deepEqual(find(5), [5]);
  const data = Array.from({ length: 4 }, () => ({ ...at, weight: 1 }));
  assert.equal(weightedVoronoi()(data)[0].site.originalObject, data[0]);
});

test('weightedVoronoi: no sites, one, in a line, outside, hidden', () => {
  assert.deepEqual(weightedVoronoi()([]), []);
  const [one] = weightedVoronoi().clip(HEXAGON)([{ x: 5, y: 5, weight: 1 }]);
  isNear(areaOf(one), areaOf(HEXAGON));
  const line = weightedVoronoi()([0, 1, 2, 3].map((i) => ({ x: 0.1 + i / 4, y: 0.5, weight: 0 })));
  assert.equal(line.length, 4);
  isNear(sumOf(line), 1);
  const outside = weightedVoronoi()([
    { x: -5, y: 0.5, weight: 0 },
    { x: -5.5, y: 0.25, weight: 20 },
    { x: 0.5, y: 9, weight: -1000 },
  ]);
  isNear(sumOf(outside), 1);
  const hidden = weightedVoronoi()([
    { x: 0.2, y: 0.2, weight: 0 },
    { x: 0.8, y: 0.2, weight: 0 },
    { x: 0.5, y: 0.8, weight: 0 },
    { x: 0.5, y: 0.4, weight: -1 },
  ]);
  assert.equal(hidden.length, 3);
  isNear(sumOf(hidden), 1);
});

test('weightedVoronoi: what is not finite is an error with its index', () => {
  throws(() => weightedVoronoi()([{ x: NaN, y: 0, weight: 0 }]), 'NOT_FINITE', /point 0/);
  throws(() => weightedVoronoi()([{ x: 0, y: 0 }]), 'BAD_INPUT', /weight 0/);
});

/** Runs a simulation to its end. */
function ended(simulation) {
  simulation.stop();
  for (let i = 0; !simulation.state().ended; i++) {
    assert.ok(i < 1000, 'it has no end');
    simulation.tick();
  }
  return simulation.state();
}

/** Checks that polygons have the shares of their weights. */
function expectShares(polygons, area, tolerance = 1.001e-3) {
  const all = polygons.map(({ site }) => site.originalObject);
  const sum = all.reduce((sum, { data }) => sum + data.weight, 0);
  polygons.forEach((polygon, i) => {
    const wanted = (all[i].data.weight / sum) * area;
    isNear(all[i].targetedArea, wanted);
    assert.ok(Math.abs(areaOf(polygon) / wanted - 1) <= tolerance, `${areaOf(polygon)} ${wanted}`);
  });
  isNear(sumOf(polygons), area);
}

test('voronoiMapSimulation: areas are exact from the first iteration on', () => {
  const random = randomFrom(1);
  const data = Array.from({ length: 60 }, () => ({ weight: 1 + 20 * random() }));
  const simulation = voronoiMapSimulation(data).clip(HEXAGON).stop();
  const before = simulation.state();
  assert.deepEqual([before.iterationCount, before.ended], [0, false]);
  assert.equal(before.polygons.length, 60);
  simulation.tick();
  const first = simulation.state();
  assert.equal(first.iterationCount, 1);
  assert.ok(first.convergenceRatio <= 1e-3);
  expectShares(first.polygons, areaOf(HEXAGON));
  const last = ended(simulation);
  expectShares(last.polygons, areaOf(HEXAGON));
  assert.ok(last.iterationCount > 1 && last.iterationCount <= 50);
  last.polygons.forEach((polygon, i) => {
    assert.equal(polygon.site.originalObject.data.originalData, data[i]);
    assert.equal(polygon.site.originalObject.index, i);
  });
  // Nothing more happens.
  simulation.tick();
  assert.equal(simulation.state(), last);
});

test('voronoiMapSimulation: settings', () => {
  const simulation = voronoiMapSimulation([{ weight: 3 }]).stop();
  assert.equal(simulation.weight()({ weight: 3 }), 3);
  assert.equal(simulation.convergenceRatio(), 1e-3);
  assert.equal(simulation.maxIterationCount(), 50);
  assert.equal(simulation.minWeightRatio(), 0);
  assert.equal(simulation.prng(), Math.random);
  for (const name of [
    'weight',
    'convergenceRatio',
    'maxIterationCount',
    'minWeightRatio',
    'prng',
    'initialPosition',
    'initialWeight',
  ]) {
    const value = () => 1;
    assert.equal(simulation[name](value), simulation);
    assert.equal(simulation[name](), value);
  }
  const few = voronoiMapSimulation([1, 2, 3, 4])
    .weight((x) => x)
    .maxIterationCount(2);
  assert.equal(ended(few).iterationCount, 2);
  // A changed setting begins anew.
  few.maxIterationCount(3);
  assert.equal(few.state().iterationCount, 0);
  assert.equal(ended(few.convergenceRatio(1e-9)).convergenceRatio <= 1e-9, true);
});

test('voronoiMapSimulation: weights of 0 have no cell, unless they are raised', () => {
  const weights = [0, 1, 2, 0, 4];
  const plain = ended(voronoiMapSimulation(weights).weight((x) => x));
  assert.deepEqual(
    plain.polygons.map(({ site }) => site.originalObject.index),
    [1, 2, 4],
  );
  expectShares(plain.polygons, 1);
  const raised = ended(
    voronoiMapSimulation(weights)
      .weight((x) => x)
      .minWeightRatio(0.25),
  );
  assert.deepEqual(
    raised.polygons.map(({ site }) => site.originalObject.data.weight),
    [1, 1, 2, 1, 4],
  );
  expectShares(raised.polygons, 1);
});

test('voronoiMapSimulation: one cell, two, equal sites, sites in a line', () => {
  const find = (weights, position) => {
    const simulation = voronoiMapSimulation(weights).weight((x) => x);
    if (position) simulation.initialPosition(position);
    const { polygons } = ended(simulation);
    assert.equal(polygons.length, weights.length);
    expectShares(polygons, 1);
    return polygons;
  };
  assert.equal(find([5])[0].length, 4);
  find([5, 1]);
  find([1, 2, 3, 4], () => [0.5, 0.5]);
  find([1, 2, 3, 4], (_, i) => [0.2 + i / 8, 0.5]);
  find([1, 2, 3, 4], () => [7, 7]);
  find([1, 2, 3, 4], () => undefined);
  assert.deepEqual(ended(voronoiMapSimulation([])).polygons, []);
});

test('voronoiMapSimulation: values as in an issue about endless loops end', () => {
  // d3-voronoi-map 10: one of the weights is fifteen times as large, and the sites are near to each other.
  const weights = [15, 1, 1];
  const places = [
    [605.9975186232019, 328.2152273626913],
    [607.1700362606578, 329.4272560895722],
    [607.3920808696175, 329.9778254838309],
  ];
  const { polygons } = ended(
    voronoiMapSimulation(weights)
      .weight((x) => x)
      .size([1000, 600])
      .initialPosition((_, i) => places[i]),
  );
  expectShares(polygons, 600_000);
});

test('voronoiMapSimulation: many small data in parallel, and 3,000 cells', () => {
  // d3-voronoi-map 5: four sizes, again and again.
  for (let i = 0; i < 50; i++) {
    const random = randomFrom(i + 1);
    const { polygons } = ended(
      voronoiMapSimulation([0.1, 0.2, 0.3, 0.4])
        .weight((x) => x)
        .prng(random)
        .initialPosition(voronoiMapInitialPositionRandom()),
    );
    assert.equal(polygons.length, 4);
    expectShares(polygons, 1);
  }
  // d3-voronoi-map 18.
  const random = randomFrom(9);
  const { polygons } = ended(
    voronoiMapSimulation(Array.from({ length: 3000 }, () => ({ weight: 1 + 30 * random() })))
      .clip(HEXAGON)
      .maxIterationCount(1),
  );
  assert.equal(polygons.length, 3000);
  expectShares(polygons, areaOf(HEXAGON));
});

test('voronoiMapSimulation: bad weights are errors with their index', () => {
  const bad = (weights, message) =>
    throws(
      () =>
        voronoiMapSimulation(weights)
          .weight((x) => x)
          .stop()
          .state(),
      'BAD_INPUT',
      message,
    );
  bad([1, -1], /weight 1/);
  bad([NaN], /weight 0/);
  bad([1, undefined], /weight 1/);
  bad([0, 0], /all weights are 0/);
});

test('voronoiMapSimulation: events come from the timer, and stop with it', async () => {
  const simulation = voronoiMapSimulation([1, 2, 3, 4, 5]).weight((x) => x);
  const seen = [];
  const finished = new Promise((resolve) => {
    simulation
      .on('tick', function () {
        assert.equal(this, simulation);
        seen.push(simulation.state().iterationCount);
      })
      .on('end.mine', resolve);
  });
  await finished;
  assert.ok(simulation.state().ended);
  assert.deepEqual(
    seen,
    seen.map((_, i) => i + 1),
  );
  assert.equal(typeof simulation.on('end.mine'), 'function');
  assert.equal(simulation.on('end.mine', null).on('end.mine'), undefined);
  throws(() => simulation.on('start', () => {}), 'BAD_INPUT', /unknown type: start/);
  // By hand there are none.
  const quiet = voronoiMapSimulation([1, 2])
    .weight((x) => x)
    .stop();
  quiet.on('tick end', () => assert.fail('an event'));
  ended(quiet);
  const again = voronoiMapSimulation([1, 2])
    .weight((x) => x)
    .stop();
  await new Promise((resolve) => again.on('end', resolve).restart());
  assert.ok(again.state().ended);
});

test('initial positions: around the middle, and at random', () => {
  const simulation = voronoiMapSimulation([1, 1, 1, 1]).size([4, 2]).stop();
  const pie = voronoiMapInitialPositionPie();
  const data = [1, 1, 1, 1];
  const places = data.map((d, i) => pie(d, i, data, simulation));
  [
    [2.5, 1],
    [2, 1.5],
    [1.5, 1],
    [2, 0.5],
  ].forEach(([x, y], i) => {
    isNear(places[i][0], x);
    isNear(places[i][1], y);
  });
  assert.equal(pie.startAngle(), 0);
  assert.equal(pie.startAngle(Math.PI), pie);
  isNear(pie(1, 0, data, simulation)[0], 1.5);

  simulation.clip([
    [0, 0],
    [0, 1],
    [1, 1],
  ]);
  const random = voronoiMapInitialPositionRandom();
  simulation.prng(randomFrom(3));
  for (let i = 0; i < 200; i++) {
    const [x, y] = random(1, i, data, simulation);
    assert.ok(x >= 0 && y <= 1 && x <= y, `${x} ${y}`);
  }
  const twice = [1, 2].map(() => {
    simulation.prng(randomFrom(3));
    return random(1, 0, data, simulation);
  });
  assert.deepEqual(twice[0], twice[1]);
});

test('voronoiTreemap: each node with a value has a polygon within that of its parent', () => {
  /** As d3.hierarchy(…).sum(…) makes them. */
  const node = (value, ...children) =>
    children.length
      ? { children, value: children.reduce((sum, child) => sum + child.value, 0) }
      : { value };
  const root = node(
    0,
    node(0, node(1), node(2), node(0)),
    node(3),
    node(0, node(4), node(5)),
    node(0),
  );
  assert.equal(voronoiTreemap().clip(HEXAGON)(root), undefined);
  isNear(areaOf(root.polygon), areaOf(HEXAGON));
  const check = (parent) => {
    for (const child of parent.children ?? []) {
      if (child.value === 0) assert.equal(child.polygon, undefined);
      else {
        const wanted = (child.value / parent.value) * areaOf(parent.polygon);
        assert.ok(Math.abs(areaOf(child.polygon) / wanted - 1) < 1.001e-3);
        assert.equal(child.polygon.site.originalObject.data.originalData, child);
        check(child);
      }
    }
  };
  check(root);
  // What has no value any more has no polygon any more.
  root.children[1].value = 0;
  root.value -= 3;
  voronoiTreemap().clip(HEXAGON)(root);
  assert.equal('polygon' in root.children[1], false);
  check(root);
  const leaf = { value: 1 };
  voronoiTreemap()(leaf);
  assert.deepEqual(leaf.polygon, SQUARE);
});

test('voronoiTreemap: settings', () => {
  const layout = voronoiTreemap();
  assert.deepEqual(
    [layout.convergenceRatio(), layout.maxIterationCount(), layout.minWeightRatio(), layout.prng()],
    [1e-3, 50, 0, Math.random],
  );
  const root = { value: 101, children: [{ value: 1 }, { value: 100 }] };
  assert.equal(layout.minWeightRatio(0.25), layout);
  layout(root);
  assert.ok(Math.abs(areaOf(root.children[0].polygon) - 0.2) < 1e-3);
});
