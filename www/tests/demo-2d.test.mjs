import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { delaunay2d, generate2d } from 'gdel-wasm';
import {
  addressOf,
  choose,
  colorBy,
  compare,
  copied,
  drop,
  expectAccessiblePanels,
  expectAlphaShape,
  gdel,
  generate,
  hrefOf,
  open,
  openOnPhone,
  pictureOf,
  prove,
  save,
  settled,
  shown,
  slide,
  tab,
  text,
  until,
} from './browser.mjs';
import { site } from './site.mjs';

const root = fileURLToPath(new URL('../../', import.meta.url));

/** A place on the canvas, as a share of its width and height. */
async function at(page, x, y) {
  const box = await page.locator('#canvas').boundingBox();
  return [box.x + x * box.width, box.y + y * box.height];
}

async function click(page, x, y) {
  await page.mouse.click(...(await at(page, x, y)));
  await settled(page);
}

async function press(page, key) {
  await page.keyboard.press(key);
  await settled(page);
}

describe('2D', () => {
  let page;
  const here = site({}, async ({ browser, url }) => {
    page = await open(browser, `${url}#dim=2`);
  });

  test('shows triangles with their Voronoi diagram at once', async () => {
    assert.match(await text(page, 'count'), /^200 points → \d+ triangles$/);
    const { shown: all, total } = await shown(page);
    assert.ok(all === total && total > 350 && total < 400, `${total} triangles`);
    await pictureOf(page, '2d-first-view');
  });

  test('tells about the triangle under the pointer', async () => {
    await page.mouse.move(...(await at(page, 0.5, 0.5)));
    await page.locator('#tip').waitFor();
    assert.match(await text(page, 'tip'), /x.*y.*triangle.*vertices.*area.*circumradius/);
    await pictureOf(page, '2d-tip');
  });

  test('points are added, moved, removed and taken back with the mouse', async () => {
    await tab(page, 'points');
    await page.click('#clear');
    await settled(page);
    assert.match(await text(page, 'count'), /^No points/);
    await click(page, 0.3, 0.3);
    assert.match(await text(page, 'count'), /^One point/);
    await click(page, 0.7, 0.7);
    assert.match(await text(page, 'count'), /on one line/);
    await pictureOf(page, '2d-two-points');
    for (const [n, x, y] of [
      [3, 0.7, 0.3],
      [4, 0.3, 0.7],
      [5, 0.5, 0.52],
    ]) {
      await click(page, x, y);
      assert.ok((await text(page, 'count')).startsWith(`${n} points`));
    }
    assert.equal(await text(page, 'count'), '5 points → 4 triangles');

    // Out of the square, past a corner.
    await choose(page, 'tool', 'move');
    assert.doesNotMatch(await addressOf(page), /move_4_/);
    await page.mouse.move(...(await at(page, 0.5, 0.52)));
    await page.mouse.down();
    for (let x = 0.5; x < 0.83; x += 0.04) await page.mouse.move(...(await at(page, x, 0.52)));
    await page.mouse.up();
    await settled(page);
    assert.equal(await text(page, 'count'), '5 points → 3 triangles');
    await pictureOf(page, '2d-drawn');
    await until(page, () => location.hash.includes('move_4_'));
    // One change, however many steps the way had.
    assert.equal((await hrefOf(page)).match(/move/g).length, 1);

    await page.click('#undo');
    await settled(page);
    assert.equal(await text(page, 'count'), '5 points → 4 triangles');
    await page.click('#redo');
    await settled(page);
    assert.equal(await text(page, 'count'), '5 points → 3 triangles');
    await page.click('#undo');
    await settled(page);
    assert.ok(await page.locator('#redo').isEnabled());
    await choose(page, 'tool', 'remove');
    await click(page, 0.5, 0.52);
    assert.equal(await text(page, 'count'), '4 points → 2 triangles');
    // After another change, there is nothing to bring back.
    assert.ok(await page.locator('#redo').isDisabled());
  });

  test('points are added, moved and removed with the keys', async () => {
    await page.focus('#canvas');
    await press(page, 'Enter');
    assert.equal(await text(page, 'count'), '5 points → 4 triangles');
    await pictureOf(page, '2d-cross');
    await press(page, 'Space');
    assert.equal(await text(page, 'edited'), 'Point held');
    const before = await hrefOf(page);
    for (let i = 0; i < 6; i++) await press(page, 'ArrowLeft');
    await until(page, (before) => location.href !== before, before);
    await press(page, 'Space');
    for (const key of ['Control+z', 'Control+Shift+z', 'Control+z', 'Control+y', 'Control+z'])
      await press(page, key);
    assert.equal(await text(page, 'count'), '5 points → 4 triangles');
    await press(page, 'Delete');
    assert.equal(await text(page, 'count'), '4 points → 2 triangles');
    // Without a point in hand, they move the view.
    const still = await text(page, 'count');
    await page.keyboard.press('ArrowUp');
    await page.keyboard.press('+');
    await until(page, () => location.hash.includes('camera='));
    assert.equal(await text(page, 'count'), still);
    await page.keyboard.press('Home');
  });

  test('the wheel zooms to the pointer, and dragging the ground moves it', async () => {
    await generate(page, 'uniform', 300);
    await choose(page, 'tool', 'move');
    const count = await text(page, 'count');
    await page.mouse.move(...(await at(page, 0.6, 0.4)));
    await page.mouse.wheel(0, -600);
    await until(page, () => location.hash.includes('camera='));
    const zoomed = await hrefOf(page);
    await page.mouse.move(...(await at(page, 0.15, 0.9)));
    await page.mouse.down();
    await page.mouse.move(...(await at(page, 0.3, 0.8)), { steps: 4 });
    await page.mouse.up();
    await until(page, (zoomed) => location.href !== zoomed, zoomed);
    assert.equal(await text(page, 'count'), count);
    await pictureOf(page, '2d-zoomed');
    await page.click('#reset');
  });

  test('a link brings back the points, the changes and the view', async () => {
    await generate(page, 'disk', 40);
    await choose(page, 'tool', 'add');
    await click(page, 0.2, 0.25);
    assert.match(await text(page, 'count'), /^41 points/);
    await colorBy(page, 'circumradius');
    await page.getByLabel('Voronoi', { exact: true }).uncheck();
    const link = await copied(page, '#share');
    assert.match(link, /dim=2.*disk_40_1.*edits=add_/);
    const other = await open(here.browser, link);
    for (const id of ['shown', 'count', 'legend-title', 'legend-low', 'legend-high']) {
      assert.equal(await text(other, id), await text(page, id), id);
    }
    assert.deepEqual(other.problems, []);
    await other.context().close();
  });

  test('shows the alpha complex', async () => {
    await generate(page, 'thin-circle', 400);
    await tab(page, 'view');
    await page.getByLabel('Voronoi', { exact: true }).check();
    await settled(page);
    const { total } = await shown(page);
    await choose(page, 'filter', 'alpha');
    assert.ok(await page.locator('#alpha').isVisible());
    await expectAlphaShape(
      page,
      await delaunay2d(await generate2d('thin-circle', 400, { seed: 1 })),
    );
    await slide(page, 'alpha', 0.5);
    assert.ok((await shown(page)).shown < total);
    await pictureOf(page, '2d-alpha');
    // Points that are changed by hand have a radius of their own.
    await page.click('#alpha-auto');
    await choose(page, 'tool', 'add');
    await click(page, 0.3, 0.3);
    assert.equal(await page.getAttribute('#alpha-auto', 'aria-pressed'), 'true');
    const other = await open(here.browser, await addressOf(page));
    for (const id of ['shown', 'count', 'alpha-value'])
      assert.equal(await text(other, id), await text(page, id), id);
    assert.deepEqual(other.problems, []);
    await other.context().close();
    await choose(page, 'tool', 'move');
    await choose(page, 'filter', 'all');
    assert.ok(!(await page.locator('#alpha').isVisible()));
  });

  test('hard input is drawn and proven: circle, grid with duplicates, two lines, clusters', async () => {
    for (const distribution of ['circle', 'grid', 'two-lines', 'clusters']) {
      await generate(page, distribution, 600);
      await pictureOf(page, `2d-${distribution}`);
      const { note, passed, failed } = await prove(page);
      assert.match(note, /^Proven/, distribution);
      assert.ok(passed >= 8 && failed === 0, distribution);
    }
  });

  test('runs delaunator on the same points', async () => {
    await generate(page, 'uniform', 5000);
    const note = await compare(page);
    assert.match(
      note,
      /CPU backend: ([\d,]+) triangles, the same number\. delaunator: \1 triangles, the same number\. delaunator took/,
    );
    await pictureOf(page, '2d-compare');
  });

  test('triangulates moving points live, and stops', async () => {
    await tab(page, 'points');
    const before = await text(page, 'count');
    await page.fill('#live-number', '800');
    await page.click('#live');
    await until(page, () =>
      /moving points → [\d,]+ triangles/.test(document.querySelector('#count').textContent),
    );
    // The first frame has none before it.
    await until(page, () =>
      /^(Mesh kept: [\d,]+ triangles? inverted, [\d,]+ flips?|From scratch: )/.test(
        document.querySelector('#backend-used').textContent,
      ),
    );
    await pictureOf(page, '2d-live');
    await page.click('#live');
    await settled(page);
    assert.equal(await text(page, 'count'), before);
  });

  test('takes a scan from above, and goes to 3D and back', async () => {
    await drop(page, 'scan.ply', readFileSync(join(root, 'tests/data/bunny.ply')));
    assert.match(await text(page, 'count'), /^35,947 points → [\d,]+ triangles$/);
    const flat = await text(page, 'count');
    await pictureOf(page, '2d-scan');
    await choose(page, 'dimension', '3');
    assert.equal(await text(page, 'count'), '35,947 points → 246,218 tetrahedra');
    await choose(page, 'dimension', '2');
    assert.equal(await text(page, 'count'), flat);
  });

  test('says that points on a line have no triangles, and goes on', async () => {
    await drop(page, 'line.xyz', '0 0 0\n1 1 0\n3 3 0\n4 4 7\n');
    assert.match(await text(page, 'count'), /on one line/);
    await pictureOf(page, '2d-line');
  });

  test('downloads what the command line proves', async () => {
    await generate(page, 'grid', 500);
    await tab(page, 'use');
    const folder = mkdtempSync(join(tmpdir(), 'gdel-demo-'));
    const file = join(folder, 'points.xyz');
    gdel('generate', '--dim', '2', 'grid', '500', '--seed', '1', '-o', file);
    for (const [format, files, mesh] of [
      ['VTU', 1, '.vtu'],
      ['NPZ', 1, '.npz'],
      ['TetGen', 3, '.ele'],
    ]) {
      const saved = await save(page, format, folder, files);
      // Fails if the mesh is not the Delaunay triangulation of the points.
      gdel(
        'verify',
        '--dim',
        '2',
        file,
        saved.find((path) => path.endsWith(mesh)),
      );
    }
    for (const format of ['PLY', 'OBJ', 'STL'])
      gdel('triangulate', '--dim', '2', (await save(page, format, folder))[0]);
    assert.equal(
      readFileSync((await save(page, 'GLB', folder))[0])
        .subarray(0, 4)
        .toString(),
      'glTF',
    );
    const svg = readFileSync((await save(page, 'SVG', folder))[0], 'utf8');
    const { total } = await shown(page);
    assert.equal(svg.match(/<path fill="rgb/g).length, total);
    writeFileSync(fileURLToPath(new URL('screenshots/plane.svg', import.meta.url)), svg);
    rmSync(folder, { recursive: true });
  });

  test('has done all this without an error in the console', () => {
    assert.deepEqual(page.problems, []);
  });

  for (const colorScheme of ['light', 'dark']) {
    test(`has no accessibility faults, ${colorScheme}`, async () => {
      const page = await open(here.browser, `${here.url}#dim=2`, {
        colorScheme,
        reducedMotion: 'reduce',
      });
      await expectAccessiblePanels(page, `2d-${colorScheme}`);
      await page.context().close();
    });
  }

  test('has no accessibility faults on a phone', async () => {
    const page = await openOnPhone(here.browser, `${here.url}#dim=2&points=uniform_60_1`, {
      colorScheme: 'dark',
    });
    await expectAccessiblePanels(page, '2d-phone-dark');
    await page.context().close();
  });

  test('works on a phone by touch', async () => {
    const page = await openOnPhone(here.browser, `${here.url}#dim=2&points=uniform_60_1`);
    await page.touchscreen.tap(...(await at(page, 0.5, 0.6)));
    await page.locator('#tip').waitFor();
    await pictureOf(page, '2d-phone');
    for (const [tool, count] of [
      ['add', 61],
      ['remove', 60],
    ]) {
      await choose(page, 'tool', tool);
      await page.touchscreen.tap(...(await at(page, 0.1, 0.93)));
      await settled(page);
      assert.match(await text(page, 'count'), new RegExp(`^${count} points`));
    }
    assert.deepEqual(page.problems, []);
    await page.context().close();
  });
});
