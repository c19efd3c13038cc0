import assert from 'node:assert/strict';
import { test } from 'node:test';
import { OBJECTS } from '../../src/model/objects';
import { SAMPLES } from '../../src/model/source';
import { inWords } from '../../src/ui/firstVisit';

test('the objects of the gallery have as many points as it says, and are the same every time', () => {
  for (const [name, make] of Object.entries(OBJECTS)) {
    const points = make();
    assert.equal(points.length / 3, SAMPLES[name as keyof typeof OBJECTS].points, name);
    assert.ok(points.every(Number.isFinite), name);
    assert.deepEqual(make(), points, name);
    for (let axis = 0; axis < 3; axis++) {
      const along = points.filter((_, i) => i % 3 === axis);
      assert.ok(Math.min(...along.slice(0, 9999)) < Math.max(...along.slice(0, 9999)), name);
    }
  }
});

test('there are 60 atoms in a fullerene, each with three bonds', () => {
  // Of a ball with a radius of 0.6 around each, and of tubes half as wide between them.
  const points = OBJECTS.fullerene();
  let farthest = 0;
  for (let i = 0; i < points.length; i += 3)
    farthest = Math.max(farthest, Math.hypot(points[i], points[i + 1], points[i + 2]));
  const golden = (1 + Math.sqrt(5)) / 2;
  assert.ok(Math.abs(farthest - Math.sqrt(1 + 9 * golden ** 2) - 0.6) < 0.01, String(farthest));
});

test('a time in words', () => {
  assert.equal(inWords(12), 'less than a tenth of a second');
  assert.equal(inWords(120), 'a tenth of a second');
  assert.equal(inWords(240), 'a quarter of a second');
  assert.equal(inWords(323), 'a third of a second');
  assert.equal(inWords(1100), 'about a second');
  assert.equal(inWords(2600), 'about three seconds');
  assert.equal(inWords(61_000), 'about 61 seconds');
});
