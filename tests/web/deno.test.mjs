// The installed package in Deno: the web's build, with a worker, from files.

import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { join } from 'node:path';
import { test } from 'node:test';
import { pinned, project, root } from './package.mjs';

// As scripts/setup.sh installs it, or the machine's.
const runs = (command) => spawnSync(command, ['--version']).status === 0;
const deno = [join(root, '.cache/tools/node_modules/.bin/deno'), 'deno'].find(runs);
const skip = deno
  ? false
  : 'Deno is not installed, and scripts/setup.sh found none for this machine';

const SCRIPT = `
  import { createTriangulator, Delaunator, delaunay2d, delaunay3d, generate, verify } from 'gdel-wasm';
  import { fingerprint } from ${JSON.stringify(join(root, 'tests/web/fingerprints.mjs'))};
  const [{ kind, count, seed }] = JSON.parse(Deno.args[0]);
  const points = await generate(kind, count, { seed });
  const mesh = await delaunay3d(points, { backend: 'cpu' });
  const { passed } = await verify(points, mesh);
  const triangulator = await createTriangulator();
  await Delaunator.load();
  const square = [[0, 0], [1, 0], [0, 1], [1, 1]];
  console.log(JSON.stringify({
    resolved: import.meta.resolve('gdel-wasm'),
    fingerprint: fingerprint(mesh.tetrahedra),
    thread: mesh.stats.thread,
    whyInlined: mesh.stats.whyInlined,
    passed,
    info: triangulator.info,
    triangles: [(await delaunay2d(square)).triangles.length, Delaunator.from(square).triangles.length],
    failed: await delaunay3d([[0, NaN, 0]]).catch(({ code }) => code),
  }));
`;

// No driver: what Deno's own WebGPU makes of those that a machine has, software ones first of all,
// is not what is tested.
const env = {
  ...process.env,
  NO_COLOR: '1',
  DENO_NO_UPDATE_CHECK: '1',
  VK_DRIVER_FILES: '/nowhere',
  __EGL_VENDOR_LIBRARY_FILENAMES: '/nowhere',
};

/** No machine needs nearly as long. */
const HANG = 300_000;

/** What a program prints until it ends, which it does by itself. */
function outputOf(...args) {
  const options = { cwd: folder, env, encoding: 'utf8', timeout: HANG };
  const stdio = ['ignore', 'pipe', 'inherit'];
  const flags = ['run', '--no-prompt', '--node-modules-dir=manual'];
  return JSON.parse(execFileSync(deno, [...flags, ...args], { ...options, stdio }));
}

const folder = project({ 'script.mjs': SCRIPT });

test('in Deno, the mesh is the native one, from a worker, and the process ends', { skip }, () => {
  const found = outputOf('--allow-read', 'script.mjs', JSON.stringify(pinned));
  assert.match(found.resolved, /\/dist\/index\.js$/);
  assert.equal(found.fingerprint, pinned[0].fingerprint);
  assert.deepEqual([found.thread, found.whyInlined], ['worker', null]);
  assert.equal(found.passed, true);
  assert.deepEqual(found.triangles, [6, 6]);
  assert.equal(found.failed, 'NOT_FINITE');
  assert.equal(found.info.backend, 'cpu');
  assert.ok(found.info.fallback, JSON.stringify(found.info));
});

test('in Deno without any permission, the copies are imported', { skip }, () => {
  const found = outputOf('script.mjs', JSON.stringify(pinned));
  assert.equal(found.fingerprint, pinned[0].fingerprint);
  assert.equal(found.thread, 'worker');
  assert.match(found.whyInlined, /--allow-read/);
});
