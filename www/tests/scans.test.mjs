// People's own scans: how they are shown at first, and what does not stay from the last.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { delaunay3d } from 'gdel-wasm';
import {
  addressOf,
  choose,
  colorBy,
  drop,
  expectAccessible,
  expectAlphaShape,
  gdel,
  numbers,
  open,
  pictureOf,
  save,
  settled,
  shareOfPixels,
  shown,
  slide,
  tab,
  text,
  until,
} from './browser.mjs';
import {
  airborne,
  bracket,
  coloredPly,
  figure,
  ply,
  randomNumbers,
  terrestrial,
  torus,
  xyz,
} from './models.mjs';
import { site } from './site.mjs';

/** What the triangles of a binary STL enclose. */
function volumeOf(stl) {
  let sum = 0;
  for (let at = 84; at < stl.length; at += 50) {
    const [a, b, c] = [0, 1, 2].map((k) =>
      [0, 4, 8].map((x) => stl.readFloatLE(at + 12 + 12 * k + x)),
    );
    sum +=
      a[0] * (b[1] * c[2] - b[2] * c[1]) -
      a[1] * (b[0] * c[2] - b[2] * c[0]) +
      a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}

describe('a scan', () => {
  let page;
  const here = site({}, async ({ browser, url }) => {
    page = await open(browser, `${url}#points=uniform_200_1`);
  });

  test('from the air is framed without its birds, and is ground without a bottom', async () => {
    await drop(page, 'hills.xyz', xyz(airborne()));
    assert.match(await text(page, 'count'), /^8,040 points/);
    const line = await text(page, 'surface-text');
    assert.match(line, /^Open surface: area [\d,]+ file units²\. 10 stray points left out\.$/);
    // The hills have 600,000 m² as seen from above, and hardly more.
    const [area] = numbers(line);
    assert.ok(area > 590_000 && area < 630_000, line);
    assert.ok(await page.locator('#prints').isHidden());
    assert.ok(await page.locator('#legend').isHidden());
    await pictureOf(page, 'scan-airborne');
    // It can be cut, too, and saved.
    const { shown: whole } = await shown(page);
    await slide(page, 'keep', 0.5);
    const half = (await shown(page)).shown / whole;
    assert.ok(half > 0.3 && half < 0.7, `${half} shown`);
    await tab(page, 'use');
    const folder = mkdtempSync(join(tmpdir(), 'gdel-scan-'));
    const obj = readFileSync((await save(page, 'OBJ', folder))[0], 'utf8');
    rmSync(folder, { recursive: true });
    const triangles = obj.split('\n').filter((line) => line.startsWith('f ')).length;
    assert.ok(triangles > 15_000 && triangles < 16_000, `${triangles} triangles`);
  });

  test('from a tripod shows the street, not what is a kilometre away', async () => {
    const street = terrestrial();
    await drop(page, 'street.pts', `${street.length}\n${xyz(street)}`);
    assert.equal(await page.locator('input[name=up]:checked').inputValue(), 'z');
    const bar = Number(await text(page, 'scale-length'));
    assert.ok(bar >= 5 && bar <= 20, `a bar of ${bar} metres`);
    const counts = await shown(page);
    const share = counts.shown / counts.total;
    assert.ok(share > 0.25 && share < 0.75, `${counts.shown} of ${counts.total} shown`);
    await pictureOf(page, 'scan-terrestrial');
  });

  test('from a tripod without far points is a street with walls, open above', async () => {
    const street = terrestrial().filter((p) => Math.hypot(...p) < 100);
    await drop(page, 'street.xyz', xyz(street));
    // Where the walls end, points are so far from each other that some count as stray: of 15,417 at most 1 %.
    const line = await text(page, 'surface-text');
    assert.match(line, /^Open surface: area [\d,]+ file units²\. \d+ stray points left out\.$/);
    const [area, strays] = numbers(line);
    assert.ok(area > 3400 && area < 3800 && strays < 155, line);
    await pictureOf(page, 'scan-street');
    await expectAccessible(page, 'street');
  });

  test('stands upright, whichever axis is up', async () => {
    for (const [axis, up] of [
      [1, 'y'],
      [2, 'z'],
    ]) {
      await drop(page, `figure-${up}.ply`, ply(figure(axis)));
      assert.equal(await page.locator('input[name=up]:checked').inputValue(), up);
    }
    await pictureOf(page, 'scan-figure');
  });

  test('is seen as a new one, not as the last one was', async () => {
    await drop(page, 'hills.xyz', xyz(airborne()));
    await slide(page, 'keep', 0.2);
    await tab(page, 'view');
    // From the surface, the slider leads to the radius that suits; from there, it goes on.
    await slide(page, 'alpha', 0.9);
    await slide(page, 'alpha', 0.9);
    await page.focus('#canvas');
    await page.keyboard.press('ArrowLeft');
    for (const key of ['keep', 'alpha', 'camera'])
      assert.ok((await addressOf(page)).includes(`${key}=`), key);
    await drop(page, 'figure.ply', ply(figure(1)));
    assert.doesNotMatch(await addressOf(page), /keep|alpha|camera|normal|up=/);
  });

  test('is named, and a link to it says which file it needs', async () => {
    await drop(page, 'my cat.ply', ply(figure(1)));
    assert.equal(await text(page, 'name'), 'my cat.ply');
    assert.equal(await page.title(), 'my cat.ply · gdel');
    await slide(page, 'keep', 0.25);
    const other = await open(here.browser, await addressOf(page));
    assert.match(await text(other, 'message-text'), /“my cat\.ply”.*Open the same file/);
    await drop(other, 'my cat.ply', ply(figure(1)));
    assert.equal(await text(other, 'shown'), await text(page, 'shown'));
    assert.deepEqual(other.problems, []);
    await other.context().close();
  });

  test('is seen as its closed surface first: whole, in its colours, and as large as it is', async () => {
    await drop(page, 'ring.ply', coloredPly(torus(8000)));
    const line = await text(page, 'surface-text');
    assert.match(line, /^Closed surface: volume [\d.]+ file units³, area [\d.]+ file units²\.$/);
    const [volume, area] = numbers(line);
    assert.ok(Math.abs(volume / (2 * Math.PI ** 2 * 0.16) - 1) < 0.02, line);
    assert.ok(Math.abs(area / (4 * Math.PI ** 2 * 0.4) - 1) < 0.02, line);
    assert.equal(await page.inputValue('#keep'), '1');
    assert.doesNotMatch(await addressOf(page), /keep|filter/);
    for (const channel of [0, 2]) assert.ok((await shareOfPixels(page, channel)) > 0.05);
    await pictureOf(page, 'scan-surface');
    await expectAccessible(page, 'surface');
    const whole = await shown(page);
    assert.ok(whole.shown < whole.total);
    // The solid is cut and pulled apart as all others are.
    await slide(page, 'keep', 0.5);
    const half = (await shown(page)).shown / whole.shown;
    assert.ok(half > 0.3 && half < 0.7, `${half} of the solid`);
    await pictureOf(page, 'scan-surface-cut');
    await slide(page, 'apart', 0.3);
    await pictureOf(page, 'scan-surface-exploded');
    await slide(page, 'apart', 0);
    // Whoever explores radii leaves the surface, and comes back to it.
    await choose(page, 'mode', 'solid');
    assert.equal(await text(page, 'alpha-value'), 'the surface');
    await page.getByRole('button', { name: 'Auto', exact: true }).click();
    await settled(page);
    assert.match(await text(page, 'alpha-value'), /^α = /);
    assert.ok(await page.locator('#surface').isHidden());
    assert.match(await addressOf(page), /filter=carve/);
    await tab(page, 'view');
    await choose(page, 'filter', 'alpha');
    await slide(page, 'keep', 1);
    await expectAlphaShape(page, await delaunay3d(Float32Array.from(torus(8000).flat())));
    await choose(page, 'filter', 'surface');
    assert.equal(await text(page, 'surface-text'), line);
    await choose(page, 'mode', 'slice');
  });

  test('is saved for a printer from where its size is said', async () => {
    await drop(page, 'ring.ply', ply(torus(5000)));
    const folder = mkdtempSync(join(tmpdir(), 'gdel-scan-'));
    const files = {};
    for (const format of ['STL', '3MF', 'GLB']) {
      const [path] = await save(page, `Save for printing as ${format}`, folder);
      assert.match(path, /ring\.(stl|3mf|glb)$/);
      files[format] = readFileSync(path);
    }
    rmSync(folder, { recursive: true });
    const volume = volumeOf(files.STL) / (2 * Math.PI ** 2 * 0.16);
    assert.ok(Math.abs(volume - 1) < 0.02, `${volume} of the torus`);
    assert.equal(files['3MF'].subarray(0, 2).toString(), 'PK');
    assert.equal(files.GLB.subarray(0, 4).toString(), 'glTF');
  });

  test('with noise and strays has a smooth surface, and the page says so', async () => {
    const strays = [
      [5, 5, 5],
      [-5, 4, 5],
    ];
    await drop(page, 'noisy.xyz', xyz([...torus(8000, 0.02), ...strays]));
    const line = await text(page, 'surface-text');
    assert.match(line, /2 stray points left out\. Noise was smoothed\.$/);
    assert.ok(Math.abs(numbers(line)[0] / (2 * Math.PI ** 2 * 0.16) - 1) < 0.03, line);
    await pictureOf(page, 'scan-noisy');
  });

  test('whose points fill a volume is carved and cut, unless its surface is asked for', async () => {
    const random = randomNumbers(5);
    const cube = Array.from({ length: 3000 }, () => [random(), random(), random()]);
    await drop(page, 'cube.xyz', xyz(cube));
    assert.ok(await page.locator('#surface').isHidden());
    assert.ok((await page.inputValue('#keep')) < 1);
    await tab(page, 'view');
    assert.ok(await page.isChecked('input[name=filter][value=carve]'));
    await drop(page, 'flat.xyz', '0 0 0\n1 0 0\n0 1 0\n1 1 0\n');
    assert.ok(await page.locator('#surface').isHidden());
    assert.ok(await page.locator('#message').isHidden());
  });

  test('has its own colours outside, and the quantity inside', async () => {
    await drop(page, 'colours.ply', coloredPly(figure(1)));
    await slide(page, 'keep', 1);
    for (const channel of [0, 2]) {
      const share = await shareOfPixels(page, channel);
      assert.ok(share > 0.03, `${share} of the pixels are of channel ${channel}`);
    }
    await slide(page, 'apart', 0.3);
    assert.ok((await shareOfPixels(page, 0)) > 0.02);
    await pictureOf(page, 'scan-colours-exploded');
    await slide(page, 'apart', 0);
    await slide(page, 'keep', 0.5);
    assert.match(await text(page, 'legend-title'), /^Inside: circumradius/);
    await pictureOf(page, 'scan-colours');
    await tab(page, 'view');
    const skin = page.getByLabel('Outside in the file’s colours');
    assert.ok(await skin.isChecked());
    // What is chosen is to be seen everywhere.
    await colorBy(page, 'volume');
    assert.ok(!(await skin.isChecked()));
    assert.match(await text(page, 'legend-title'), /^Volume/);
    await slide(page, 'keep', 1);
    assert.ok((await shareOfPixels(page, 0)) < 0.003);
  });

  test('has its own colours in the plane', async () => {
    const flat = await open(here.browser, `${here.url}#dim=2`);
    await drop(flat, 'colours.ply', coloredPly(figure(1)));
    for (const channel of [0, 2]) assert.ok((await shareOfPixels(flat, channel)) > 0.03);
    assert.ok(await flat.locator('#legend').isHidden());
    await pictureOf(flat, 'scan-colours-2d');
    assert.deepEqual(flat.problems, []);
    await flat.context().close();
  });

  test('is probed by the pointer: where it is, and from above how high', async () => {
    /** The numbers that the tip begins with, by their names. */
    const probe = async (page) => {
      const { x, y, width, height } = await page.locator('#canvas').boundingBox();
      await page.mouse.move(x + 0.5 * width, y + 0.5 * height);
      await page.locator('#tip').waitFor();
      const names = await page.locator('#tip dt').allTextContents();
      const values = await page.locator('#tip dd').allTextContents();
      return Object.fromEntries(names.map((name, i) => [name, Number(values[i])]));
    };
    const random = randomNumbers(3);
    const slope = Array.from({ length: 500 }, () => [100 * random(), 100 * random()]);
    const points = xyz(slope.map(([x, y]) => [500_000 + x, y, 2 * x + 3 * y]));
    const flat = await open(here.browser, `${here.url}#dim=2`);
    await drop(flat, 'slope.xyz', points);
    const above = await probe(flat);
    assert.ok(above.x > 500_020 && above.x < 500_080 && above.y > 20 && above.y < 80);
    const expected = 2 * (above.x - 500_000) + 3 * above.y;
    assert.ok(Math.abs(above.height - expected) < 0.5, JSON.stringify(above));
    assert.deepEqual(flat.problems, []);
    await flat.context().close();

    await drop(page, 'hills.xyz', xyz(airborne()));
    for (const apart of [0, 0.5]) {
      await slide(page, 'apart', apart);
      const { x, y, z } = await probe(page);
      assert.ok(x > 500_000 && x < 501_000 && y > 4_000_000 && y < 4_000_600, `${x}, ${y}`);
      assert.ok(z > -40 && z < 60, `${z}`);
      await page.mouse.move(2, 2);
    }
    await slide(page, 'apart', 0);
  });

  test('says what stands for its colours', async () => {
    await tab(page, 'view');
    const names = () => page.locator('#layers').textContent();
    const points = figure(1);
    const header = (...names) =>
      [...names.map((name) => `property float ${name}`), 'end_header'].join('\n');
    await drop(
      page,
      'intensity.ply',
      ply(points.map((p) => [...p, p[0]])).replace('end_header', header('intensity')),
    );
    assert.match(await names(), /Outside coloured by intensity/);
    await drop(
      page,
      'normals.ply',
      ply(points.map((p) => [...p, ...p])).replace('end_header', header('nx', 'ny', 'nz')),
    );
    assert.match(await names(), /Outside coloured by normals/);
    await drop(page, 'figure.ply', ply(points));
    assert.match(await names(), /Plain outside/);
  });

  test('is saved with its colours', async () => {
    await drop(page, 'colours.ply', coloredPly(figure(1)));
    await slide(page, 'keep', 1);
    await tab(page, 'use');
    const folder = mkdtempSync(join(tmpdir(), 'gdel-scan-'));
    const file = readFileSync((await save(page, 'PLY', folder))[0]);
    assert.match(file.toString('latin1'), /property uchar red/);
    const glb = readFileSync((await save(page, 'GLB', folder))[0]);
    rmSync(folder, { recursive: true });
    // What is saved is read again, with its colours.
    await drop(page, 'saved.ply', file);
    await tab(page, 'view');
    assert.ok(await page.getByLabel('Outside in the file’s colours').isVisible());
    await drop(page, 'saved.glb', glb);
    assert.ok(await page.getByLabel('Outside in the file’s colours').isVisible());
    await slide(page, 'keep', 1);
    assert.ok((await shareOfPixels(page, 0)) > 0.02);
  });

  test('may be compressed', async () => {
    await drop(page, 'figure.ply.gz', gzipSync(ply(figure(1))));
    assert.match(await text(page, 'count'), /^3,000 points/);
    await drop(page, 'no.ply.gz', Buffer.from('no gzip'));
    assert.match(await text(page, 'message-text'), /^no\.ply\.gz: The file is not a gzip file/);
  });

  test('that cannot be read says what can', async () => {
    await drop(page, 'photo.jpg', Buffer.from([255]));
    assert.match(await text(page, 'message-text'), /^Can’t read \.jpg\. Supported: PLY, .*\.gz\.$/);
    await drop(page, 'nothing.ply', Buffer.from([]));
    assert.equal(await text(page, 'message-text'), 'nothing.ply: The file is empty.');
  });

  test('of CAD is filled on its large faces, says so, and can be had without', async () => {
    await drop(page, 'bracket.stl', bracket());
    assert.match(
      await text(page, 'note-text'),
      /^[\d,]+ points were put on the model’s large faces/,
    );
    const [points] = numbers(await text(page, 'count'));
    const [added] = numbers(await text(page, 'note-text'));
    assert.equal(points - added, 12);
    assert.equal(await page.locator('input[name=up]:checked').inputValue(), 'z');
    await pictureOf(page, 'scan-cad');
    // The solid is the bracket, not its hull: a sixth of the box around it.
    await slide(page, 'keep', 1);
    await tab(page, 'use');
    const folder = mkdtempSync(join(tmpdir(), 'gdel-scan-'));
    const [saved] = await save(page, 'STL', folder);
    const volume = volumeOf(readFileSync(saved)) / (80 * 40 * 60);
    rmSync(folder, { recursive: true });
    assert.ok(Math.abs(volume - 0.167) < 0.02, `${volume} of the box`);

    await page.getByRole('button', { name: 'Corners only' }).click();
    await settled(page);
    assert.match(await text(page, 'count'), /^12 points/);
    const link = await addressOf(page);
    assert.match(link, /data=/);
    const other = await open(here.browser, link);
    assert.match(await text(other, 'count'), /^12 points/);
    await other.getByRole('button', { name: 'Put points on them' }).click();
    await settled(other);
    assert.equal(numbers(await text(other, 'count'))[0], points);
    assert.deepEqual(other.problems, []);
    await other.context().close();
  });

  test('tells of the points that hold no measurement', async () => {
    const points = figure(1).map((point, i) => (i % 3 ? point : ['nan', 'nan', 'nan']));
    const header = `# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 60\nHEIGHT 50\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3000\nDATA ascii\n`;
    await drop(page, 'organised.pcd', header + xyz(points));
    assert.match(await text(page, 'count'), /^2,000 points/);
    assert.match(await text(page, 'note-text'), /^1,000 points without a measurement/);
  });

  test('is saved as GLB in its own units and place', async () => {
    await drop(page, 'hills.xyz', xyz(airborne()));
    await tab(page, 'use');
    const folder = mkdtempSync(join(tmpdir(), 'gdel-scan-'));
    const glb = readFileSync((await save(page, 'GLB', folder))[0]);
    rmSync(folder, { recursive: true });
    const json = JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)).toString());
    const [{ matrix, scale, translation }] = json.nodes;
    const place = translation ?? matrix.slice(12, 15);
    // z is up in the file, y in GLB.
    assert.ok(Math.abs(place[0] - 500_500) < 20, place.join());
    assert.ok(Math.abs(place[2] + 4_000_300) < 20, place.join());
    const size = scale?.[0] ?? Math.hypot(...matrix.slice(0, 3));
    assert.ok(size > 400 && size < 800, `${size} file units to one of the drawing`);
  });

  test('gives its surface, which is its solid again, in its own units', async () => {
    const cat = figure(1).map((point) => point.map((x) => 500_000 + 100 * x));
    await drop(page, 'cat.ply', ply(cat).replaceAll('property float', 'property double'));
    await tab(page, 'use');
    const folder = mkdtempSync(join(tmpdir(), 'gdel-scan-'));
    const { total } = await shown(page);
    for (const format of ['PLY', 'OBJ', 'STL']) {
      const [file] = await save(page, format, folder);
      gdel('triangulate', file);
      if (format !== 'OBJ') continue;
      const lines = readFileSync(file, 'utf8').split('\n');
      const xs = lines.filter((line) => line.startsWith('v ')).map((line) => line.split(' ')[1]);
      assert.ok(xs.every((x) => x > 499_890 && x < 500_110));
      const triangles = lines.filter((line) => line.startsWith('f ')).length;
      assert.ok(triangles > 100 && triangles < 4 * total, `${triangles} triangles`);
    }
    const png = readFileSync((await save(page, 'PNG', folder))[0]);
    assert.equal(png.subarray(1, 4).toString(), 'PNG');
    rmSync(folder, { recursive: true });
  });

  test('that is small goes with the link', async () => {
    await drop(
      page,
      'small cat.xyz',
      xyz(
        figure(1)
          .slice(0, 300)
          .map((p) => p.map((x) => x.toFixed(3))),
      ),
    );
    const link = await addressOf(page);
    assert.match(link, /data=/);
    const other = await open(here.browser, link);
    assert.equal(await text(other, 'name'), 'small cat.xyz');
    assert.equal(await text(other, 'shown'), await text(page, 'shown'));
    assert.deepEqual(other.problems, []);
    await other.context().close();
  });

  test('may be on the web, in a frame without the panel', async () => {
    const files = createServer((_, response) => {
      response.setHeader('access-control-allow-origin', '*');
      response.end(xyz(figure(1)));
    });
    await new Promise((resolve) => files.listen(0, '127.0.0.1', resolve));
    const url = `http://127.0.0.1:${files.address().port}/web%20cat.xyz`;
    try {
      const other = await open(here.browser, `${here.url}?url=${encodeURIComponent(url)}#embed`);
      assert.equal(await text(other, 'name'), 'web cat.xyz');
      assert.match(await text(other, 'count'), /^3,000 points/);
      assert.ok(await other.locator('#panel').isHidden());
      assert.ok(await other.locator('#keep').isVisible());
      await pictureOf(other, 'embedded');
      await expectAccessible(other, 'embedded');
      const [whole] = await Promise.all([
        other.context().waitForEvent('page'),
        other.click('#whole'),
      ]);
      await whole.locator('#stage[aria-busy="false"]').waitFor();
      assert.ok(await whole.locator('#panel').isVisible());
      assert.equal(await text(whole, 'name'), 'web cat.xyz');
      assert.deepEqual(other.problems, []);
      await other.context().close();
    } finally {
      files.close();
    }
  });

  test('leaves the one before in the history', async () => {
    await drop(page, 'hills.xyz', xyz(airborne()));
    const hills = await text(page, 'count');
    await drop(page, 'figure.ply', ply(figure(1)));
    const before = await text(page, 'count');
    assert.notEqual(before, hills);
    await page.goBack();
    await until(page, (hills) => document.querySelector('#count').textContent === hills, hills);
    await settled(page);
    await page.goForward();
    await until(page, (before) => document.querySelector('#count').textContent === before, before);
    await settled(page);
  });

  test('is shown whole, then cut, where motion is welcome', async () => {
    const still = await open(here.browser, `${here.url}#points=uniform_200_1`);
    const moving = await open(here.browser, `${here.url}#points=uniform_200_1`, {
      reducedMotion: 'no-preference',
    });
    assert.equal(await text(moving, 'shown'), await text(still, 'shown'));
    assert.equal(await moving.inputValue('#keep'), await still.inputValue('#keep'));
    for (const each of [still, moving]) await each.context().close();
  });

  test('has gone through all this without an error in the console', () => {
    assert.deepEqual(page.problems, []);
  });
});

