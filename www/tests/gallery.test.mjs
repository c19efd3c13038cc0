// The objects that the page offers, files in other forms than one scan, and visits to come.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { Document, NodeIO } from '@gltf-transform/core';
import {
  addressOf,
  drop,
  dropAll,
  numbers,
  open,
  pictureOf,
  settled,
  shown,
  slide,
  text,
} from './browser.mjs';
import { site } from './site.mjs';

const dist = fileURLToPath(new URL('../dist/', import.meta.url));

const here = site();

test('the gallery has eight objects with pictures, and shows them', async () => {
  const page = await open(here.browser, `${here.url}#points=uniform_200_1`);
  const pictures = page.locator('#gallery img');
  assert.equal(await pictures.count(), 8);
  for (const picture of await pictures.all()) {
    await picture.scrollIntoViewIfNeeded();
    await picture.evaluate((image) => image.decode());
  }
  for (const [name, points] of [
    ['Gear', '50,000 points'],
    ['Sea shell', '45,000 points'],
    ['Mountains', '60,000 points'],
  ]) {
    const button = page.getByRole('button', { name, exact: true });
    await button.click();
    await settled(page);
    assert.ok((await text(page, 'count')).startsWith(points), await text(page, 'count'));
    assert.equal(await button.getAttribute('aria-pressed'), 'true');
    await pictureOf(page, `gallery-${name.toLowerCase().replace(' ', '-')}`);
  }
  assert.deepEqual(page.problems, []);
  await page.context().close();
});

test('the panel is folded up to what was asked for', async () => {
  const context = await here.browser.newContext({ serviceWorkers: 'block' });
  const page = await context.newPage();
  // A page that opens with a moving cut takes long on a busy machine.
  page.setDefaultTimeout(300_000);
  await page.goto(`${here.url}#points=bunny`);
  await settled(page);
  for (const fold of ['generate', 'live', 'backend'])
    assert.equal(await page.locator(`#fold-${fold}`).getAttribute('open'), null, fold);
  await page.locator('#fold-generate summary').press('Enter');
  await page.locator('#distribution').waitFor();
  await page.goto('about:blank');
  await page.goto(`${here.url}#points=sphere_300_1`);
  await settled(page);
  assert.notEqual(await page.locator('#fold-generate').getAttribute('open'), null);
  await context.close();
});

test('Voronoi cells take the place of tetrahedra, and are cut and pulled apart', async () => {
  const page = await open(here.browser, `${here.url}#points=ball_2000_1&keep=1`);
  const box = page.getByLabel('Voronoi', { exact: true });
  await box.check();
  await settled(page);
  await page.locator('#shown', { hasText: /^all 2,000 shown/ }).waitFor();
  assert.match(await text(page, 'legend-title'), /^Volume of the cell/);
  await slide(page, 'keep', 0.5);
  const { shown: kept, total } = await shown(page);
  assert.ok(kept > 500 && kept < 1500 && total === 2000, `${kept} of ${total}`);
  await slide(page, 'apart', 0.4);
  await pictureOf(page, 'voronoi-cells');
  assert.match(await addressOf(page), /layers=[a-z_]*voronoi/);
  await box.uncheck();
  await settled(page);
  assert.ok((await shown(page)).total > 10_000);
  assert.deepEqual(page.problems, []);
  await page.context().close();
});

test('several files are one cloud', async () => {
  const page = await open(here.browser, `${here.url}#points=uniform_200_1`);
  const half = (x) => '0 0 0\n1 0 0\n0 1 0\n0 0 1\n'.replaceAll('0 ', `${x} `);
  await dropAll(page, { 'left.xyz': half(0), 'right.xyz': half(5) });
  assert.match(await text(page, 'count'), /^8 points/);
  assert.equal(await text(page, 'name'), 'left.xyz and 1 more');
  assert.match(await addressOf(page), /file=left\.xyz\+and\+1\+more/);
  // The message says which of them is wrong, and the cloud stays.
  await dropAll(page, { 'left.xyz': half(0), 'wrong.xyz': '1 2 three\n' });
  assert.match(await text(page, 'message-text'), /wrong\.xyz: .*line 1/i);
  assert.match(await text(page, 'count'), /^8 points/);
  assert.deepEqual(page.problems, []);
  await page.context().close();
});

