// Polygons on the page: drawn by hand or from files, their mesh, and its refinement by sliders.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import {
  addressOf,
  choose,
  drop,
  expectAccessible,
  hrefOf,
  numbers,
  open,
  openOnPhone,
  pictureOf,
  prove,
  save,
  settled,
  slide,
  tab,
  text,
  until,
} from './browser.mjs';
import { site } from './site.mjs';

const here = site({ webgpu: false });
const folder = mkdtempSync(join(tmpdir(), 'gdel-polygons-'));
after(() => rmSync(folder, { recursive: true }));

const close = async (page) => {
  assert.deepEqual(page.problems, []);
  await page.context().close();
};

/** Opens the page in 2D, and waits until polygons can be drawn. */
async function openFlat(hash = '', options = {}) {
  const page = await open(here.browser, `${here.url}#dim=2${hash}`, options);
  await page.locator('input[name=tool][value=draw]').waitFor({ state: 'attached' });
  return page;
}

/** A place on the canvas, as a share of its width and height. */
async function at(page, x, y) {
  const box = await page.locator('#canvas').boundingBox();
  return [box.x + x * box.width, box.y + y * box.height];
}

/** Clicks on places, and waits for each until the page shows what has become of it. */
async function click(page, ...places) {
  for (const place of places) {
    await page.mouse.click(...(await at(page, ...place)));
    await settled(page);
  }
}

const SQUARE = [
  [0.2, 0.2],
  [0.8, 0.2],
  [0.8, 0.8],
  [0.2, 0.8],
];
const HOLE = [
  [0.4, 0.4],
  [0.6, 0.4],
  [0.5, 0.6],
];

/** Waits for a row of figures under the sliders. */
const untilFigure = (page, name, isRight) =>
  until(
    page,
    ([name, isRight]) => {
      const rows = [...document.querySelectorAll('#mesh-figures tr')];
      const row = rows.find((row) => row.querySelector('th').textContent === name);
      const value = row && Number.parseFloat(row.querySelector('td').textContent.replace(',', ''));
      return new Function('n', `return ${isRight}`)(value);
    },
    [name, isRight],
  );

test('polygons are drawn with the mouse, and one in another is a hole', async () => {
  const page = await openFlat();
  assert.ok(await page.locator('#meshing').isHidden());
  await page.click('#draw');
  await settled(page);
  await click(page, ...SQUARE);
  assert.equal(await text(page, 'count'), '4 points → 0 triangles');
  await until(page, () => location.hash.includes('corner_'));
  await page.mouse.move(...(await at(page, 0.3, 0.5)));
  await pictureOf(page, 'polygons-open');
  await click(page, SQUARE[0]);
  assert.equal(await text(page, 'count'), '4 points → 2 triangles');
  assert.equal(await text(page, 'edited'), 'Polygon closed');
  // On the last corner, it is closed as well.
  await click(page, ...HOLE, HOLE[2]);
  assert.equal(await text(page, 'count'), '7 points → 7 triangles');
  assert.ok(await page.locator('#voronoi').isDisabled());
  assert.ok(await page.locator('#meshing').isVisible());
  await expectAccessible(page, 'polygons');
  assert.equal((await prove(page)).failed, 0);
  await tab(page, 'points');

  // A link shows the same.
  const other = await open(here.browser, await addressOf(page));
  assert.equal(await text(other, 'count'), '7 points → 7 triangles');
  await close(other);

  // Taken back step by step, and brought back.
  await page.click('#undo');
  await settled(page);
  // The corners of what is open are points of the mesh.
  assert.equal(await text(page, 'count'), '7 points → 8 triangles');
  await page.click('#redo');
  await settled(page);
  assert.equal(await text(page, 'count'), '7 points → 7 triangles');

  // A corner that is removed leaves a ring without it; a side takes the ring along.
  await choose(page, 'tool', 'remove');
  await click(page, SQUARE[1]);
  assert.equal((await text(page, 'count')).split(' ')[0], '6');
  await page.click('#undo');
  await settled(page);
  await click(page, [0.5, 0.4]);
  assert.equal(await text(page, 'count'), '4 points → 2 triangles');
  await page.getByRole('button', { name: 'Remove ring 1' }).click();
  await settled(page);
  assert.match(await text(page, 'count'), /^No points/);
  await close(page);
});

