// The examples: each runs from the built page without a request to anywhere else, can be changed and copied, and its copies
// run, too.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { deflateRawSync } from 'node:zlib';
import { launchChromium, WEBGPU_AND_WEBGL } from '../../tests/web/browsers.mjs';
import { copied, expectAccessible, numbers, pictureOf, serve } from './browser.mjs';

const programs = new URL('../programs/', import.meta.url);
const read = (name) => readFileSync(new URL(name, programs), 'utf8');
const catalogue = JSON.parse(read('catalogue.json'));
const packages = JSON.parse(read('packages.json'));

let server;
let browser;
before(async () => {
  server = await serve();
  browser = await launchChromium(WEBGPU_AND_WEBGL);
});
after(async () => {
  await browser?.close();
  await server?.close();
});

/** Opens a page that may not say anything on the console, nor ask any other host. */
async function visit(path, options = {}) {
  const context = await browser.newContext({
    viewport: { width: 1440, height: 900 },
    deviceScaleFactor: 0.5,
    colorScheme: 'light',
    reducedMotion: 'reduce',
    ...options,
  });
  // Playwright blocks service workers by a script that fails in frames without an origin.
  await context.addInitScript(() => {
    if (self === top) navigator.serviceWorker.register = () => Promise.reject(new Error('blocked'));
  });
  const page = await context.newPage();
  page.setDefaultTimeout(120_000);
  page.problems = [];
  page.on('pageerror', ({ message }) => page.problems.push(message));
  page.on('console', (message) => {
    // luma.gl notes there what it finds in SwiftShader; browsers hide it.
    if (message.type() !== 'debug') page.problems.push(message.text());
  });
  page.on('request', (request) => {
    const url = request.url();
    if (!url.startsWith(server.url) && !/^(blob|data):/.test(url)) page.problems.push(url);
  });
  await page.goto(`${server.url}examples/${path}`);
  return page;
}

const state = (page, name) => page.locator(`main[data-state="${name}"]`).waitFor();

/** Opens an example and waits until its code has run. Resolves to its page with its frame as `result`. */
async function open(path, options) {
  const page = await visit(path, options);
  await state(page, 'done');
  page.result = page.frameLocator('iframe');
  return page;
}

/** Opens an example for a test, which ends without problems. */
async function withExample(name, expect) {
  const page = await open(`${name}/`);
  await expect(page.result, page);
  assert.deepEqual(page.problems, []);
  await page.context().close();
}

const note = (frame) => frame.locator('p').first().textContent();

/** Waits until the first paragraph matches. */
const says = (frame, pattern) => frame.locator('p', { hasText: pattern }).first().waitFor();

/** The share of the pixels of a picture that differ from its corner, and how many colours there are. */
async function seen(page, locator) {
  const png = (await locator.screenshot()).toString('base64');
  return page.evaluate(async (png) => {
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob());
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
    context.drawImage(image, 0, 0);
    const pixels = new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer);
    const other = pixels.filter((pixel) => pixel !== pixels[0]).length;
    return { share: other / pixels.length, colors: new Set(pixels).size };
  }, png);
}

/** Expects a drawing that covers so much of its canvas. */
async function expectDrawn(page, least, most, colors = 20) {
  const found = await seen(page, page.result.locator('canvas').first());
  assert.ok(found.share > least && found.share < most, `${found.share} of the canvas is drawn on`);
  assert.ok(found.colors >= colors, `${found.colors} colours`);
}