describe('in difficult surroundings', () => {
  const here = site();

  test('works where the browser stores nothing', async () => {
    const page = await open(here.browser, `${here.url}#points=uniform_200_1`, {}, (context) =>
      context.addInitScript(() =>
        Object.defineProperty(window, 'localStorage', {
          get() {
            throw new DOMException('denied', 'SecurityError');
          },
        }),
      ),
    );
    assert.match(await text(page, 'count'), /^200 points/);
    const before = await page.evaluate(() => document.documentElement.dataset.theme);
    await page.click('#theme');
    assert.notEqual(await page.evaluate(() => document.documentElement.dataset.theme), before);
    assert.deepEqual(page.problems, []);
    await page.context().close();
  });

  test('works in a sandboxed frame', async () => {
    const outer = createServer((_, response) => {
      response.setHeader('content-type', 'text/html');
      response.end(
        `<iframe sandbox="allow-scripts" width="1200" height="800" src="${here.url}#points=uniform_200_1&embed=1"></iframe>`,
      );
    });
    await new Promise((resolve) => outer.listen(0, '127.0.0.1', resolve));
    const context = await here.browser.newContext({ reducedMotion: 'reduce' });
    try {
      const page = await context.newPage();
      await page.goto(`http://127.0.0.1:${outer.address().port}`);
      const frame = page.frameLocator('iframe');
      await frame.locator('#count', { hasText: '200 points' }).waitFor();
      await frame.locator('#stage[aria-busy="false"]').waitFor();
      assert.ok(await frame.locator('#message').isHidden());
      assert.ok(await frame.locator('#panel').isHidden());
      const all = await frame.locator('#shown').textContent();
      await frame.locator('#keep').press('Home');
      await frame.locator('#shown', { hasText: /^0 of/ }).waitFor();
      assert.match(all, /^[1-9]/);
    } finally {
      await context.close();
      outer.close();
    }
  });

  test('says in words that the connection is gone', async () => {
    const page = await open(here.browser, `${here.url}#points=uniform_200_1`);
    await page.context().setOffline(true);
    await tab(page, 'points');
    await page.getByRole('button', { name: 'Stanford dragon' }).click();
    await settled(page);
    assert.equal(
      await text(page, 'message-text'),
      'Stanford dragon could not be loaded. Check your connection and try again.',
    );
    await tab(page, 'use');
    await until(page, () =>
      document.querySelector('#code').textContent.startsWith('// The code could not be loaded.'),
    );
    await page.getByRole('button', { name: 'GLB', exact: true }).click();
    await until(page, () =>
      document.querySelector('#message-text').textContent.startsWith('GLB could not be loaded.'),
    );
    // What is there still works, and ends the message.
    const folder = mkdtempSync(join(tmpdir(), 'gdel-scan-'));
    await save(page, 'OBJ', folder);
    rmSync(folder, { recursive: true });
    assert.ok(await page.locator('#message').isHidden());
    await tab(page, 'points');
    await choose(page, 'dimension', '2');
    await page.context().close();
  });
});