test('a corner is dragged, sides that cross are shown, and points are put there', async () => {
  const page = await openFlat();
  await page.click('#draw');
  await settled(page);
  await click(page, ...SQUARE, SQUARE[0], ...HOLE, HOLE[0]);
  await page.mouse.move(...(await at(page, ...HOLE[2])));
  await page.mouse.down();
  for (const y of [0.65, 0.75, 0.85, 0.9]) await page.mouse.move(...(await at(page, 0.5, y)));
  await page.mouse.up();
  await settled(page);
  await page.locator('#crossing').waitFor();
  assert.match(
    await text(page, 'crossing'),
    /^There is no mesh: lines 2–3 and .* cross, and 1 other pair\./,
  );
  assert.equal(await text(page, 'count'), '7 points → 0 triangles');
  await pictureOf(page, 'polygons-crossing');
  await expectAccessible(page, 'sides that cross');
  await page.locator('#split').check();
  await settled(page);
  await page.locator('#crossing').waitFor({ state: 'hidden' });
  await untilFigure(page, 'Added at crossings', 'n === 2');
  assert.match(await text(page, 'count'), /^9 points → /);
  assert.equal((await prove(page)).failed, 0);
  await tab(page, 'points');
  // All that is enclosed, whichever ring it is in.
  const before = numbers(await text(page, 'count'))[1];
  await page.selectOption('#fill', '3');
  await settled(page);
  assert.ok(numbers(await text(page, 'count'))[1] > before);
  await page.click('#undo');
  await page.click('#undo');
  await settled(page);
  assert.equal(await text(page, 'count'), '7 points → 7 triangles');
  assert.ok(await page.locator('#split').isEnabled());
  await until(page, () => !document.querySelector('#split').checked);
  await close(page);
});

test('polygons are drawn with the keys', async () => {
  const page = await openFlat();
  await page.click('#draw');
  await settled(page);
  await page.focus('#canvas');
  const press = async (key, times = 1) => {
    for (let i = 0; i < times; i++) await page.keyboard.press(key);
    await settled(page);
  };
  await press('Enter');
  await press('ArrowRight', 3);
  await press('Enter');
  await press('ArrowUp', 3);
  await press('Enter');
  await press('Escape');
  assert.match(await text(page, 'count'), /^2 points/);
  await press('Enter');
  assert.match(await text(page, 'count'), /^3 points/);
  // Where a corner is, it is closed.
  await press('Enter');
  assert.equal(await text(page, 'edited'), 'Polygon closed');
  assert.equal(await text(page, 'count'), '3 points → 1 triangle');
  // After clicks, Enter closes.
  await click(page, [0.1, 0.1], [0.2, 0.1], [0.1, 0.2]);
  await press('Enter');
  assert.equal(await text(page, 'count'), '6 points → 2 triangles');
  await press('Escape');
  assert.equal(await text(page, 'count'), '6 points → 2 triangles');
  await close(page);
});

test('sliders refine an example, whose link keeps that', async () => {
  const page = await openFlat();
  await page.click('#example-lake');
  await settled(page);
  const before = numbers(await text(page, 'count'))[1];
  await untilFigure(page, 'Smallest angle', 'n < 10');
  await slide(page, 'min-angle', 30);
  await untilFigure(page, 'Smallest angle', 'n >= 30');
  await untilFigure(page, 'Added inside', 'n > 100');
  const refined = numbers(await text(page, 'count'))[1];
  assert.ok(refined > before);
  await page.locator('#meshing .chart svg').waitFor();
  await pictureOf(page, 'polygons-lake');
  await slide(page, 'max-area', 3);
  await until(
    page,
    (n) => Number(document.querySelector('#mesh-figures td').textContent.replace(',', '')) > n,
    2 * refined,
  );
  assert.equal((await prove(page)).failed, 0);

  // Moved there and back, it is one change.
  await tab(page, 'points');
  await slide(page, 'max-area', 0);
  const link = await addressOf(page);
  assert.equal(link.match(/mesh_/g).length, 1);
  const dark = await open(here.browser, link, { colorScheme: 'dark' });
  assert.equal(numbers(await text(dark, 'count'))[1], refined);
  await until(dark, () => document.querySelector('#min-angle')?.value === '30');
  await dark.locator('#meshing .chart svg').waitFor();
  await expectAccessible(dark, 'refined, dark');
  await pictureOf(dark, 'polygons-lake-dark');
  await close(dark);
  await page.click('#undo');
  await settled(page);
  assert.equal(numbers(await text(page, 'count'))[1], before);

  await page.click('#example-wing');
  await settled(page);
  await slide(page, 'min-angle', 33);
  await untilFigure(page, 'Smallest angle', 'n >= 33');
  await pictureOf(page, 'polygons-wing');
  await close(page);
});

