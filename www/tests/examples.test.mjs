// The examples: each runs from the built page without a request to anywhere else, can be changed and copied, and its copies
// run, too.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { deflateRawSync } from 'node:zlib';
import { launchChromium, launchFirefox, WEBGPU_AND_WEBGL } from '../../tests/web/browsers.mjs';
import { copied, expectAccessible, numbers, pictureOf, serve } from './browser.mjs';

const programs = new URL('../programs/', import.meta.url);
const read = (name) => readFileSync(new URL(name, programs), 'utf8');
const catalogue = JSON.parse(read('catalogue.json'));
const packages = JSON.parse(read('packages.json'));

let server;
let browser;
/** All examples run in one page. */
let page;
before(async () => {
  server = await serve();
  browser = await launchChromium(WEBGPU_AND_WEBGL);
  page = await newPage();
});
after(async () => {
  await browser?.close();
  await server?.close();
});

/** A page that collects what it says on the console, and what it asks of other hosts. */
async function newPage(options = {}) {
  const context = await browser.newContext({
    viewport: { width: 1280, height: 720 },
    deviceScaleFactor: 0.5,
    colorScheme: 'light',
    reducedMotion: 'reduce',
    permissions: ['clipboard-read', 'clipboard-write'],
    ...options,
  });
  // Playwright blocks service workers by a script that fails in frames without an origin.
  await context.addInitScript(() => {
    if (self === top && navigator.serviceWorker)
      navigator.serviceWorker.register = () => Promise.reject(new Error('blocked'));
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
  return page;
}

/** Opens a page of the examples, with nothing left of the last one. */
async function visit(path, where = page) {
  await where.goto('about:blank');
  await where.goto(`${server.url}examples/${path}`);
}

const state = (name, where = page) => where.locator(`main[data-state="${name}"]`).waitFor();

/** Opens an example and waits until its code has run. Returns what it shows. */
async function open(path, where = page) {
  await visit(path, where);
  await state('done', where);
  return where.frameLocator('iframe');
}

/** Opens an example for a test, which ends without problems, and with a copy that is complete. */
async function withExample(name, expect) {
  page.problems.length = 0;
  await expect(await open(`${name}/`));
  expectComplete(await copied(page, '#copy-page'), await copied(page, '#copy-npm'), name);
  assert.deepEqual(page.problems, []);
}

/** Expects that a page maps all that its code imports, and that the line to install it names all. */
function expectComplete(html, module, name) {
  const [, json] = /<script type="importmap">(.*?)<\/script>/s.exec(html);
  const { imports } = JSON.parse(json);
  const code = read(`${name}.js`);
  assert.ok(html.includes(code.replaceAll('</script', '<\\/script')), 'the code is in the page');
  assert.ok(module.endsWith(code), 'the code is in the module');
  const imported = [...code.matchAll(/(?:from|resolve\()\s*'([^'.]+(?:\.js)?)'/g)].map(
    ([, of]) => of,
  );
  assert.ok(imported.length > 0);
  const install = /npm install (.*)/.exec(module)[1].split(' ');
  for (const of of imported) {
    assert.match(
      imports[of],
      /^https:\/\/(cdn\.jsdelivr\.net\/npm|esm\.sh)\/\S+@\d+\.\d+\.\d+/,
      of,
    );
    assert.ok(
      install.some((one) => of === one || of.startsWith(`${one}/`)),
      of,
    );
  }
}

const note = (frame) => frame.locator('p').first().textContent();

/** Waits until the first paragraph matches. */
const says = (frame, pattern) => frame.locator('p', { hasText: pattern }).first().waitFor();

/** The share of the pixels of a drawing that are not of its most frequent colour, and how many colours there are. */
async function seen(locator) {
  const png = (await locator.screenshot()).toString('base64');
  return page.evaluate(async (png) => {
    const image = await createImageBitmap(
      await (await fetch(`data:image/png;base64,${png}`)).blob(),
    );
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
    context.drawImage(image, 0, 0);
    const pixels = new Uint32Array(
      context.getImageData(0, 0, image.width, image.height).data.buffer,
    );
    const counts = new Map();
    for (const pixel of pixels) counts.set(pixel, (counts.get(pixel) ?? 0) + 1);
    return { share: 1 - Math.max(...counts.values()) / pixels.length, colors: counts.size };
  }, png);
}

/** Expects a drawing that covers so much of its canvas. */
async function expectDrawn(result, least, most, colors = 20) {
  const found = await seen(result.locator('canvas').first());
  assert.ok(found.share > least && found.share < most, `${found.share} of the canvas is drawn on`);
  assert.ok(found.colors >= colors, `${found.colors} colours`);
}

describe('every example runs', () => {
  test('a scan becomes a file for a printer', () =>
    withExample('scan', async (result) => {
      assert.match(await note(result), /^8987 points, 17966 triangles: watertight, 753 cm³$/);
      await expectDrawn(result, 0.1, 0.7);
      const download = page.waitForEvent('download');
      await result.getByRole('button').click();
      assert.equal(statSync(await (await download).path()).size, 84 + 50 * 17966);
    }));

  test('balls fall on a scan', () =>
    withExample('collider', async (result) => {
      await says(result, /^17966 triangles, [1-8]\d of 80 balls are down/);
      await expectDrawn(result, 0.1, 0.8);
    }));

  test('a point cloud in deck.gl', () =>
    withExample('deck', async (result) => {
      await result.locator('[data-drawn="8987"]').waitFor();
      assert.match(await note(result), /usually 3\.5 mm away/);
      await expectDrawn(result, 0.05, 0.8);
    }));

  test('an alpha shape follows its slider', () =>
    withExample('alpha', async (result) => {
      assert.match(await note(result), /^Radius 14\.5: 1549 triangles in 1 part$/);
      const solid = await result.locator('path').first().getAttribute('d');
      assert.equal(solid.split('M').length - 1, 1549);
      await result.getByRole('slider').fill('5');
      await says(result, /^Radius 5\.0: \d+ triangles in \d\d+ parts$/);
    }));

  test('terrain keeps its breaklines', () =>
    withExample('terrain', async (result) => {
      const [vertices, points, error, edges] = numbers(await note(result));
      assert.ok(vertices < points / 5 && error <= 0.25 && edges >= 120, await note(result));
      await expectDrawn(result, 0.2, 0.8);
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
    withExample('cities', async (result) => {
      assert.match(await note(result), /^Paris is nearest, one of 135, /);
      const { x, y, width, height } = await result.locator('canvas').boundingBox();
      await page.mouse.move(x + width / 2, y + height * 0.79);
      await says(result, /^(Luanda|Kinshasa|Windhoek) is nearest/);
      await expectDrawn(result, 0.5, 0.9);
    }));

  test('natural neighbours are nearer to what was sampled', () =>
    withExample('natural', async (result) => {
      assert.equal(await result.locator('canvas').count(), 3);
      const errors = (await result.locator('p').allTextContents())
        .slice(1)
        .map((text) => numbers(text)[0]);
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
    withExample('power', async (result) => {
      assert.equal(await note(result), '14 circles, 14 cells, 0 hidden');
      const canvas = result.locator('canvas');
      const before = await canvas.screenshot();
      await canvas.dragTo(canvas, {
        sourcePosition: { x: 80, y: 120 },
        targetPosition: { x: 200, y: 200 },
      });
      await canvas.focus();
      for (let i = 0; i < 30; i++) await page.keyboard.press('+');
      await says(result, /, [1-9]\d* hidden/);
      assert.notDeepEqual(await canvas.screenshot(), before);
    }));

  test('dots share the ink of a picture', () =>
    withExample('stippling', async (result) => {
      const [dots, round, off] = numbers(await note(result));
      assert.deepEqual([dots, round], [3000, 10]);
      assert.ok(off <= 0.1, `${off} %`);
      await expectDrawn(result, 0.05, 0.6);
    }));

  test('a block breaks into shards that fill it', () =>
    withExample('fracture', async (result) => {
      assert.equal(await note(result), '60 shards, whose volumes add up to 1.000000');
      const together = await seen(result.locator('canvas'));
      await result.getByRole('slider').fill('2');
      await expectDrawn(result, together.share + 0.05, 0.9);
    }));

  test('points move', () =>
    withExample('moving', async (result) => {
      await says(result, /^400 points, 7\d\d triangles, ([2-9]|\d\d+) updates$/);
      await expectDrawn(result, 0.05, 0.9, 3);
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
      await withExample(name, async (result) => {
        assert.ok(numbers(await note(result))[0] > 500, await note(result));
        await expectDrawn(result, 0.3, 0.95);
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
    await visit('node/');
    assert.equal(await page.locator('.output').textContent(), stdout);
  });
});

/** Answers what a copied page asks of the web, and of the folder it is in. */
async function answer(context, html, files) {
  const { dependencies, devDependencies } = JSON.parse(
    readFileSync(new URL('../package.json', import.meta.url)),
  );
  const versions = { ...dependencies, ...devDependencies };
  const addressOf = (name) => packages[name].cdn.replace(/\{([^}]+)\}/g, (_, of) => versions[of]);
  const bundles = new Map();
  for (const [name, { vendor }] of Object.entries(packages)) {
    // Names of one bundle are one module there, too.
    const first = Object.keys(packages).find((other) => packages[other].vendor === vendor);
    const bundle = () =>
      readFileSync(new URL(`../vendor/vendor.${vendor}.js`, import.meta.url), 'utf8');
    bundles.set(
      addressOf(name),
      first === name ? bundle : () => `export * from '${addressOf(first)}';`,
    );
  }
  const headers = { 'access-control-allow-origin': '*' };
  const text = (route, contentType, body) => route.fulfill({ contentType, body, headers });
  await context.route(/^https:\/\/(cdn\.jsdelivr\.net|esm\.sh)\//, (route) => {
    const url = route.request().url();
    const [, own] = /\/npm\/gdel-wasm@[^/]+\/dist\/(.*)/.exec(url) ?? [];
    if (own) {
      const type = own.endsWith('.wasm') ? 'application/wasm' : 'text/javascript';
      return text(route, type, readFileSync(new URL(`../../web/dist/${own}`, import.meta.url)));
    }
    if (url.endsWith('.css')) return text(route, 'text/css', '.leaflet-pane { z-index: 400; }');
    return text(route, 'text/javascript', bundles.get(url)());
  });
  await context.route('http://copy.test/**', (route) => {
    const name = new URL(route.request().url()).pathname.slice(1);
    if (name === '') return text(route, 'text/html', html);
    if (!files.includes(name)) return route.fulfill({ status: 204 });
    return route.fulfill({ body: readFileSync(new URL(`data/${name}`, programs)) });
  });
}

describe('copies of examples run on a page of their own', () => {
  const shown = {
    terrain: /breaklines/,
    contours: /^108 stations/,
    treemap: /^70 countries/,
    react: /^24 points/,
    svelte: /^24 points/,
    worker: /^500 meshes/,
    deck: /^8987 points/,
  };
  for (const [name, pattern] of Object.entries(shown))
    test(name, async () => {
      const { files } = catalogue.find((example) => example.name === name);
      await visit(`${name}/`);
      const html = await copied(page, '#copy-page');
      const links = await page
        .locator('.files a')
        .evaluateAll((all) => all.map(({ href }) => href));
      for (const [i, file] of files.entries()) {
        const address = new RegExp(`<!-- ${file}: (\\S+) -->`).exec(html)[1];
        assert.equal(address, links[i]);
        assert.equal(await (await fetch(address)).text(), read(`data/${file}`));
      }
      const copy = await newPage();
      await answer(copy.context(), html, files);
      await copy.goto('http://copy.test/');
      await copy.locator('p', { hasText: pattern }).waitFor();
      // What goes elsewhere is answered here.
      assert.deepEqual(
        copy.problems.filter((problem) => !/^https?:/.test(problem)),
        [],
      );
      await copy.context().close();
    });
});

/** A link to an example with other code. */
const linkTo = (name, code) => `${name}/#code=${deflateRawSync(code).toString('base64url')}`;

const problem = () => page.locator('#problem').textContent();
describe('what a visitor changes', () => {
  test('an error names its line, and a link keeps the change until it is taken back', async () => {
    await open('polygon/');
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+End');
    await page.keyboard.type('noSuchFunction();');
    await page.keyboard.press('Control+Enter');
    await state('failed');
    const lines = read('polygon.js').split('\n').length;
    assert.equal(await problem(), `Line ${lines}: ReferenceError: noSuchFunction is not defined`);
    assert.equal(await page.locator('.cm-line.wrong').textContent(), 'noSuchFunction();');
    const link = await copied(page, '#copy-link');
    assert.match(link, /examples\/polygon\/#code=[\w-]+$/);

    await page.goto('about:blank');
    await page.goto(link);
    await state('failed');
    assert.match(await problem(), /noSuchFunction/);
    await page.click('#reset');
    await state('done');
    assert.equal(await page.evaluate(() => location.hash), '');
    assert.equal(await page.locator('#problem').isVisible(), false);
    assert.equal(await page.locator('#reset').isDisabled(), true);
  });

  for (const [what, text, expected] of [
    ['that is no JavaScript', 'const a = 1;\nconst = 2;', /^Line 2: SyntaxError/],
    [
      'that throws later',
      '\n\nsetTimeout(() => { throw new Error("late"); });',
      /^Line 3: Error: late$/,
    ],
    ['that rejects', '\nPromise.reject(new TypeError("no"));', /^Line 2: TypeError: no$/],
    ['with an unknown import', 'import "no-such-library";', /no-such-library/],
    [
      'that the package refuses',
      'import { delaunay2d } from "gdel-wasm";\nawait delaunay2d([0, NaN]);',
      /^GdelError: .*NaN/,
    ],
  ])
    test(`code ${what}`, async () => {
      await visit(linkTo('polygon', text));
      await page.locator('#problem', { hasText: expected }).waitFor();
    });

  test('what code logs is shown, and nothing of the site is within its reach', async () => {
    const text = `console.log('it is', { a: 1 });
      for (const reach of [() => localStorage, () => parent.document, () => document.cookie])
        try { reach(); console.log('reached'); } catch (error) { console.log(error.name); }`;
    await visit(linkTo('polygon', text));
    await state('done');
    const output = await page.locator('#output').textContent();
    assert.equal(output, 'it is {"a":1}\nSecurityError\nSecurityError\nSecurityError\n');
  });

  test('Tab leaves the editor', async () => {
    await open('polygon/');
    await page.locator('.cm-content').focus();
    await page.keyboard.press('Tab');
    assert.equal(await page.evaluate(() => document.activeElement.closest('.cm-editor')), null);
  });

  test('an example that needs WebGPU says so where there is none', async () => {
    // As in browsers without it.
    const hidden = `Object.defineProperty(navigator, 'gpu', { value: undefined });\n`;
    for (const name of ['resident', 'webgpu']) {
      const code = read(`${name}.js`).replace(/^const adapter/m, `${hidden}const adapter`);
      const result = await open(linkTo(name, code));
      assert.match(await result.locator('body').textContent(), /^This browser offers no WebGPU/);
    }
  });
});

test('frames run in Firefox, too', async () => {
  const firefox = await launchFirefox();
  try {
    const page = await firefox.newPage();
    for (const name of ['worker', 'svelte']) {
      await visit(`${name}/`, page);
      await page.locator('main[data-state="done"]').waitFor();
    }
  } finally {
    await firefox.close();
  }
});

test('an example is a file of at most 60 lines', () => {
  for (const { name, output } of catalogue) {
    const lines = read(`${name}.${output ? 'mjs' : 'js'}`)
      .trimEnd()
      .split('\n').length;
    assert.ok(lines <= 60, `${name}: ${lines} lines`);
  }
});

test('the index shows all examples, or those about a subject', async () => {
  let bytes = 0;
  const index = await newPage();
  index.on('response', async (response) => {
    bytes += (await response.body().catch(() => '')).length;
  });
  await visit('', index);
  const pictures = index.locator('.pictures img');
  assert.equal(await pictures.count(), catalogue.length);
  for (const picture of await pictures.all()) await picture.scrollIntoViewIfNeeded();
  await index.waitForFunction(() =>
    [...document.images].every((image) => image.naturalWidth === 480),
  );
  assert.ok(bytes < 500_000, `${bytes} bytes`);
  await index.getByRole('button', { name: 'Maps' }).click();
  const maps = catalogue.filter(({ subject }) => subject === 'Maps').length;
  assert.equal(await index.locator('.pictures li:visible').count(), maps);
  assert.deepEqual(index.problems, []);
  await index.context().close();
});

for (const colorScheme of ['light', 'dark'])
  test(`index and examples are accessible, and fit a phone: ${colorScheme}`, async () => {
    const phone = await newPage({
      colorScheme,
      viewport: { width: 390, height: 844 },
      isMobile: true,
      hasTouch: true,
    });
    await visit('', phone);
    await expectAccessible(phone, 'index');
    await expectFit(phone);
    await pictureOf(phone, `examples-${colorScheme}`);
    await open('clusters/', phone);
    await expectAccessible(phone, 'clusters');
    await expectFit(phone);
    await pictureOf(phone, `example-${colorScheme}`);
    assert.deepEqual(phone.problems, []);
    await phone.context().close();
  });

async function expectFit(page) {
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(width <= 390, `${width} pixels wide`);
}

function areaOf(ring) {
  let twice = 0;
  for (let i = 1; i < ring.length; i++)
    twice += ring[i - 1][0] * ring[i][1] - ring[i][0] * ring[i - 1][1];
  return Math.abs(twice) / 2;
}
