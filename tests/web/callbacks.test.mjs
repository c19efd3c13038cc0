// What happens when the caller's own functions throw.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { after, test } from 'node:test';
import { importFrom, project } from './package.mjs';

const folder = project({
  'main.mjs': `
    import { delaunay3d, generate } from 'gdel-wasm';
    const mine = new TypeError('mine');
    const fails = { onProgress() { throw mine; } };
    const points = await generate('uniform', 50_000);
    const error = await delaunay3d(points, fails).catch((error) => error);
    console.log(error === mine, (await delaunay3d([[0, 0, 0]])).dimension);`,
});
const { createTriangulator, generate } = await importFrom(folder);
const points = await generate('uniform', 50_000);
const triangulators = {
  'in a worker': await createTriangulator({ backend: 'cpu' }),
  'in the calling thread': await createTriangulator({ backend: 'cpu', worker: false }),
};
after(() => {
  for (const triangulator of Object.values(triangulators)) triangulator.dispose();
});

for (const [where, triangulator] of Object.entries(triangulators)) {
  for (const [what, fail] of [
    [
      'throws',
      (error) => () => {
        throw error;
      },
    ],
    [
      'rejects',
      (error) => async () => {
        throw error;
      },
    ],
  ]) {
    test(`${where}, onProgress ${what}: the run is rejected with that very error`, async () => {
      const mine = new TypeError('mine');
      let calls = 0;
      const onProgress = () => {
        calls++;
        return fail(mine)();
      };
      const error = await triangulator.delaunay3d(points, { onProgress }).catch((error) => error);
      assert.equal(error, mine);
      if (what === 'throws') assert.equal(calls, 1);
      assert.equal((await triangulator.delaunay3d(points)).dimension, 3);
    });
  }

  test(`${where}, what onProgress throws need not be an error`, async () => {
    for (const thrown of [undefined, null, 0, 'mine', new DOMException('mine', 'AbortError')]) {
      const onProgress = () => {
        throw thrown;
      };
      let caught = 'nothing';
      await triangulator.delaunay3d(points, { onProgress }).catch((error) => (caught = error));
      assert.equal(caught, thrown);
    }
  });
}

test('a process survives an onProgress that throws', () => {
  const args = [...process.execArgv, 'main.mjs'];
  const output = execFileSync(process.execPath, args, { cwd: folder, encoding: 'utf8' });
  assert.equal(output, 'true 0\n');
});

test('an error in an accessor is the caller’s own, and leaves everything usable', async () => {
  const [triangulator] = Object.values(triangulators);
  const mine = new RangeError('mine');
  const point = () => {
    throw mine;
  };
  const error = await triangulator.delaunay3d([1], { point }).catch((error) => error);
  assert.equal(error, mine);
  assert.equal((await triangulator.delaunay3d(points)).dimension, 3);
});
