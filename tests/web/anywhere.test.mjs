// The installed package in the browser that BROWSER names: `chromium`, or `safari` on macOS.
//
// With GDEL_REAL_GPU=1, Chromium has to find a GPU that is no software.

import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { launchChromium, WEBGPU } from './browsers.mjs';
import { dist, pinned, project, root } from './package.mjs';
import { inSafari } from './safari.mjs';
import { serve } from './server.mjs';

const name = process.env.BROWSER ?? 'chromium';
const isOnHardware = Boolean(process.env.GDEL_REAL_GPU) && name === 'chromium';

const server = await serve({ '/gdel/': dist(project()), '/tests/': `${root}/tests/web` });
after(() => server.close());

/** Runs a module in a page in Chromium. Returns what it has set `globalThis.found` to. */
async function inChromium(url, module) {
  const browser = await launchChromium(WEBGPU);
  try {
    const page = await browser.newPage();
    await page.goto(url);
    await page.addScriptTag({ type: 'module', content: module });
    const found = await page.waitForFunction(() => globalThis.found, null, { timeout: 0 });
    return await found.jsonValue();
  } finally {
    await browser.close();
  }
}

const BROWSERS = { chromium: inChromium, safari: inSafari };

test(`${name} makes the native meshes`, { timeout: 1_800_000 }, async (context) => {
  const module = `
    import { check } from '/tests/anywhere.mjs';
    check(${JSON.stringify(pinned)}).then(
      (found) => (globalThis.found = found),
      (error) => (globalThis.found = { failed: String(error), stack: error.stack }),
    );`;
  const found = await BROWSERS[name](server.url, module);
  assert.equal(found.failed, undefined, found.stack);
  assert.deepEqual(found.wrong, []);
  const { adapter, code, message } = found;
  context.diagnostic(adapter ? `adapter: ${JSON.stringify(adapter)}` : `no GPU: ${message}`);
  if (!adapter) assert.equal(code, 'NO_ADAPTER');
  if (isOnHardware) assert.equal(adapter?.software, false);
  else if (name === 'chromium') assert.ok(adapter);
});
