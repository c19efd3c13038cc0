// Points with weights on the page: power diagrams, hidden points, and weights that are changed by hand.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import {
  choose,
  drop,
  expectAccessible,
  hrefOf,
  numbers,
  open,
  pictureOf,
  prove,
  settled,
  slide,
  tab,
  text,
  until,
} from './browser.mjs';
import { site } from './site.mjs';

const here = site({ webgpu: false });

/** How many points are hidden, as the line under the drawing says. */
const hiddenOn = async (page) =>
  (await page.locator('#hidden-points').isVisible())
    ? numbers(await text(page, 'hidden-points'))[0]
    : 0;

/** Waits until the page says how many points are hidden. */
const untilHidden = (page, isRight) =>
  until(
    page,
    (isRight) => {
      const { hidden, textContent } = document.querySelector('#hidden-points');
      return new Function('n', `return ${isRight}`)(
        hidden ? 0 : Number(textContent.replaceAll(',', '').match(/\d+/)[0]),
      );
    },
    isRight,
  );

const close = async (page) => {
  assert.deepEqual(page.problems, []);
  await page.context().close();
};

test('in 2D, radii at random hide points, and nothing at all where they are none', async () => {
  const page = await open(here.browser, `${here.url}#dim=2`);
  await page.locator('#weights-by').waitFor({ state: 'attached' });
  await tab(page, 'view');
  await page.selectOption('#weights-by', 'random');
  await untilHidden(page, 'n > 0');
  await settled(page);
  assert.match(await text(page, 'weights-note'), /points are hidden by heavier ones, of 200\./);
  await pictureOf(page, 'weights-2d');
  await expectAccessible(page, 'weights in 2D');
  const many = await hiddenOn(page);
  await slide(page, 'weights-scale', 0.3);
  await untilHidden(page, `n < ${many}`);
  await settled(page);
  await until(page, () => location.hash.includes('weights=0.3_random'));
  assert.ok((await prove(page)).failed === 0);

  // A link shows the same.
  const triangles = await text(page, 'count');
  const other = await open(here.browser, await hrefOf(page));
  assert.equal(await text(other, 'count'), triangles);
  await close(other);

  await tab(page, 'view');
  await page.selectOption('#weights-by', '');
  await untilHidden(page, 'n === 0');
  await settled(page);
  assert.match(await text(page, 'count'), /^200 points → 3\d\d triangles$/);
  await close(page);
});

test('in 2D, a point is weighed by a drag, by the wheel and by keys, and taken back', async () => {
  const page = await open(here.browser, `${here.url}#dim=2`);
  await page.locator('input[name=tool][value=weigh]').waitFor({ state: 'attached' });
  await page.click('#clear');
  await settled(page);
  const box = await page.locator('#canvas').boundingBox();
  const at = (x, y) => [box.x + x * box.width, box.y + y * box.height];
  for (const [x, y] of [
    [0.3, 0.3],
    [0.7, 0.3],
    [0.3, 0.7],
    [0.7, 0.7],
    [0.5, 0.52],
  ]) {
    await page.mouse.click(...at(x, y));
    await settled(page);
  }
  assert.equal(await text(page, 'count'), '5 points → 4 triangles');
  await choose(page, 'tool', 'weigh');
  // A ball around a corner that covers the middle hides it.
  await page.mouse.move(...at(0.3, 0.3));
  await page.mouse.down();
  for (const x of [0.4, 0.5, 0.6, 0.7]) await page.mouse.move(...at(x, 0.6));
  await page.mouse.up();
  await settled(page);
  await untilHidden(page, 'n > 0');
  await pictureOf(page, 'weights-drag');
  await until(page, () => location.hash.includes('weigh_0_'));
  assert.equal((await hrefOf(page)).match(/weigh/g).length, 1);
  assert.ok((await prove(page)).failed === 0);
  await page.click('#undo');
  await untilHidden(page, 'n === 0');
  assert.ok(await page.locator('#redo').isEnabled());
  await page.click('#redo');
  await untilHidden(page, 'n > 0');
  await page.click('#undo');
  await untilHidden(page, 'n === 0');
  await settled(page);

  // With the wheel, which then does not zoom.
  await page.mouse.move(...at(0.5, 0.52));
  await page.mouse.wheel(0, -100);
  await until(page, () => location.hash.includes('weigh_4_'));
  await settled(page);
  assert.ok(await page.locator('#redo').isDisabled());

  // The point nearest to the middle.
  await page.focus('#canvas');
  const before = (await hrefOf(page)).match(/weigh_4_([\d.]+)/)[1];
  await page.keyboard.press(']');
  await page.keyboard.press(']');
  await until(
    page,
    (before) => Number(location.hash.match(/weigh_4_([\d.]+)/)[1]) > before,
    Number(before),
  );
  assert.match(await text(page, 'edited'), /^Radius/);
  for (let i = 0; i < 5; i++) await page.keyboard.press('[');
  await until(page, () => /weigh_4_0(\D|$)/.test(location.hash));
  await settled(page);
  assert.equal(await text(page, 'count'), '5 points → 4 triangles');
  await close(page);
});

test('a column of a file that is dropped gives the radii, in 3D and 2D', async () => {
  const page = await open(here.browser, `${here.url}#points=uniform_500_1`);
  const rows = Array.from({ length: 300 }, (_, i) => {
    const [x, y, z] = [7, 11, 13].map((by) => ((i * by * 0.618034) % 1).toFixed(4));
    return `${x},${y},${z},${i % 10 === 0 ? 0.3 : 0.01}`;
  });
  await drop(page, 'balls.csv', `x,y,z,radius\n${rows.join('\n')}\n`);
  await tab(page, 'view');
  await until(page, () =>
    [...document.querySelectorAll('#weights-by option')].some(({ value }) => value === 'radius'),
  );
  await page.selectOption('#weights-by', 'radius');
  await untilHidden(page, 'n > 20');
  await settled(page);
  assert.match(await text(page, 'weights-note'), /hidden by heavier ones, of 300/);
  assert.ok((await prove(page)).failed === 0);
  await pictureOf(page, 'weights-3d');
  await page.locator('#voronoi').check();
  await settled(page);
  await pictureOf(page, 'weights-3d-cells');
  await tab(page, 'view');
  await page.selectOption('#weights-by', '');
  await untilHidden(page, 'n === 0');
  await settled(page);
  await close(page);
});

test('nothing of it is loaded before it is used', async () => {
  const page = await open(here.browser, here.url);
  const loaded = () => [...page.files].filter((path) => /weigh/.test(path));
  assert.deepEqual(loaded(), []);
  await tab(page, 'view');
  await page.locator('#weights-by').waitFor();
  assert.ok(loaded().length > 0);
  await close(page);
});
