// The installed package in Debian's Firefox ESR, which has no WebGPU: the CPU backend works, and
// says why.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launchFirefox } from './browsers.mjs';
import { dist, pinned, project, root } from './package.mjs';
import { testPages } from './pages.mjs';
import { serve } from './server.mjs';

const folders = { '/gdel/': dist(project()), '/tests/': `${root}/tests/web` };

let browser, server;
before(async () => {
  server = await serve(folders);
  browser = await launchFirefox();
});
after(async () => {
  await browser?.close();
  server?.close();
});

test('the CPU backend gives the native meshes, in a worker, and says why', async () => {
  const page = await browser.newPage();
  await page.goto(server.url);
  for (const { kind, count, seed, fingerprint } of pinned) {
    const found = await page.evaluate(
      async ({ kind, count, seed }) => {
        const { delaunay3d, generate } = await import('/gdel/index.js');
        const { fingerprint } = await import('/tests/fingerprints.mjs');
        const mesh = await delaunay3d(await generate(kind, count, { seed }));
        return { fingerprint: fingerprint(mesh.tetrahedra), stats: mesh.stats };
      },
      { kind, count, seed },
    );
    assert.equal(found.fingerprint, fingerprint, kind);
    assert.equal(found.stats.backend, 'cpu');
    assert.equal(found.stats.thread, 'worker');
    // From how many points on it looks for a GPU depends on the speed of the CPU.
    assert.match(found.stats.fallback, /WebGPU is not available|too few/);
  }
  await page.close();
});

test('an abort takes effect at once, and the triangulator keeps working', async () => {
  const page = await browser.newPage();
  await page.goto(server.url);
  const found = await page.evaluate(async () => {
    const { delaunay3d, generate } = await import('/gdel/index.js');
    const { abortOf } = await import('/tests/abort.mjs');
    const points = await generate('uniform', 200_000);
    const aborted = await abortOf((options) => delaunay3d(points, options), 'insert');
    const next = await delaunay3d([
      [0, 0, 0],
      [1, 0, 0],
      [0, 1, 0],
      [0, 0, 1],
    ]);
    return { ...aborted, next: next.tetrahedra.length };
  });
  assert.deepEqual(found, { code: 'ABORTED', atOnce: true, next: 4 });
  await page.close();
});

testPages(() => browser, folders);
