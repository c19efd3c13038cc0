// The GPU engine in the page, on Chromium's software rasteriser.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import {
  choose,
  colorBy,
  launch,
  open,
  pictureOf,
  serve,
  settled,
  shown,
  slide,
  tab,
  text,
} from './browser.mjs';

// The rasteriser takes long to compile the kernels.
const hang = 900_000;

let server;
let browser;
let page;
before(async () => {
  server = await serve();
  browser = await launch();
  page = await open(browser, `${server.url}#points=sphere_4000_1`, { hang });
});
after(async () => {
  await browser.close();
  await server.close();
});

/** What the page says of the present mesh, which comes from this engine. */
async function countOn(page, engine) {
  assert.ok((await text(page, 'engine-used')).startsWith(`On the ${engine}`));
  const count = await text(page, 'count');
  assert.match(count, / points → [\d,]+ (tetrahedra|triangles)$/);
  return count;
}

test('gives the same on GPU and CPU', async () => {
  const onCpu = await countOn(page, 'CPU');
  await choose(page, 'engine', 'gpu');
  assert.equal(await countOn(page, 'GPU'), onCpu);
});

test('shows a recorded run round by round', async () => {
  await tab(page, 'run');
  await page.click('#record');
  await settled(page);
  assert.ok(await page.locator('#recorded').isVisible());
  // What flipping leaves depends on which flips are first; now and then it is nothing.
  const repair = await text(page, 'repair');
  const isDelaunay = repair === 'Every facet was locally Delaunay after Phase 1.';
  if (!isDelaunay)
    assert.match(repair, /^Facets that were not .* Splaying repaired 100 % of them\./);
  const result = (await shown(page)).total;
  await slide(page, 'step', 0);
  assert.match(await text(page, 'step-label'), /^After round 1 of/);
  assert.ok((await shown(page)).total < result);
  await slide(page, 'step', 3);
  await pictureOf(page, 'round');
  await slide(page, 'step', 99);
  assert.equal(await text(page, 'step-label'), 'The result');
  await pictureOf(page, 'run');
  const canvas = page.locator('#canvas');
  const before = await canvas.screenshot();
  await page.check('#shade');
  await settled(page);
  await pictureOf(page, 'shaded');
  assert.equal(before.equals(await canvas.screenshot()), isDelaunay);
  await colorBy(page, 'phase');
  assert.equal(await text(page, 'legend-high'), '2: splayed');
  await pictureOf(page, 'phase');
});

test('shows what happened in the plane', async () => {
  const page = await open(browser, `${server.url}#dim=2&points=uniform_500_1&engine=gpu`, { hang });
  const onGpu = await countOn(page, 'GPU');
  await tab(page, 'run');
  await page.locator('#rounds-chart svg').first().waitFor();
  await pictureOf(page, 'plane-run');
  await tab(page, 'points');
  await choose(page, 'engine', 'cpu');
  assert.equal(await countOn(page, 'CPU'), onGpu);
  await page.context().close();
});