test('files of shapes are dropped in 3D, and saved with their sides', async () => {
  const page = await open(here.browser, `${here.url}#points=uniform_500_1`);
  await drop(
    page,
    'letter.svg',
    '<svg viewBox="0 0 9 9"><path d="M0 0H9V9H0Z M3 3V6H6V3Z"/><text>x</text></svg>',
  );
  assert.equal(await text(page, 'count'), '8 points → 8 triangles');
  assert.equal(await text(page, 'name'), 'letter.svg');
  assert.ok(await page.locator('input[name=dimension][value="2"]').isChecked());
  await until(page, () =>
    /Left out of the file: 1 text\./.test(document.querySelector('#meshing')?.textContent),
  );
  await tab(page, 'use');
  await until(page, () => /readShapes/.test(document.querySelector('#code').textContent));
  assert.match(await text(page, 'code'), /shapes\.points, \{ \.\.\.shapes \}/);
  const [svg] = await save(page, 'SVG', folder);
  const drawing = readFileSync(svg, 'utf8');
  assert.equal(drawing.match(/<path fill="rgb/g).length, 8);
  // Eight sides, each a line.
  assert.equal(drawing.match(/<path fill="none"[^>]* d="([^"]*)"/)[1].match(/M/g).length, 8);
  const [obj] = await save(page, 'OBJ', folder);
  assert.equal(readFileSync(obj, 'utf8').match(/^f /gm).length, 8);

  const square = '4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n';
  await drop(page, 'square.poly', square);
  assert.equal(await text(page, 'count'), '4 points → 2 triangles');
  await drop(page, 'broken.geojson', '{"type":');
  assert.match(await text(page, 'message-text'), /^broken\.geojson: /);
  assert.equal(await text(page, 'count'), '4 points → 2 triangles');
  await page.locator('input[name=dimension][value="3"]').evaluate((radio) => radio.click());
  await settled(page);
  assert.match(await text(page, 'count'), /^500 points/);
  await close(page);
});

test('on a phone, polygons are drawn by taps', async () => {
  const page = await openOnPhone(here.browser, `${here.url}#dim=2`);
  await page.locator('input[name=tool][value=draw]').waitFor({ state: 'attached' });
  const { width, scroll } = await page.evaluate(() => ({
    width: innerWidth,
    scroll: document.documentElement.scrollWidth,
  }));
  assert.ok(scroll <= width, `${scroll} of ${width} pixels`);
  await page.locator('#draw').evaluate((button) => button.click());
  await settled(page);
  for (const place of [...SQUARE, SQUARE[0]]) {
    await page.touchscreen.tap(...(await at(page, ...place)));
    await settled(page);
  }
  assert.equal(await text(page, 'count'), '4 points → 2 triangles');
  await page.click('#handle');
  await expectAccessible(page, 'polygons on a phone');
  await page.locator('#max-area').scrollIntoViewIfNeeded();
  await slide(page, 'min-angle', 30);
  await slide(page, 'max-area', 2);
  await untilFigure(page, 'Triangles', 'n > 100');
  await pictureOf(page, 'polygons-phone');
  await close(page);
});

test('weights and polygons do not meet, and nothing of these is loaded before it is used', async () => {
  const page = await open(here.browser, here.url);
  assert.deepEqual(
    [...page.files].filter((path) => /polygons|constrained|shapes/i.test(path)),
    [],
  );
  await close(page);
  const flat = await openFlat();
  await flat.locator('#weights-by').waitFor({ state: 'attached' });
  await choose(flat, 'tool', 'draw');
  await click(flat, [0.4, 0.4], [0.6, 0.4], [0.5, 0.6], [0.4, 0.4]);
  assert.match(await text(flat, 'count'), /^2\d\d points → \d+ triangles$/);
  assert.ok(await flat.locator('input[name=tool][value=weigh]').isDisabled());
  await tab(flat, 'view');
  assert.ok(await flat.locator('#weights-by').isDisabled());
  assert.match(await text(flat, 'layers'), /Sides of polygons/);
  assert.match(await hrefOf(flat), /dim=2/);
  await close(flat);
});