test('a GLB gives the vertices of its scene, each once', async () => {
  const document = new Document();
  const buffer = document.createBuffer();
  const positions = document
    .createAccessor()
    .setType('VEC3')
    .setArray(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]))
    .setBuffer(buffer);
  const [POINTS, TRIANGLES] = [0, 4];
  const primitive = (mode = POINTS) =>
    document.createPrimitive().setMode(mode).setAttribute('POSITION', positions);
  const mesh = document.createMesh().addPrimitive(primitive()).addPrimitive(primitive());
  const parent = document.createNode().setScale([100, 100, 100]);
  parent.addChild(document.createNode().setMesh(mesh).setTranslation([5, 0, 0]));
  document.createScene().addChild(parent).addChild(document.createNode().setMesh(mesh));
  const bytes = await new NodeIO().writeBinary(document);

  const indices = document
    .createAccessor()
    .setArray(new Uint16Array([0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]))
    .setBuffer(buffer);
  mesh.addPrimitive(primitive(TRIANGLES).setIndices(indices));
  const solid = await new NodeIO().writeBinary(document);

  const page = await open(here.browser, `${here.url}#points=uniform_200_1`);
  await drop(page, 'solid.glb', solid);
  const [points] = numbers(await text(page, 'count'));
  assert.equal(points - 8, numbers(await text(page, 'note-text'))[0]);
  await drop(page, 'two.glb', bytes);
  assert.match(await text(page, 'count'), /^8 points/);
  assert.equal(await page.locator('input[name=up]:checked').inputValue(), 'y');
  await drop(page, 'broken.glb', Buffer.from('glTF'));
  assert.match(await text(page, 'message-text'), /^broken\.glb: /);
  assert.match(await text(page, 'count'), /^8 points/);
  assert.deepEqual(page.problems, []);
  await page.context().close();
});

test('the first visit, and no later one, says in words what was done', async () => {
  const page = await open(here.browser, `${here.url}#points=uniform_200_1`);
  assert.match(
    await text(page, 'first'),
    /^Your machine just turned 200 points into [\d,]+ tetrahedra in .* second.*, all of them exact\.$/,
  );
  await page.reload();
  await settled(page);
  assert.ok(await page.locator('#first').isHidden());
  await page.context().close();
});

test('after the first visit the page opens without a connection', async () => {
  const page = await open(here.browser, `${here.url}#points=knot`, { serviceWorkers: 'allow' });
  // Everything is kept once the worker is in charge.
  await page.evaluate(() => navigator.serviceWorker.ready);
  await page.context().setOffline(true);
  await page.reload();
  await settled(page);
  assert.match(await text(page, 'count'), /^40,000 points/);
  await page.getByRole('button', { name: 'Stanford bunny' }).click();
  await settled(page);
  assert.match(await text(page, 'count'), /^35,947 points/);
  assert.deepEqual(page.problems, []);
  await page.context().close();
});

test('links have a preview, and the page can be installed', async () => {
  const page = await open(here.browser, `${here.url}#points=uniform_200_1`);
  const image = await page.locator('meta[property="og:image"]').getAttribute('content');
  const size = await page.evaluate(async (src) => {
    const image = Object.assign(new Image(), { src });
    await image.decode();
    return [image.naturalWidth, image.naturalHeight];
  }, image);
  assert.deepEqual(size, [1200, 630]);
  const path = await page.locator('link[rel=manifest]').getAttribute('href');
  const manifest = JSON.parse(readFileSync(dist + path.replace(/^\.?\//, ''), 'utf8'));
  for (const { src, sizes } of manifest.icons) {
    const width = await page.evaluate(async (src) => {
      const image = Object.assign(new Image(), { src });
      await image.decode();
      return image.naturalWidth;
    }, src);
    assert.ok(sizes === 'any' || sizes === `${width}x${width}`, `${src}: ${width}`);
  }
  await page.context().close();
});
