// The pages around the demo: links, accessibility, search, programs of the guides, and what they weigh.

import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { dirname, join, relative } from 'node:path';
import { describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import AxeBuilder from '@axe-core/playwright';
import ts from 'typescript';
import { serve as serveFiles } from '../../tests/web/server.mjs';
import { expectAccessible, pictureOf, until } from './browser.mjs';
import { site } from './site.mjs';
import { openPlace, programsOf } from './snippets.mjs';

const www = fileURLToPath(new URL('../', import.meta.url));
const dist = join(www, 'dist');
const web = join(www, '../web');
const read = (path) => readFileSync(path, 'utf8');

const pages = readdirSync(dist, { recursive: true })
  .filter((path) => path.endsWith('index.html'))
  .map((path) => path.slice(0, -'index.html'.length));
const guides = readdirSync(join(www, 'site/guide')).filter((name) => name.endsWith('.md'));

/** A page of each kind, with the words for its picture. */
const KINDS = {
  guides: 'guide/',
  guide: 'guide/answers/',
  exactness: 'guide/exactness/',
  examples: 'examples/',
  api: 'api/',
  class: 'api/gdel-wasm/classes/SpanningTree/',
  benchmarks: 'benchmarks/',
};
/** Pages with long words, code or tables. */
const LONG = {
  errors: 'guide/errors/',
  switching: 'guide/switching/',
  entry: 'api/gdel-wasm/',
  mesh: 'api/gdel-wasm/classes/Mesh3/',
};
/** What newcomers ask for, and the part of a guide that has a program for it to copy. */
const TASKS = {
  'Interpolate my weather stations on a map.': 'What is the value between weather stations?',
  'Make a collider for this scan.': 'What is the collider for a scan?',
  'Triangulate a polygon with holes.': 'What are the triangles of a polygon with holes?',
  'Clip Voronoi cells to a rectangle, from CSV.':
    'What are the Voronoi cells in a rectangle, from CSV?',
  'Find the nearest city to a click.': 'Which city is nearest to a click?',
};
/** In lines, for such a program. */
const SHORT = 15;
/** In bytes, gzipped, for the first view of a page. */
const BUDGET = 500e3;

/** Opens a browser's page that collects what it says to the console and what it loads. */
async function openSite(here, options = {}) {
  const context = await here.browser.newContext({
    viewport: { width: 1440, height: 900 },
    colorScheme: 'light',
    serviceWorkers: 'block',
    ...options,
  });
  const page = await context.newPage();
  page.setDefaultTimeout(300_000);
  page.problems = [];
  page.requests = new Set();
  page.on('pageerror', (error) => page.problems.push(error.stack ?? error.message));
  page.on('console', (message) => page.problems.push(message.text()));
  page.on('request', (request) => page.requests.add(request.url()));
  return page;
}

/** Goes to a page of the site, and waits until its pictures are there. */
async function visit(page, url) {
  page.requests.clear();
  await page.goto(url);
  if (url.includes('exactness'))
    await until(page, () => document.querySelector('#wrong').textContent !== '');
}

/** What Playwright says itself where it blocks service workers. */
const BLOCKED = 'Service Worker registration blocked by Playwright';

test('all links lead somewhere', () => {
  const idsOf = new Map();
  const ids = (file) => {
    if (!idsOf.has(file))
      idsOf.set(
        file,
        new Set([...read(file).matchAll(/ (?:id|name)="([^"]+)"/g)].map(([, id]) => id)),
      );
    return idsOf.get(file);
  };
  const broken = [];
  let links = 0;
  for (const path of pages) {
    const file = join(dist, path, 'index.html');
    for (const [, , given] of read(file).matchAll(
      /<(a|link|script|img)\b[^>]*?\s(?:href|src)="([^"]*)"/g,
    )) {
      const address = given.replaceAll('&amp;', '&');
      links++;
      const inRepository = /^https:.*?\/blob\/main\/([^#]*)/.exec(address)?.[1];
      if (inRepository && !existsSync(join(www, '..', inRepository)))
        broken.push(`${path}: ${address}`);
      if (/^[a-z]+:/.test(address)) {
        if (!/^(https:\/\/[\w.-]+\/|data:)/.test(address)) broken.push(`${path}: ${address}`);
        continue;
      }
      const [before, fragment] = address.split('#');
      let target = before === '' ? file : join(dirname(file), before.split('?')[0]);
      if (before.endsWith('/') || before === '.' || before === '..')
        target = join(target, 'index.html');
      const isThere = existsSync(target) && !relative(dist, target).startsWith('..');
      const hasPlace = !fragment || fragment.includes('=') || !target.endsWith('.html');
      if (!isThere || !(hasPlace || ids(target).has(decodeURIComponent(fragment))))
        broken.push(`${path}: ${address}`);
    }
  }
  console.log(`${pages.length} pages, ${links} links`);
  assert.deepEqual(broken, []);
});

test('every export of the package has a page', () => {
  const { exports } = JSON.parse(read(join(web, 'package.json')));
  const entries = Object.entries(exports).filter(
    ([name, { types, import: { types: found } = {} }]) => (types ?? found) && name !== './inline',
  );
  const files = entries.map(([, entry]) => join(web, entry.import.types));
  const program = ts.createProgram(files, {
    noLib: true,
    types: [],
    moduleResolution: 100,
    module: 99,
  });
  const checker = program.getTypeChecker();
  const missing = entries.flatMap(([name], i) => {
    const module = checker.getSymbolAtLocation(program.getSourceFile(files[i]));
    const folder = join(dist, 'api', name.replace(/^\./, 'gdel-wasm'));
    const found = readdirSync(folder, { recursive: true }).map((path) => path.split('/').at(-2));
    // What one entry has of another one is named there.
    const index = read(join(folder, 'index.html'));
    return checker
      .getExportsOfModule(module)
      .map((symbol) => symbol.getName())
      .filter(
        (symbol) => symbol !== 'default' && !found.includes(symbol) && !index.includes(symbol),
      )
      .map((symbol) => `${name}: ${symbol}`);
  });
  assert.deepEqual(missing, []);
});

/** Returns how many bytes the files have, gzipped. None may be of another host. */
function weightOf(requests, url) {
  const files = [...requests].filter((request) => !/^(data|blob):/.test(request));
  assert.deepEqual(
    files.filter((file) => !file.startsWith(url)),
    [],
  );
  return files
    .map((file) => new URL(file).pathname.replace(/\/$/, '/index.html').slice(1))
    .map((file) => gzipSync(readFileSync(join(dist, file))).length)
    .reduce((a, b) => a + b);
}

test('the guide on errors has every code', () => {
  const source = read(join(web, 'src/errors.ts'));
  const type = /export type GdelErrorCode =(.*?)';/s.exec(source)[1];
  const codes = [...`${type}'`.matchAll(/'([A-Z_]+)'/g)].map(([, code]) => code);
  const headings = [...read(join(www, 'site/guide/errors.md')).matchAll(/^### ([A-Z_]+)$/gm)];
  assert.ok(codes.length > 10);
  assert.deepEqual(headings.map(([, code]) => code).sort(), codes.sort());
});

test('a short program does what newcomers ask for', () => {
  const parts = read(join(www, 'site/guide/answers.md')).split(/^## /m);
  for (const [task, heading] of Object.entries(TASKS)) {
    const [program] = programsOf(parts.find((part) => part.startsWith(`${heading}\n`)) ?? '');
    assert.ok(program, task);
    const lines = program.code.trimEnd().split('\n').length;
    assert.ok(lines <= SHORT, `${task} ${lines} lines`);
  }
});

describe('in a browser', () => {
  const here = site();

  test('the programs of the guides log what they say', async () => {
    const place = await openPlace(here.browser);
    for (const name of guides) {
      for (const { code, says } of programsOf(read(join(www, 'site/guide', name)))) {
        assert.ok(says.length > 0, `${name} has a program that says nothing:\n${code}`);
        assert.deepEqual(await place.run(code), says, `${name}:\n${code}`);
      }
    }
    await place.close();
  });

  test('pages are accessible in light and dark colours, quiet and light-weight', async () => {
    const page = await openSite(here, { reducedMotion: 'reduce' });
    for (const [name, path] of Object.entries(KINDS)) {
      await visit(page, here.url + path);
      const weight = weightOf(page.requests, here.url);
      console.log(`${(weight / 1e3).toFixed(0).padStart(5)} kB ${path}`);
      assert.ok(weight < BUDGET, `${path}: ${weight} bytes`);
      for (const theme of ['light', 'dark']) {
        await page.locator(`:root[data-theme=${theme}]`).waitFor();
        await pictureOf(page, `site-${name}-${theme}`);
        // Without frames, the old mode finds the same in half of the time.
        const axe = new AxeBuilder({ page }).setLegacyMode(true);
        await expectAccessible(page, `${path}, ${theme}`, axe);
        await page.click('#theme');
      }
    }
    assert.deepEqual(new Set(page.problems), new Set([BLOCKED]));
    await page.context().close();
  });

  test('on a phone no page is wider than the screen', async () => {
    const page = await openSite(here, {
      viewport: { width: 390, height: 844 },
      isMobile: true,
      hasTouch: true,
    });
    const wide = [];
    for (const [name, path] of Object.entries({ ...KINDS, ...LONG })) {
      await visit(page, here.url + path);
      const width = await page.evaluate(() => document.documentElement.scrollWidth);
      if (width > 390) wide.push(`${path}: ${width}`);
      await pictureOf(page, `site-${name}-phone`);
    }
    assert.deepEqual(wide, []);
    await page.context().close();
  });

  test('the picture of a tie moves, and its diagonal changes', async () => {
    const page = await openSite(here);
    await visit(page, `${here.url}guide/exactness/`);
    const said = () => page.locator('#said').textContent();
    const move = (value) =>
      page.locator('#way').evaluate((slider, value) => {
        slider.value = value;
        slider.dispatchEvent(new Event('input'));
      }, value);
    assert.match(await said(), /exactly on the circle.* cuts off point 0/);
    const tie = await said();
    await page.click('#renumber');
    assert.notEqual(await said(), tie);
    await move('0.1');
    assert.match(await said(), /outside.*Only the diagonal/);
    const outside = await said();
    await move('-0.1');
    assert.match(await said(), /inside.*Only the diagonal/);
    assert.notEqual((await said()).slice(-20), outside.slice(-20));
    assert.match(await page.locator('#wrong').textContent(), /Rounding gets [1-9]\d* of 4096 /);
    assert.deepEqual(page.problems, [BLOCKED]);
    await page.context().close();
  });

  test('the search finds, by keyboard and without a connection', async () => {
    const page = await openSite(here, { serviceWorkers: 'allow' });
    await visit(page, `${here.url}guide/first-steps/`);
    await page.evaluate(() => navigator.serviceWorker.ready);
    await page.context().setOffline(true);
    await page.goto(`${here.url}guide/memory/`);
    await page.keyboard.press('/');
    const find = async (words) => {
      await page.fill('#search', words);
      await until(page, (words) => document.querySelector('#found').dataset.words === words, words);
      return page.locator('#found a').allTextContents();
    };
    assert.match((await find('interpolateGrid'))[0], /interpolateGrid/);
    assert.match((await find('collider'))[0], /collider/);
    assert.match((await find('CROSSING_CONSTRAINTS')).join(), /When something fails/);
    assert.deepEqual(await find('xyzzyqqq'), []);
    await find('delaunator');
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('Enter');
    await page.waitForURL(/delaunator|switching/i);
    await page.goto(`${here.url}api/gdel-wasm/classes/Mesh3/`);
    assert.match(await page.title(), /^Mesh3/);
    await page.context().close();
  });

  test('the site works in a folder of a host', async () => {
    const server = await serveFiles({ '/some/folder/': dist });
    const page = await openSite(here);
    const failed = [];
    page.on('response', (response) => response.status() >= 400 && failed.push(response.url()));
    await visit(page, `${server.url}/some/folder/guide/exactness/index.html`);
    await page.fill('#search', 'delaunay3d');
    await page.locator('#found a').first().waitFor();
    const address = await page.locator('#found a').first().getAttribute('href');
    assert.ok(address.startsWith(`${server.url}/some/folder/api/gdel-wasm/`), address);
    assert.deepEqual(failed, []);
    await page.context().close();
    server.close();
  });
});
