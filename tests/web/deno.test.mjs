// The installed package in Deno: the web's build, with a worker, from files.

import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { test } from 'node:test';
import { pinned, project, root } from './package.mjs';

// As scripts/setup.sh installs it, or the machine's.
const runs = (command) => spawnSync(command, ['--version']).status === 0;
const deno = [join(root, '.cache/tools/node_modules/.bin/deno'), 'deno'].find(runs);
const skip = deno
  ? false
  : 'Deno is not installed, and scripts/setup.sh found none for this machine';

const SCRIPT = `
  import { createEngine, Delaunator, delaunay2d, delaunay3d, generate, verify } from 'gdel-wasm';
  import { fingerprint } from ${JSON.stringify(join(root, 'tests/web/fingerprints.mjs'))};
  const [{ kind, count, seed }] = JSON.parse(Deno.args[0]);
  const points = await generate(kind, count, { seed });
  const mesh = await delaunay3d(points, { engine: 'cpu' });
  const { passed } = await verify(points, mesh);
  const engine = await createEngine();
  await Delaunator.load();
  const square = [[0, 0], [1, 0], [0, 1], [1, 1]];
  console.log(JSON.stringify({
    resolved: import.meta.resolve('gdel-wasm'),
    fingerprint: fingerprint(mesh.tetrahedra),
    thread: mesh.stats.thread,
    passed,
    info: engine.info,
    triangles: [(await delaunay2d(square)).triangles.length, Delaunator.from(square).triangles.length],
    failed: await delaunay3d([[0, NaN, 0]]).catch(({ code }) => code),
  }));
  engine.dispose();
`;

// No driver: what Deno's own WebGPU makes of those that a machine has, software ones first of all, is not what is tested.
const env = {
  ...process.env,
  NO_COLOR: '1',
  DENO_NO_UPDATE_CHECK: '1',
  VK_DRIVER_FILES: '/nowhere',
  __EGL_VENDOR_LIBRARY_FILENAMES: '/nowhere',
};

/** No machine needs nearly as long. */
const HANG = 300_000;

/** The first line that a program prints. It is stopped then, with all that it started: Deno waits for workers, even idle ones. */
async function firstLine(command, args, options) {
  const child = spawn(command, args, {
    ...options,
    stdio: ['ignore', 'pipe', 'inherit'],
    detached: true,
  });
  const stop = () => {
    try {
      process.kill(-child.pid, 'SIGKILL');
    } catch (error) {
      if (error.code !== 'ESRCH') throw error;
    }
  };
  const timer = setTimeout(stop, HANG);
  try {
    for await (const line of createInterface({ input: child.stdout })) return line;
    throw new Error('it printed nothing, or hung');
  } finally {
    clearTimeout(timer);
    stop();
  }
}

test('in Deno, the mesh is the native one, from a worker', { skip }, async () => {
  const folder = project({ 'script.mjs': SCRIPT });
  const args = [
    'run',
    '--no-prompt',
    '--allow-read',
    '--node-modules-dir=manual',
    'script.mjs',
    JSON.stringify(pinned),
  ];
  const found = JSON.parse(await firstLine(deno, args, { cwd: folder, env }));
  assert.match(found.resolved, /\/dist\/index\.js$/);
  assert.equal(found.fingerprint, pinned[0].fingerprint);
  assert.equal(found.thread, 'worker');
  assert.equal(found.passed, true);
  assert.deepEqual(found.triangles, [6, 6]);
  assert.equal(found.failed, 'NOT_FINITE');
  assert.equal(found.info.engine, 'cpu');
  assert.ok(found.info.why, JSON.stringify(found.info));
});
