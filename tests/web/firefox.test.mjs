// The installed package in Debian's Firefox ESR, which has no WebGPU: the CPU engine works, and says why.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import puppeteer from 'puppeteer-core';
import { dist, leastOfThree, pinned, project, root } from './package.mjs';
import { serve } from './server.mjs';

let browser, server;
before(async () => {
  server = await serve({ '/gdel/': dist(project()), '/tests/': `${root}/tests/web` });
  browser = await puppeteer.launch({ browser: 'firefox', executablePath: '/usr/bin/firefox-esr', headless: true });
});
after(async () => {
  await browser?.close();
  server?.close();
});

test('the CPU engine gives the native meshes, in a worker, and says why', async () => {
  const page = await browser.newPage();
  await page.goto(server.url);
  for (const { kind, count, seed, fingerprint } of pinned) {
    const found = await page.evaluate(
      async (kind, count, seed) => {
        const { delaunay3d, generate } = await import('/gdel/index.js');
        const { fingerprint } = await import('/tests/fingerprints.mjs');
        const mesh = await delaunay3d(await generate(kind, count, { seed }));
        return { fingerprint: fingerprint(mesh.tetrahedra), stats: mesh.stats };
      },
      kind,
      count,
      seed,
    );
    assert.equal(found.fingerprint, fingerprint, kind);
    assert.equal(found.stats.engine, 'cpu');
    assert.equal(found.stats.thread, 'worker');
    assert.match(found.stats.why, count > 24_000 ? /WebGPU is not available/ : /too few/);
  }
});

test('an abort takes effect within 100 ms, and the engine goes on', async () => {
  const page = await browser.newPage();
  await page.goto(server.url);
  const milliseconds = await leastOfThree(() =>
    page.evaluate(async () => {
      const { delaunay3d, generate } = await import('/gdel/index.js');
      const controller = new AbortController();
      let aborted;
      const onProgress = ({ phase }) => {
        if (phase !== 'insert') return;
        aborted ??= performance.now();
        controller.abort();
      };
      const run = delaunay3d(await generate('uniform', 200_000), { signal: controller.signal, onProgress });
      const code = await run.catch((error) => error.code);
      const milliseconds = performance.now() - aborted;
      if (code !== 'ABORTED') throw new Error(code);
      const next = await delaunay3d([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]);
      if (next.tetrahedra.length !== 4) throw new Error('the engine does not go on');
      return milliseconds;
    }),
  );
  assert.ok(milliseconds < 100, `${milliseconds}`);
});
