// What the backend `auto` does while kernels are compiled, and what it knows on a later visit: in Chromium,
// whose software adapter passes for another one.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { launchChromium, WEBGPU } from './browsers.mjs';
import { dist, project, root } from './package.mjs';
import { serve } from './server.mjs';

const browser = await launchChromium(WEBGPU);
const server = await serve({ '/gdel/': dist(project()), '/tests/': `${root}/tests/web` });
after(async () => {
  await browser.close();
  server.close();
});

const { version } = JSON.parse(readFileSync(join(root, 'web/package.json'), 'utf8'));

/**
 * Runs `auto` on 60 points of a distribution until the GPU makes the mesh, on a page that was visited
 * before: the CPU took a second for a thousand points, the GPU a millisecond, and the kernels so many
 * microseconds to compile. Pauses between two runs.
 */
async function untilOnGpu(kind, compiling, pause) {
  const context = await browser.newContext();
  const page = await context.newPage();
  await page.goto(server.url);
  const found = await page.evaluate(
    async ({ kind, version, compiling, pause }) => {
      const { createTriangulator, delaunay3d, generate } = await import('/gdel/index.js');
      const { fingerprint } = await import('/tests/fingerprints.mjs');
      const { like } = await import('/tests/like.mjs');
      const info = { vendor: 'a', architecture: 'b', device: 'c', description: 'd' };
      const gpu = {
        async requestAdapter(options) {
          const adapter = await navigator.gpu.requestAdapter(options);
          const requestDevice = async (descriptor) =>
            like(await adapter.requestDevice(descriptor), { adapterInfo: info });
          return like(adapter, { info, requestDevice });
        },
      };

      const name = [version, 3, 'a', 'b', 'c', 'd', navigator.userAgent].join();
      const sizes = 14;
      const run = (points, time, rest) => [points, time, ...Array(rest).fill(0)];
      const isProven = 1;
      const before = [
        isProven,
        compiling,
        ...run(1_024, 1_000_000, 2 * sizes - 2),
        ...run(1_024, 1_000, 2 * sizes - 2),
      ];
      const result = (request) =>
        new Promise((resolve, reject) => {
          request.onsuccess = () => resolve(request.result);
          request.onerror = () => reject(request.error);
        });
      const opened = indexedDB.open('gdel', 1);
      opened.onupgradeneeded = () => opened.result.createObjectStore('devices');
      const database = await result(opened);
      const store = () => database.transaction('devices', 'readwrite').objectStore('devices');
      await result(store().put(Uint32Array.from(before), name));

      const points = await generate(kind, 60);
      const expected = fingerprint((await delaunay3d(points, { backend: 'cpu' })).tetrahedra);
      const triangulator = await createTriangulator({ gpu });
      const stats = [];
      while (stats.at(-1)?.backend !== 'gpu') {
        const mesh = await triangulator.delaunay3d(points);
        if (fingerprint(mesh.tetrahedra) !== expected) throw new Error('another mesh');
        stats.push(mesh.stats);
        // The device and the database answer between two runs, and need the processor.
        await new Promise((resolve) => setTimeout(resolve, pause));
      }
      const wasKept = async () => {
        const [, lately] = await result(store().get(name));
        return lately !== compiling;
      };
      while (!(await wasKept())) await new Promise((resolve) => setTimeout(resolve));
      const names = await result(store().getAllKeys());
      return { stats, names, info: triangulator.info };
    },
    { kind, version, compiling, pause },
  );
  await context.close();
  return found;
}

test('the CPU triangulates until the kernels are compiled', async () => {
  // The points of a grid, for which the kernels of other points serve at first.
  const { stats, names, info } = await untilOnGpu('grid', 3_600_000_000, 100);
  assert.equal(info.backend, 'gpu');
  assert.equal(names.length, 1, 'what was known is known under the same name');
  assert.equal(stats.at(-1).fallback, null);
  assert.ok(stats.length > 1, 'nothing is compiled at once');
  for (const { backend, fallback } of stats.slice(0, -1)) {
    assert.equal(backend, 'cpu');
    assert.match(fallback, /60 points take the CPU less time than it takes to compile the kernels/);
  }
});

test('runs that keep the worker busy do not put off the GPU for longer than it takes to compile', async () => {
  const { stats } = await untilOnGpu('uniform', 150_000, 0);
  // 60 points take the CPU 58 ms by that: two runs have lost 116, and the third waits for 34.
  assert.ok(stats.length <= 3, `the GPU makes mesh ${stats.length}`);
});
