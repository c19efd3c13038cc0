// Where things are: nothing but the model on the stage, the dock under it, the panel as a sheet on
// phones; and what the dock says and does.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, describe, test } from 'node:test';
import { generate } from '../../web/dist/index.js';
import {
  choose,
  drop,
  expectAccessible,
  open,
  openOnPhone,
  pictureOf,
  settled,
  shown,
  slide,
  tab,
  text,
  until,
} from './browser.mjs';
import { site } from './site.mjs';

const here = site();

const box = (page, selector) => page.locator(selector).boundingBox();

/** Expects that an element is within the screen, and that nothing is above it. */
async function expectReachable(page, selector) {
  const { x, y, width, height } = await box(page, selector);
  const hit = await page.evaluate(
    ([x, y, selector]) =>
      document.elementFromPoint(x, y)?.closest(selector) === document.querySelector(selector),
    [x + width / 2, y + height / 2, selector],
  );
  assert.ok(hit, `${selector} is covered or outside`);
}

describe('on a screen', () => {
  let page;
  before(async () => (page = await open(here.browser, `${here.url}#points=ball_500_1`)));
  after(() => page.context().close());

  test('no text lies on the model', async () => {
    const texts = await page.locator('#stage > :not(.hidden):visible').allTextContents();
    assert.equal(texts.join('').trim(), '');
    const [stage, dock] = [await box(page, '#stage'), await box(page, '#dock')];
    assert.ok(stage.y + stage.height <= dock.y + 1);
  });

  test('the documents are beside the page, and where the package says', async () => {
    const { repository } = JSON.parse(
      readFileSync(new URL('../../web/package.json', import.meta.url), 'utf8'),
    );
    const address = repository.url.match(/https:.*(?=\.git$)/)[0];
    const link = page.getByRole('link', { name: 'Docs' });
    assert.equal(await link.getAttribute('href'), './guide/');
    await page.click('#help');
    const guides = page.getByRole('link', { name: 'guides' });
    assert.equal(await guides.getAttribute('href'), './guide/');
    const built = page.getByRole('link', { name: 'how it is built' });
    assert.equal(await built.getAttribute('href'), `${address}/blob/main/ARCHITECTURE.md`);
    await page.keyboard.press('Escape');
  });

  test('one slider shows at a time, for what the dock is set to', async () => {
    for (const [mode, slider] of [
      ['solid', '#alpha'],
      ['explode', '#apart'],
      ['slice', '#keep'],
    ]) {
      await choose(page, 'mode', mode);
      for (const each of ['#alpha', '#apart', '#keep'])
        assert.equal(await page.locator(each).isVisible(), each === slider, `${mode}: ${each}`);
    }
  });

  test('the slider for the solid carves what was whole', async () => {
    await slide(page, 'keep', 1);
    const whole = await shown(page);
    assert.equal(whole.shown, whole.total);
    await slide(page, 'alpha', 0.5);
    await slide(page, 'alpha', 0.05);
    assert.ok((await shown(page)).shown < whole.total);
    assert.match(await text(page, 'alpha-value'), /^α = /);
    await slide(page, 'alpha', 1);
    assert.equal((await shown(page)).shown, whole.total);
    assert.equal(await text(page, 'alpha-value'), 'everything');
  });

  test('what is wrong is said in the dock, not on the model, and can be closed', async () => {
    await drop(page, 'photo.jpg', Buffer.from([255]));
    const [stage, message] = [await box(page, '#stage'), await box(page, '#message')];
    assert.ok(message.y >= stage.y + stage.height - 1);
    await pictureOf(page, '3d-message');
    await page.click('#message-close');
    assert.ok(await page.locator('#message').isHidden());
  });

  test('the mesh is verified from the dock, and the next one is not', async () => {
    await page.click('#verify-here');
    await page.locator('#verify-here:enabled').waitFor();
    assert.equal(await text(page, 'verify-here'), '✓ Proven');
    await tab(page, 'compare');
    assert.match(await text(page, 'verdicts'), /No circumsphere has a point inside/);
    await tab(page, 'points');
    await page.click('#generator button[type=submit]');
    await settled(page);
    assert.equal(await text(page, 'verify-here'), 'Verify');
  });

  test('the tetrahedron under the pointer has its empty sphere', async () => {
    await page.goto(`${here.url}#points=ball_500_2`);
    await settled(page);
    const { x, y, width, height } = await box(page, '#stage');
    const bare = await page.locator('#canvas').screenshot();
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.locator('#tip').waitFor();
    await pictureOf(page, '3d-sphere');
    assert.ok(!bare.equals(await page.locator('#canvas').screenshot()));
  });

  test('the scale bar is as long as it says, near and far', async () => {
    const units = async () => {
      const [{ width }, length] = [await box(page, '#scale-bar'), await text(page, 'scale-length')];
      assert.ok(width > 30 && width <= 111, `${width} pixels`);
      return width / Number(length);
    };
    const before = await units();
    await page.focus('#canvas');
    await page.keyboard.press('+');
    await page.keyboard.press('+');
    const ratio = (await units()) / before;
    assert.ok(Math.abs(ratio - 1 / 0.81) < 0.02, `${ratio} times as near`);
  });

  test('the axes turn with the model', async () => {
    const ends = () =>
      page.locator('#axes line').evaluateAll((lines) => lines.map((line) => line.outerHTML));
    const before = await ends();
    assert.equal(before.length, 3);
    await page.focus('#canvas');
    await page.keyboard.press('ArrowLeft');
    assert.notDeepEqual(await ends(), before);
  });

  test('tells newcomers what this is', async () => {
    await page.click('#help');
    assert.ok(await page.locator('#about').isVisible());
    await pictureOf(page, '3d-about');
    await expectAccessible(page, 'about');
    await page.keyboard.press('Escape');
    assert.ok(await page.locator('#about').isHidden());
  });

  test('has done all this without an error in the console', () => {
    assert.deepEqual(page.problems, []);
  });
});

