// The GPU backend in the page, on Chromium's software rasteriser.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { choose, colorBy, open, pictureOf, settled, shown, slide, tab, text } from './browser.mjs';
import { site } from './site.mjs';

// The rasteriser takes long to compile the kernels.
const hang = 900_000;

let page;
const here = site({}, async ({ browser, url }) => {
  page = await open(browser, `${url}#points=sphere_4000_1`, { hang });
});

/** What the page says of the present mesh, which comes from this backend. */
async function countOn(page, backend) {
  assert.ok((await text(page, 'backend-used')).startsWith(`On the ${backend}`));
  const count = await text(page, 'count');
  assert.match(count, / points → [\d,]+ (tetrahedra|triangles)$/);
  return count;
}

test('gives the same on GPU and CPU', async () => {
  const onCpu = await countOn(page, 'CPU');
  await choose(page, 'backend', 'gpu');
  assert.equal(await countOn(page, 'GPU'), onCpu);
});

test('shows a recorded run round by round', async () => {
  // From the story for newcomers, on the points that are open.
  await page.click('#help');
  await page.click('#watch');
  await settled(page);
  assert.match(await text(page, 'count'), /^4,000 points/);
  assert.equal(await page.getAttribute('#tab-run', 'aria-selected'), 'true');
  assert.ok(await page.locator('#recorded').isVisible());
  // What flipping leaves depends on which flips are first; now and then it is nothing.
  const repair = await text(page, 'repair');
  const isDelaunay = repair === 'Every facet was locally Delaunay after Phase 1.';
  if (!isDelaunay)
    assert.match(repair, /^Facets that were not .* Star splaying repaired 100 % of them\./);
  const result = (await shown(page)).total;
  await slide(page, 'step', 0);
  assert.match(await text(page, 'step-label'), /^After round 1 of/);
  assert.ok((await shown(page)).total < result);
  await slide(page, 'step', 3);
  await pictureOf(page, '3d-round');
  await slide(page, 'step', 99);
  assert.equal(await text(page, 'step-label'), 'The result');
  await pictureOf(page, '3d-run');
  const canvas = page.locator('#canvas');
  const before = await canvas.screenshot();
  await page.check('#shade');
  await settled(page);
  await pictureOf(page, '3d-shaded');
  assert.equal(before.equals(await canvas.screenshot()), isDelaunay);
  await colorBy(page, 'phase');
  assert.equal(await text(page, 'legend-high'), '2: splayed');
  await pictureOf(page, '3d-phase');
});

test('shows what happened in 2D', async () => {
  const page = await open(here.browser, `${here.url}#dim=2&points=uniform_500_1&backend=gpu`, {
    hang,
  });
  const onGpu = await countOn(page, 'GPU');
  await tab(page, 'run');
  await page.locator('#rounds-chart svg').first().waitFor();
  await pictureOf(page, '2d-run');
  await tab(page, 'points');
  await choose(page, 'backend', 'cpu');
  assert.equal(await countOn(page, 'CPU'), onGpu);
  await page.context().close();
});