describe('every example runs', () => {
  test('a scan becomes a file for a printer', () =>
    withExample('scan', async (result, page) => {
      assert.match(await note(result), /^8987 points, 17966 triangles: watertight, 753 cm³$/);
      await expectDrawn(page, 0.1, 0.7);
      const download = page.waitForEvent('download');
      await result.getByRole('button').click();
      assert.equal(statSync(await (await download).path()).size, 84 + 50 * 17966);
    }));

  test('balls fall on a scan', () =>
    withExample('collider', async (result, page) => {
      await says(result, /^17966 triangles, ([4-7]\d|80) of 80 balls are down/);
      await expectDrawn(page, 0.1, 0.8);
    }));

  test('a point cloud in deck.gl', () =>
    withExample('deck', async (result, page) => {
      await result.locator('[data-drawn="8987"]').waitFor();
      assert.match(await note(result), /usually 3\.5 mm away/);
      await expectDrawn(page, 0.05, 0.8);
    }));

  test('an alpha shape follows its slider', () =>
    withExample('alpha', async (result) => {
      assert.match(await note(result), /^Radius 14\.5: 1549 triangles in 1 part$/);
      assert.equal(numbers((await result.locator('path').first().getAttribute('d')).replace(/[^M]/g, '1')).length, 1);
      await result.getByRole('slider').fill('5');
      await says(result, /^Radius 5\.0: \d+ triangles in \d\d+ parts$/);
    }));

  test('terrain keeps its breaklines', () =>
    withExample('terrain', async (result, page) => {
      const [vertices, points, error, edges] = numbers(await note(result));
      assert.ok(vertices < points / 5 && error <= 0.25 && edges >= 120, await note(result));
      await expectDrawn(page, 0.2, 0.8);
    }));

  test('stations become lines on a map', () =>
    withExample('contours', async (result) => {
      const [stations, lines] = numbers(await note(result));
      const rows = read('data/stations.csv').trim().split('\n').length - 1;
      assert.equal(stations, rows);
      const shapes = await result.locator('.leaflet-overlay-pane path').count();
      assert.equal(shapes, lines + stations + 1);
    }));

  test('a place on the globe has a nearest city', () =>
    withExample('cities', async (result, page) => {
      assert.match(await note(result), /^Paris is nearest, one of 135, /);
      const { x, y, width, height } = await result.locator('canvas').boundingBox();
      await page.mouse.move(x + width / 2, y + height * 0.79);
      await says(result, /^(Luanda|Kinshasa|Windhoek) is nearest/);
      await expectDrawn(page, 0.5, 0.9);
    }));

  test('natural neighbours are nearer to what was sampled', () =>
    withExample('natural', async (result) => {
      assert.equal(await result.locator('canvas').count(), 3);
      const errors = (await result.locator('p').allTextContents()).slice(1).map((text) => numbers(text)[0]);
      assert.ok(errors[0] < errors[1] / 3, `${errors}`);
    }));

  test('a treemap has a cell for each row', () =>
    withExample('treemap', async (result) => {
      const rows = read('data/countries.csv').trim().split('\n').length - 1;
      assert.equal(await result.locator('polygon > title').count(), rows);
      const [, , off] = numbers(await note(result));
      assert.ok(off <= 0.1, `${off} %`);
    }));

  test('circles move by mouse and by keys', () =>
    withExample('power', async (result, page) => {
      assert.equal(await note(result), '14 circles, 14 cells, 0 hidden');
      const canvas = result.locator('canvas');
      const before = await canvas.screenshot();
      await canvas.dragTo(canvas, { sourcePosition: { x: 80, y: 120 }, targetPosition: { x: 200, y: 200 } });
      await canvas.focus();
      for (let i = 0; i < 30; i++) await page.keyboard.press('+');
      await says(result, /, [1-9]\d* hidden/);
      assert.notDeepEqual(await canvas.screenshot(), before);
    }));

  test('dots share the ink of a picture', () =>
    withExample('stippling', async (result, page) => {
      const [dots, round, off] = numbers(await note(result));
      assert.deepEqual([dots, round], [3000, 10]);
      assert.ok(off <= 0.1, `${off} %`);
      await expectDrawn(page, 0.05, 0.6);
    }));

  test('a block breaks into shards that fill it', () =>
    withExample('fracture', async (result, page) => {
      assert.equal(await note(result), '60 shards, whose volumes add up to 1.000000');
      const together = await seen(page, result.locator('canvas'));
      await result.getByRole('slider').fill('2');
      await expectDrawn(page, together.share + 0.05, 0.9);
    }));

  test('points move', () =>
    withExample('moving', async (result, page) => {
      await says(result, /^400 points, 7\d\d triangles, \d\d+ updates$/);
      await expectDrawn(page, 0.05, 0.9, 3);
    }));

  test('a tree falls into clusters', () =>
    withExample('clusters', async (result) => {
      assert.match(await note(result), /^420 points, .* 7 clusters$/);
      assert.equal(await result.locator('path').count(), 420 + 419);
      await result.getByRole('spinbutton').fill('3');
      await says(result, /3 clusters$/);
    }));

  test('a polygon has triangles, and its holes none', () =>
    withExample('polygon', async (result) => {
      const rings = JSON.parse(read('data/lake.json')).coordinates;
      const area = rings.reduce((sum, ring, i) => sum + (i ? -1 : 1) * areaOf(ring), 0);
      const [holes, triangles, filled] = numbers(await note(result));
      assert.equal(holes, rings.length - 1);
      assert.equal(filled, Number(area.toFixed(1)));
      // With h holes, n corners make n + 2h − 2 triangles.
      const corners = rings.reduce((sum, ring) => sum + ring.length - 1, 0);
      assert.equal(triangles, corners + 2 * holes - 2);
      assert.equal(await result.locator('path').count(), triangles + 1);
    }));

  test('a mesh is refined as its sliders ask', () =>
    withExample('refine', async (result) => {
      const [triangles, least] = numbers(await note(result));
      assert.equal(await result.locator('path').count(), triangles);
      assert.ok(least >= 30);
      await result.getByRole('slider', { name: 'Largest area' }).fill('60');
      await says(result, new RegExp(`^(?!${triangles} )`));
      assert.ok(numbers(await note(result))[0] < triangles);
    }));

  test('WebGPU draws what it has made, also in three.js', async () => {
    // One after the other: software compiles the kernels for most of the time.
    for (const name of ['resident', 'webgpu'])
      await withExample(name, async (result, page) => {
        assert.ok(numbers(await note(result))[0] > 500, await note(result));
        await expectDrawn(page, 0.3, 0.95);
      });
  });

  test('a component of React', () =>
    withExample('react', async (result) => {
      await result.locator('polygon').nth(23).waitFor();
      await result.getByRole('button').click();
      await result.locator('svg').click({ position: { x: 40, y: 40 } });
      await says(result, /^26 points/);
      await result.locator('polygon').nth(25).waitFor();
    }));

  test('a component of Svelte', () =>
    withExample('svelte', async (result) => {
      await result.locator('polygon').nth(23).waitFor();
      const before = await result.locator('polygon').first().getAttribute('points');
      await result.getByRole('button').click();
      await says(result, /^24 points, moved 1 times/);
      await result.locator(`polygon:first-of-type:not([points="${before}"])`).waitFor();
    }));

  test('a worker of the visitor’s', () =>
    withExample('worker', async (result) => {
      const [meshes, tetrahedra] = numbers(await note(result));
      assert.equal(meshes, 500);
      assert.ok(tetrahedra > 500 * 400, await note(result));
    }));

  test('a script for Node prints what its page shows', async () => {
    const folder = mkdtempSync(join(tmpdir(), 'gdel-example-'));
    // Where it finds the package.
    const script = fileURLToPath(new URL('node.mjs', programs));
    const { stdout } = await promisify(execFile)(process.execPath, [script], { cwd: folder });
    const stl = statSync(join(folder, 'surface.stl')).size;
    rmSync(folder, { recursive: true });
    assert.equal(stdout, read('node.txt'));
    assert.equal(stl, 84 + 50 * 8000);
    const page = await visit('node/');
    assert.equal(await page.locator('.output').textContent(), stdout);
    assert.deepEqual(page.problems, []);
    await page.context().close();
  });
});

function areaOf(ring) {
  let twice = 0;
  for (let i = 1; i < ring.length; i++)
    twice += ring[i - 1][0] * ring[i][1] - ring[i][0] * ring[i - 1][1];
  return Math.abs(twice) / 2;
}
