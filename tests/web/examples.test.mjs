// The example pages in headless Chromium, with WebGPU on SwiftShader.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launchChromium, WEBGPU_DRAWING } from './browsers.mjs';
import { dist, project, root } from './package.mjs';
import { serve } from './server.mjs';

let browser;
let server;
before(async () => {
  browser = await launchChromium(WEBGPU_DRAWING);
  server = await serve({
    '/gdel/': dist(project()),
    '/three/': `${root}/node_modules/three/build`,
    '/examples/': `${root}/web/examples`,
  });
});
after(async () => {
  await browser.close();
  server.close();
});

for (const name of ['resident', 'resident-three']) {
  test(`${name}.html draws a mesh from the buffers of its device`, async () => {
    const page = await browser.newPage();
    const errors = [];
    page.on('pageerror', (error) => errors.push(error.message));
    // WebGPU reports what it rejects as warnings.
    page.on('console', (message) => {
      if (['error', 'warning'].includes(message.type())) errors.push(message.text());
    });
    await page.goto(`${server.url}/examples/${name}.html`);
    await Promise.race([
      page.waitForFunction(() => document.body?.dataset.drawn, null, { timeout: 0 }),
      new Promise((_, reject) => page.on('pageerror', reject)),
    ]);
    const { drawn, colors } = await page.evaluate(async () => {
      const canvas = document.querySelector('canvas');
      const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
      // In the frame that the page has just drawn.
      await new Promise((resolve) =>
        requestAnimationFrame(() => resolve(copy.drawImage(canvas, 0, 0))),
      );
      const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
      return {
        drawn: Number(document.body.dataset.drawn),
        colors: new Set(new Uint32Array(data.buffer)).size,
      };
    });
    assert.ok(drawn > 100, String(drawn));
    // The facets have different normals.
    assert.ok(colors > 20, String(colors));
    // Of the icon that browsers ask for.
    const known = /404/;
    assert.deepEqual(
      errors.filter((error) => !known.test(error)),
      [],
    );
    await page.close();
  });
}