test('the distance between two points is that in the file', async () => {
  const points = await generate('ball', 500, { seed: 1 });
  const page = await open(here.browser, `${here.url}#points=ball_500_1`);
  await page.click('#measure');
  const { width, height } = await page.locator('#canvas').boundingBox();
  const said = () => text(page, 'measured');
  const pointsIn = async () => (await said()).match(/\d+/g).map(Number);
  await page.locator('#canvas').click({ position: { x: width * 0.5, y: height * 0.55 } });
  await until(page, () => document.querySelector('#measured').textContent.startsWith('From'));
  await page.locator('#canvas').click({ position: { x: width * 0.6, y: height * 0.65 } });
  await until(page, () => document.querySelector('#measured').textContent.includes(' to '));
  const [from, to] = await pointsIn();
  const [a, b] = [from, to].map((v) => points.slice(3 * v, 3 * v + 3));
  const distance = Math.hypot(...a.map((x, axis) => b[axis] - x));
  const shown = Number(/: ([\d.e-]+) units/.exec(await said())[1]);
  assert.ok(Math.abs(shown / distance - 1) < 0.01, `${shown} instead of ${distance}`);
  await pictureOf(page, '3d-measured');
  await page.click('#measure');
  assert.ok(await page.locator('#measured').isHidden());
  assert.deepEqual(page.problems, []);
  await page.context().close();
});

test('an empty sheet says what to do', async () => {
  const page = await open(here.browser, `${here.url}#dim=2&points=uniform_0_1`);
  assert.match(await text(page, 'count'), /^No points yet: click/);
  await page.context().close();
});

test('nothing in the dock or the panel lies over another, however wide the window', async () => {
  const page = await open(here.browser, `${here.url}#points=ball_500_1`);
  for (const width of [1600, 1280, 1080, 900, 800]) {
    await page.setViewportSize({ width, height: 800 });
    const boxes = await page
      .locator('.tools-row > :visible, .slide:visible > :not(.hidden)')
      .evaluateAll((all) =>
        all
          .filter((element) => !element.matches('.slides'))
          .map((element) => ({
            name: element.id || element.className,
            ...element.getBoundingClientRect().toJSON(),
          })),
      );
    for (const [i, a] of boxes.entries())
      for (const b of boxes.slice(i + 1)) {
        const apart =
          a.right <= b.left + 1 ||
          b.right <= a.left + 1 ||
          a.bottom <= b.top + 1 ||
          b.bottom <= a.top + 1;
        assert.ok(apart, `${a.name} and ${b.name} at ${width}`);
      }
    const slider = boxes.find(({ name }) => name === 'keep');
    assert.ok(slider.width > 100, `the slider is ${slider.width} wide at ${width}`);
    const overflow = await page
      .locator('#panel')
      .evaluate((panel) => panel.scrollWidth - panel.clientWidth);
    assert.ok(overflow <= 0, `the panel is ${overflow} too narrow at ${width}`);
  }
  await page.context().close();
});

test('on a phone the panel is a sheet of three heights', async () => {
  const page = await openOnPhone(here.browser, `${here.url}#points=ball_500_1`);
  const height = async () => (await box(page, '#panel')).height;
  const low = await height();
  for (const selector of ['#canvas', '#verify-here', '#keep', '#handle', '#tab-use'])
    await expectReachable(page, selector);
  await pictureOf(page, 'phone-low');
  await page.click('#handle');
  const half = await height();
  await page.click('#handle');
  const full = await height();
  assert.ok(low < half && half < full, `${low}, ${half}, ${full}`);
  await pictureOf(page, 'phone-full');
  await page.click('#handle');
  assert.equal(await height(), low);
  await tab(page, 'view');
  assert.equal(await height(), half);
  await expectAccessible(page, 'sheet');
  assert.deepEqual(page.problems, []);
  await page.context().close();
});

for (const dimension of [2, 3]) {
  test(`a phone on its side shows the drawing and its tools, ${dimension}D`, async () => {
    const page = await openOnPhone(
      here.browser,
      `${here.url}#dim=${dimension}&points=uniform_300_1`,
      {
        viewport: { width: 844, height: 390 },
      },
    );
    const [stage, dock] = [await box(page, '#stage'), await box(page, '#dock')];
    assert.ok(stage.height > 150, `the drawing is ${stage.height} pixels high`);
    assert.ok(dock.y + dock.height <= 390.5);
    const { scrollWidth, clientWidth } = await page
      .locator('#panel')
      .evaluate(({ scrollWidth, clientWidth }) => ({ scrollWidth, clientWidth }));
    assert.ok(scrollWidth <= clientWidth, 'the panel is too narrow');
    for (const selector of dimension === 2 ? ['#undo', '#canvas'] : ['#keep', '#canvas'])
      await expectReachable(page, selector);
    await pictureOf(page, `phone-side-${dimension}d`);
    await expectAccessible(page, 'sideways');
    await page.context().close();
  });
}
