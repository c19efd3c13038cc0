// Where things are: nothing but the model on the stage, the dock under it, the panel as a sheet on
// phones; and what the dock says and does.

import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import {
  choose,
  drop,
  expectAccessible,
  launch,
  open,
  openOnPhone,
  pictureOf,
  serve,
  settled,
  shown,
  slide,
  tab,
  text,
} from './browser.mjs';

let server;
let browser;
before(async () => {
  server = await serve();
  browser = await launch();
});
after(async () => {
  await browser.close();
  await server.close();
});

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
  before(async () => (page = await open(browser, `${server.url}#points=ball_500_1`)));
  after(() => page.context().close());

  test('no text lies on the model', async () => {
    const texts = await page.locator('#stage > :not(.hidden):visible').allTextContents();
    assert.equal(texts.join('').trim(), '');
    const [stage, dock] = [await box(page, '#stage'), await box(page, '#dock')];
    assert.ok(stage.y + stage.height <= dock.y + 1);
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
    await page.goto(`${server.url}#points=ball_500_2`);
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

test('an empty sheet says what to do', async () => {
  const page = await open(browser, `${server.url}#dim=2&points=uniform_0_1`);
  assert.match(await text(page, 'count'), /^No points yet: click/);
  await page.context().close();
});

test('on a phone the panel is a sheet of three heights', async () => {
  const page = await openOnPhone(browser, `${server.url}#points=ball_500_1`);
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
    const page = await openOnPhone(browser, `${server.url}#dim=${dimension}&points=uniform_300_1`, {
      width: 844,
      height: 390,
    });
    const [stage, dock] = [await box(page, '#stage'), await box(page, '#dock')];
    assert.ok(stage.height > 150, `the drawing is ${stage.height} pixels high`);
    assert.ok(dock.y + dock.height <= 390.5);
    for (const selector of dimension === 2 ? ['#undo', '#canvas'] : ['#keep', '#canvas'])
      await expectReachable(page, selector);
    await pictureOf(page, `phone-side-${dimension}d`);
    await expectAccessible(page, 'sideways');
    await page.context().close();
  });
}
