// `require`: with Node's own ES modules where Node can require them, and otherwise with the build for
// that, which jest takes as well.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { test } from 'node:test';
import { project } from './package.mjs';

const SCRIPT = `
  const gdel = require('gdel-wasm');
  const { Delaunator, default: byDefault } = require('gdel-wasm/delaunator');
  (async () => {
    const points = await gdel.generate('ball', 1000);
    const mesh = await gdel.delaunay3d(points);
    await gdel.load3d();
    await Delaunator.load();
    const caller = await gdel.createTriangulator({ worker: false });
    const inline = await require('gdel-wasm/inline').delaunay3d([[0, 0, 0]]);
    console.log(JSON.stringify({
      passed: (await gdel.verify(points, mesh)).passed,
      place: [mesh.stats.thread, mesh.stats.whyInlined],
      sync: gdel.delaunay3dSync(points).tetrahedra.length === mesh.tetrahedra.length,
      same: Delaunator === gdel.Delaunator && byDefault === Delaunator,
      triangles: Delaunator.from([[0, 0], [1, 0], [0, 1]]).triangles.length,
      caller: (await caller.delaunay3d(points)).stats.thread,
      inline: inline.dimension,
      error: await gdel.delaunay3d([NaN, 0, 0]).catch((error) => error instanceof gdel.GdelError && error.code),
    }));
  })();
`;
const EXPECTED = {
  passed: true,
  place: ['worker', null],
  sync: true,
  same: true,
  triangles: 3,
  caller: 'caller',
  inline: 0,
  error: 'NOT_FINITE',
};

const folder = project({ 'main.cjs': SCRIPT });

function run(...flags) {
  const args = [...process.execArgv, ...flags, 'main.cjs'];
  const options = { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] };
  return JSON.parse(execFileSync(process.execPath, args, options));
}

test('require works', () => assert.deepEqual(run(), EXPECTED));

const flags = process.allowedNodeEnvironmentFlags;
const canRequire = flags.has('--experimental-require-module');

test('require works where Node cannot require ES modules', {
  skip: !canRequire && 'this Node cannot, so that was tested already',
}, () => {
  assert.deepEqual(run('--no-experimental-require-module'), EXPECTED);
});

test('require and import share their classes where Node can require ES modules', {
  skip: !process.features.require_module && 'this Node cannot',
}, async () => {
  const required = createRequire(join(folder, 'main.cjs'))('gdel-wasm');
  const imported = await import(createRequire(join(folder, 'main.cjs')).resolve('gdel-wasm'));
  assert.equal(required.GdelError, imported.GdelError);
});
