// The GPU engine in the page, on Chromium's software rasteriser.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { choose, drawn, launch, open, pictureOf, serve, shown, slide, tab, text } from './browser.mjs';

let server;
let browser;
let page;
before(async () => {
  server = await serve();
  browser = await launch();
  page = await open(browser, `${server.url}#points=sphere_4000_1`);
  page.setDefaultTimeout(900_000);
});
after(async () => {
  await browser.close();
  await server.close();
});

/** Waits until an engine's result is in, and gives what the page says of it, which it writes together with the engine. */
async function countOn(engine) {
  await page.waitForFunction((start) => document.querySelector('#engine-used').textContent.startsWith(start), `On the ${engine}`);
  await drawn(page);
  const count = await text(page, 'count');
  assert.match(count, / points → [\d,]+ (tetrahedra|triangles)$/);
  return count;
}

test('gives the same on GPU and CPU', async () => {
  const onCpu = await countOn('CPU');
  await choose(page, 'engine', 'gpu');
  assert.equal(await countOn('GPU'), onCpu);
});

test('shows a recorded run round by round', async () => {
  await tab(page, 'run');
  await page.click('#record');
  await page.locator('#recorded').waitFor();
  // What flipping leaves depends on which flips are first; now and then it is nothing.
  const repair = await text(page, 'repair');
  const isDelaunay = repair === 'Every facet was locally Delaunay after Phase 1.';
  if (!isDelaunay) assert.match(repair, /^Facets that were not .* Splaying repaired 100 % of them\./);
  const result = (await shown(page)).total;
  await slide(page, 'step', 0);
  await page.waitForFunction(() => document.querySelector('#step-label').textContent.startsWith('After round 1 of'));
  await page.waitForFunction((total) => !document.querySelector('#shown').textContent.includes(total), result.toLocaleString('en'));
  assert.ok((await shown(page)).total < result);
  await slide(page, 'step', 3);
  await pictureOf(page, 'round');
  await slide(page, 'step', 99);
  await page.waitForFunction(() => document.querySelector('#step-label').textContent === 'The result');
  await pictureOf(page, 'run');
  const canvas = page.locator('#canvas');
  const before = await canvas.screenshot();
  await page.check('#shade');
  await pictureOf(page, 'shaded');
  assert.equal(before.equals(await canvas.screenshot()), isDelaunay);
  await tab(page, 'view');
  await page.selectOption('#color', 'phase');
  await page.waitForFunction(() => document.querySelector('#legend-high').textContent === '2: splayed');
  await pictureOf(page, 'phase');
});

test('shows what happened in the plane', async () => {
  await page.goto(`${server.url}#dim=2&points=uniform_500_1&engine=gpu`);
  await page.reload();
  const onGpu = await countOn('GPU');
  await tab(page, 'run');
  await page.locator('#rounds-chart svg').first().waitFor();
  await pictureOf(page, 'plane-run');
  await tab(page, 'points');
  await choose(page, 'engine', 'cpu');
  assert.equal(await countOn('CPU'), onGpu);
});
