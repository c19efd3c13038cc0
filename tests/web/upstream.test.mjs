// The tests of delaunator and d3-delaunay on the class Delaunator, against their own.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import Theirs from 'delaunator';
import { dist, importFrom, project, root } from './package.mjs';

const folder = project();
const { Delaunator } = await importFrom(folder, 'delaunator.js');
await Delaunator.load();

/**
 * What our class does not pass, and why. The README says the same to users.
 */
const DIFFERENT = {
  'delaunator/test/test.js': {
    robustness:
      'all points are vertices, of which delaunator drops some: the areas of the thin triangles are summed less exactly',
  },
  'd3-delaunay/test/delaunay-test.js': {
    'Delaunay.from(array)': 'the order of triangles',
    'Delaunay.from(iterable)': 'the order of triangles',
    'Delaunay.from(iterable, fx, fy)': 'the order of triangles',
    'Delaunay.from({length}, fx, fy)': 'the order of triangles',
    'delaunay.update() allows fast updates': 'the order of triangles',
  },
  'd3-delaunay/test/voronoi-test.js': {
    'a degenerate triangle is avoided': 'cocircular points: another of several right answers',
  },
};

/** The names of the tests in a file, and those that failed. */
function run(file, delaunator) {
  const args = ['--import', pathToFileURL(join(root, 'tests/web/upstream.mjs')).href];
  const { NODE_TEST_CONTEXT: _, ...env } = process.env;
  if (delaunator) env.GDEL_DELAUNATOR = delaunator;
  const { stdout, stderr } = spawnSync(
    process.execPath,
    [...process.execArgv, ...args, '--test-reporter=tap', join(root, 'tests/data', file)],
    { env, encoding: 'utf8' },
  );
  const results = [...stdout.matchAll(/^(not )?ok \d+ - (.*)$/gm)];
  assert.ok(results.length > 10, stderr);
  const name = ([, , name]) => name.replaceAll('\\#', '#').trim();
  return { all: results.map(name), failed: results.filter(([, not]) => not).map(name) };
}

for (const [file, different] of Object.entries(DIFFERENT)) {
  test(`${file}: all tests pass but those with a reason`, () => {
    const theirs = run(file);
    assert.deepEqual(theirs.failed, []);
    const ours = run(file, pathToFileURL(join(dist(folder), 'delaunator.js')).href);
    assert.deepEqual(ours.all, theirs.all);
    assert.deepEqual(ours.failed, Object.keys(different));
  });
}

/** The same in every run: SplitMix32, as a number from 0 to 1. */
function random(seed) {
  return () => {
    seed = (seed + 0x9e3779b9) | 0;
    let t = Math.imul(seed ^ (seed >>> 16), 0x21f0aaad);
    t = Math.imul(t ^ (t >>> 15), 0x735a2d97);
    return ((t ^ (t >>> 15)) >>> 0) / 2 ** 32;
  };
}

test('in general position, the hull is the same array, from its first vertex on', () => {
  const next = random(1);
  for (let count = 3; count < 400; count++) {
    const coords = Float64Array.from({ length: 2 * count }, next);
    assert.deepEqual(new Delaunator(coords).hull, new Theirs(coords).hull, `${count} points`);
  }
});

test('a triangle alone is the same array, also with duplicates', () => {
  const next = random(2);
  for (let i = 0; i < 500; i++) {
    const coords = Array.from({ length: 6 }, () => Math.floor(100 * next()));
    if (i % 2) coords.push(...coords.slice(2 * (i % 3), 2 * (i % 3) + 2));
    const [ours, theirs] = [new Delaunator(coords), new Theirs(coords)];
    assert.deepEqual(ours.triangles, theirs.triangles, `${coords}`);
    assert.deepEqual(ours.hull, theirs.hull, `${coords}`);
  }
});

function messageOf(Class, coords) {
  try {
    return String(new Class(coords));
  } catch ({ message }) {
    return message;
  }
}

test('messages are those of delaunator, and more', () => {
  for (const coords of [
    [
      [0, 0],
      [1, 0],
    ],
    { length: -1 },
    ['0', 1],
  ]) {
    const [theirs, ours] = [Theirs, Delaunator].map((Class) => messageOf(Class, coords));
    assert.ok(ours.includes(theirs.replace(/\.$/, '')), `${ours}, not ${theirs}`);
  }
});

test('half a point does not count', () => {
  for (const coords of [[0], [0, 0, 1, 0, 0, 1, 7], Float64Array.of(0, 0, 1, 0, 0, 1, 7)]) {
    const [ours, theirs] = [new Delaunator(coords), new Theirs(coords)];
    assert.deepEqual(ours.triangles, theirs.triangles);
    assert.deepEqual(ours.hull, theirs.hull);
  }
});

test('coordinates that are NaN are an error, where delaunator’s result is wrong', () => {
  const coords = [0, 0, NaN, 0, 1, 0, 0, 1, 1, 1];
  assert.ok(new Theirs(coords).hull.length < 4 || new Theirs(coords).triangles.length !== 6);
  assert.throws(() => new Delaunator(coords), { code: 'NOT_FINITE', index: 1 });
});
