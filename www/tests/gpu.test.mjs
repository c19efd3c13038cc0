// The GPU engine in the page. Chromium's software rasteriser takes minutes to compile the kernels on a slow machine.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, open, pictureOf, serve, shown, slide, tab, text } from './browser.mjs';

let server;
let browser;
let page;
before(async () => {
  server = await serve();
  browser = await launch();
  page = await open(browser, `${server.url}#points=ball_1000_1`);
  page.setDefaultTimeout(900_000);
});
after(async () => {
  await browser.close();
  await server.close();
});

test('gives the same on GPU and CPU', async () => {
  const onCpu = (await shown(page)).total;
  await page.locator('input[name=engine][value=gpu]').evaluate((radio) => radio.click());
  await page.waitForFunction(() => document.querySelector('#engine-used').textContent.startsWith('On the GPU'));
  assert.equal((await shown(page)).total, onCpu);
});

test('shows a recorded run round by round', async () => {
  await tab(page, 'run');
  await page.click('#record');
  await page.locator('#recorded').waitFor();
  assert.match(await text(page, 'repair'), /\d+ facets, .* were not locally Delaunay after Phase 1/);
  const result = (await shown(page)).total;
  await slide(page, 'step', 0);
  await page.waitForFunction(() => document.querySelector('#step-label').textContent.startsWith('After round 1 of'));
  await page.waitForFunction((total) => !document.querySelector('#shown').textContent.includes(total), result.toLocaleString('en'));
  assert.ok((await shown(page)).total < result);
  await slide(page, 'step', 3);
  await pictureOf(page, 'round');
  await page.check('#shade');
  await pictureOf(page, 'run');
});
