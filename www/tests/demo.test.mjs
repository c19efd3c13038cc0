import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { delaunay3d, generate as generatePoints, readPoints } from 'gdel-wasm';
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
  numbers,
  open,
  openOnPhone,
  pictureOf,
  prove,
  request,
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
const bunny = readFileSync(join(root, 'tests/data/bunny.ply'));

describe('drawing with WebGPU, triangulating on the CPU', () => {
  let page;
  const here = site({}, async ({ browser, url }) => {
    page = await open(browser, url);
  });

  test('shows the bunny at once, carved and cut', async () => {
    assert.match(await text(page, 'count'), /^35,947 points → 246,218 tetrahedra$/);
    assert.match(await text(page, 'took'), /^[\d.]+ m?s$/);
    const counts = await shown(page);
    assert.equal(counts.total, 246_218);
    assert.ok(counts.shown > 60_000 && counts.shown < 120_000, `${counts.shown} shown`);
    await pictureOf(page, '3d-first-view');
  });

  test('says that coplanar points have no tetrahedra, and goes on', async () => {
    await drop(page, 'flat.xyz', '0 0 0\n1 0 0\n0 1 0\n1 1 0\n');
    assert.match(await text(page, 'count'), /in one plane/);
    await pictureOf(page, '3d-flat');
  });

  test('cuts, colours and pulls apart', async () => {
    await generate(page, 'uniform', 5000);
    await slide(page, 'keep', 1);
    assert.match(await text(page, 'shown'), /^all/);
    await slide(page, 'keep', 0.5);
    const half = await shown(page);
    assert.ok(half.shown > 0.4 * half.total && half.shown < 0.6 * half.total);

    for (const [color, title] of [
      ['quality', 'Radius ratio'],
      ['volume', 'Volume'],
      ['circumradius', 'Circumradius'],
    ]) {
      await colorBy(page, color);
      assert.ok((await text(page, 'legend-title')).startsWith(title));
      await pictureOf(page, `3d-colour-${color}`);
    }
    await slide(page, 'apart', 0.4);
    await pictureOf(page, '3d-apart');
    await slide(page, 'apart', 0);

    await choose(page, 'filter', 'alpha');
    await slide(page, 'alpha', 0.3);
    assert.notEqual((await shown(page)).shown, half.shown);
    await pictureOf(page, '3d-alpha');
  });

  test('the alpha slider stops where simplices come in, and Auto is the radius that suits', async () => {
    await generate(page, 'uniform', 12);
    await slide(page, 'keep', 1);
    await choose(page, 'filter', 'alpha');
    await choose(page, 'mode', 'solid');
    const auto = page.getByRole('button', { name: 'Auto', exact: true });
    const isAuto = () => auto.getAttribute('aria-pressed');
    await expectAlphaShape(
      page,
      await delaunay3d(await generatePoints('uniform', 12, { seed: 1 })),
    );

    // By hand, and on by single steps: each shows more tetrahedra, up to all of them.
    await slide(page, 'alpha', 0);
    assert.equal(await isAuto(), 'false');
    await page.focus('#alpha');
    let { shown: before, total } = await shown(page);
    let steps = 0;
    for (; (await text(page, 'alpha-value')) !== 'everything'; steps++) {
      await page.keyboard.press('ArrowRight');
      await settled(page);
      const { shown: now } = await shown(page);
      assert.ok(now > before || now === total, `${now} after ${before}`);
      before = now;
    }
    assert.equal(before, total);
    assert.ok(steps > 1 && steps <= total, `${steps} steps for ${total} tetrahedra`);

    // From everything, the slider leads back to the solid.
    await slide(page, 'alpha', 0);
    assert.equal(await isAuto(), 'true');
    const suiting = await text(page, 'alpha-value');
    await slide(page, 'alpha', 0);
    assert.equal(await isAuto(), 'false');
    assert.match(await addressOf(page), /alpha=\d/);
    await auto.click();
    await settled(page);
    assert.deepEqual([await text(page, 'alpha-value'), await isAuto()], [suiting, 'true']);
    assert.doesNotMatch(await addressOf(page), /alpha=\d/);
    await pictureOf(page, '3d-alpha-auto');
    await choose(page, 'mode', 'slice');
    await choose(page, 'filter', 'all');
  });

  test('the radius that suits a scan is the one of the package, also in files', async () => {
    await drop(page, 'scan.ply', bunny);
    const { points } = await readPoints(new Blob([bunny]), { name: 'scan.ply' });
    const mesh = await delaunay3d(points);
    await slide(page, 'keep', 1);
    await choose(page, 'filter', 'alpha');
    await expectAlphaShape(page, mesh);
    await tab(page, 'use');
    const folder = mkdtempSync(join(tmpdir(), 'gdel-alpha-'));
    const saved = readFileSync((await save(page, 'STL', folder))[0]);
    rmSync(folder, { recursive: true });
    const { surface } = await mesh.alphaShape({ alpha: 'auto' });
    assert.equal(saved.readUInt32LE(80), surface.length / 3);
  });

  test('while a radius is sought, another one or other points may be asked for', async () => {
    await generate(page, 'uniform', 20_000);
    const mesh = await delaunay3d(await generatePoints('uniform', 20_000, { seed: 1 }));
    await slide(page, 'keep', 1);
    /** Chooses the filter, and goes on before the page knows its radius. */
    const chooseAnd = (goOn, argument) =>
      page.evaluate(`{
        document.querySelector('input[name=filter][value=alpha]').click();
        (${goOn})(${JSON.stringify(argument)});
      }`);
    const goTo = (hash) => {
      location.hash = hash;
    };
    const waitFor = async (alpha) => {
      const text = `α = ${Number(alpha.toPrecision(3))}`;
      await until(
        page,
        (text) => document.querySelector('#alpha-value').textContent === text,
        text,
      );
      await settled(page);
    };

    // A radius of the visitor's stays, and the one that suits is there when it is wanted.
    const { hash } = new URL(await addressOf(page));
    await chooseAnd(goTo, `${hash}&filter=alpha&alpha=0.05`);
    await waitFor(0.05);
    assert.equal(await page.getAttribute('#alpha-auto', 'aria-pressed'), 'false');
    await choose(page, 'mode', 'solid');
    await page.click('#alpha-auto');
    await settled(page);
    await expectAlphaShape(page, mesh);

    // Who cancels sees everything, and may ask again.
    await generate(page, 'ball', 20_000);
    await chooseAnd(() => document.querySelector('#cancel').click());
    await settled(page);
    assert.match(await text(page, 'message-text'), /^Cancelled/);
    assert.ok(await page.isChecked('input[name=filter][value=all]'));
    await slide(page, 'keep', 1);
    await choose(page, 'filter', 'alpha');
    await expectAlphaShape(
      page,
      await delaunay3d(await generatePoints('ball', 20_000, { seed: 1 })),
    );
    await choose(page, 'filter', 'all');

    // Other points have their own.
    await generate(page, 'uniform', 20_000);
    const other = await delaunay3d(await generatePoints('uniform', 500, { seed: 7 }));
    await chooseAnd(goTo, '#points=uniform_500_7&filter=alpha&keep=1');
    await waitFor((await other.alphaShape()).alpha);
    await expectAlphaShape(page, other);
    await choose(page, 'mode', 'slice');
  });

  test('tells about the tetrahedron under the pointer', async () => {
    await generate(page, 'uniform', 5000);
    await page.mouse.move(520, 450);
    await page.locator('#tip').waitFor();
    assert.match(await text(page, 'tip'), /tetrahedron.*vertices.*circumradius/);
    await pictureOf(page, '3d-tip');
  });

  test('turns by the arrow keys', async () => {
    assert.doesNotMatch(await addressOf(page), /camera=/);
    await page.focus('#canvas');
    for (let i = 0; i < 5; i++) await page.keyboard.press('ArrowLeft');
    await until(page, () => location.hash.includes('camera='));
    await page.keyboard.press('[');
    await until(page, () => location.hash.includes('keep='));
  });

  test('takes a dropped scan', async () => {
    await drop(page, 'scan.ply', bunny);
    assert.match(await text(page, 'count'), /^35,947 /);
    assert.equal((await shown(page)).total, 246_218);
  });

  test('says what is wrong with a broken file, and goes on', async () => {
    await drop(page, 'broken.ply', bunny.subarray(0, 5000));
    assert.ok(await page.locator('#message').isVisible());
    assert.match(await text(page, 'message-text'), /^broken\.ply: .{10,}/);
    await pictureOf(page, '3d-broken-file');
    await drop(page, 'picture.jpg', Buffer.from([255, 216, 255]));
    assert.match(await text(page, 'message-text'), /^Can’t read \.jpg/);
    await page.click('#message-close');
    await generate(page, 'gaussian', 1000);
    assert.ok(await page.locator('#message').isHidden());
  });

  test('can be cancelled', async () => {
    const before = await text(page, 'count');
    await request(page, 'uniform', 2_000_000);
    await page.locator('#cancel').click();
    await settled(page);
    assert.match(await text(page, 'message-text'), /^Cancelled/);
    assert.equal(await text(page, 'count'), before);
    assert.ok(await page.locator('#busy').isHidden());
  });

  test('makes a link that shows the same', async () => {
    await generate(page, 'thin-sphere', 2000);
    await colorBy(page, 'volume');
    await slide(page, 'keep', 0.7);
    await choose(page, 'normal', 'Y');
    const link = await copied(page, '#share');
    assert.match(link, /thin-sphere_2000/);
    const other = await open(here.browser, link);
    for (const id of ['shown', 'count', 'legend-title', 'legend-low', 'legend-high']) {
      assert.equal(await text(other, id), await text(page, id), id);
    }
    assert.deepEqual(other.problems, []);
    await other.context().close();
  });

  test('compares backends and proves the mesh', async () => {
    await generate(page, 'grid', 3000);
    const note = await compare(page);
    assert.match(note, /GPU backend: left out/);
    assert.match(note, /CPU backend: [\d,]+ tetrahedra, the same number/);
    assert.match(note, /qhull-wasm: .* qhull-wasm took [\d.]+ times as long/);
    assert.equal(await page.locator('#times svg rect').count(), 2);
    const { note: verdict, passed, failed } = await prove(page);
    assert.match(verdict, /^Proven/);
    assert.ok(passed >= 4 && failed === 0);
    await pictureOf(page, '3d-compare');
  });

  test('triangulates moving points live, and stops', async () => {
    await tab(page, 'points');
    const before = await text(page, 'count');
    await page.fill('#live-number', '500');
    await page.click('#live');
    await until(page, () =>
      document.querySelector('#took').textContent.includes('frames per second'),
    );
    await page.locator('#live-times svg').waitFor();
    // What was found out about the mesh before is not said of moving points.
    assert.equal(await text(page, 'ratio'), '');
    assert.equal(await text(page, 'verify-here'), 'Verify');
    assert.ok(await page.locator('#verify-here').isDisabled());
    // The first frame has none before it.
    await until(page, () =>
      /^(Mesh kept: [\d,]+ tetrahedr(on|a) inverted, [\d,]+ flips?|From scratch: )/.test(
        document.querySelector('#backend-used').textContent,
      ),
    );
    assert.match(
      await page.textContent('#live-times .note'),
      /^Milliseconds to triangulate, for the last [\d,]+ frames?, of which [\d,]+ kept/,
    );
    await pictureOf(page, '3d-live');
    await page.click('#live');
    await settled(page);
    assert.equal(await text(page, 'count'), before);
    assert.ok(await page.locator('#verify-here').isEnabled());
  });

  test('downloads what the command line proves', async () => {
    await tab(page, 'points');
    await page.click('#gallery button');
    await settled(page);
    assert.match(await text(page, 'count'), /^35,947 /);
    await tab(page, 'use');
    const folder = mkdtempSync(join(tmpdir(), 'gdel-demo-'));
    const points = join(folder, 'points.ply');
    writeFileSync(points, bunny);
    for (const [format, files, mesh] of [
      ['VTU', 1, '.vtu'],
      ['NPZ', 1, '.npz'],
      ['TetGen', 3, '.ele'],
    ]) {
      const saved = await save(page, format, folder, files);
      // Fails if the mesh is not the Delaunay triangulation of the points.
      gdel(
        'verify',
        points,
        saved.find((path) => path.endsWith(mesh)),
      );
    }
    for (const format of ['PLY', 'OBJ', 'STL']) {
      const [surface] = await save(page, format, folder);
      // The surface's corners are the points of its file.
      gdel('triangulate', surface);
    }
    const [glb] = await save(page, 'GLB', folder);
    assert.equal(readFileSync(glb).subarray(0, 4).toString(), 'glTF');
    rmSync(folder, { recursive: true });
  });

  test('has code to copy', async () => {
    await tab(page, 'use');
    const code = await copied(page, '#copy');
    assert.match(code, /import \{ delaunay3d, readPoints \}\s+from 'gdel-wasm'/);
    await pictureOf(page, '3d-use');
  });

  test('has done all this without an error in the console', () => {
    // The browser itself reports the requests that the tests make fail.
    assert.deepEqual(page.problems, []);
  });

  for (const colorScheme of ['light', 'dark']) {
    test(`has no accessibility faults, ${colorScheme}`, async () => {
      const page = await open(here.browser, here.url, { colorScheme, reducedMotion: 'reduce' });
      await expectAccessiblePanels(page, `3d-${colorScheme}`);
      await page.context().close();
    });

    test(`has no accessibility faults on a phone, ${colorScheme}`, async () => {
      const page = await openOnPhone(here.browser, `${here.url}#points=ball_500_1`, {
        colorScheme,
      });
      await expectAccessiblePanels(page, `3d-phone-${colorScheme}`);
      await page.context().close();
    });
  }

  test('fits a phone', async () => {
    const page = await openOnPhone(here.browser, here.url);
    await pictureOf(page, '3d-phone');
    await page.touchscreen.tap(215, 340);
    await page.locator('#tip').waitFor();
    await pictureOf(page, '3d-phone-tip');
    // What it says would lie under the sheet.
    await tab(page, 'view');
    assert.ok(await page.locator('#tip').isHidden());
    await page.context().close();
  });
});

describe('without WebGPU', () => {
  const here = site({ webgpu: false });

  test('works on the CPU, draws with WebGL, and says so', async () => {
    const page = await open(here.browser, here.url);
    assert.match(await text(page, 'backend-used'), /^On the CPU: /);
    assert.equal((await shown(page)).total, 246_218);
    await tab(page, 'use');
    await until(page, () => document.querySelector('#machine').textContent.includes('WebGL 2'));
    await pictureOf(page, '3d-no-webgpu');
    await tab(page, 'points');
    // What needs a GPU is not offered, and says why.
    assert.ok(await page.locator('input[name=backend][value=gpu]').isDisabled());
    assert.match(await text(page, 'backend-note'), /no GPU/);
    await tab(page, 'view');
    assert.equal(await page.locator('#color [value=phase]:disabled').count(), 1);
    await tab(page, 'run');
    assert.ok(await page.locator('#record').isDisabled());
    assert.ok(await page.locator('#watch').isDisabled());
    assert.match(await text(page, 'watch-note'), /needs a GPU/);
    assert.ok(numbers(await text(page, 'count')).length > 0);
    assert.deepEqual(page.problems, []);
  });
});
