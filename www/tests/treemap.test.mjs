// The page that draws treemaps.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import {
  copied,
  drop,
  expectAccessible,
  hrefOf,
  pictureOf,
  settled,
  text,
  until,
} from './browser.mjs';
import { site } from './site.mjs';

const here = site({ webgpu: false });
const folder = mkdtempSync(join(tmpdir(), 'gdel-treemap-'));
after(() => rmSync(folder, { recursive: true, force: true, maxRetries: 5 }));

/** Opens the page. It must not write anything to the console. */
async function openTreemap(hash = '', options = {}) {
  const context = await here.browser.newContext({
    viewport: { width: 1280, height: 860 },
    colorScheme: 'light',
    reducedMotion: 'reduce',
    serviceWorkers: 'block',
    ...options,
  });
  const page = await context.newPage();
  page.setDefaultTimeout(300_000);
  page.problems = [];
  page.on('pageerror', (error) => page.problems.push(error.stack ?? error.message));
  page.on('console', (message) => page.problems.push(message.text()));
  await page.goto(`${here.url}treemap/${hash}`);
  await settled(page);
  return page;
}

const close = async (page) => {
  assert.deepEqual(page.problems, []);
  await page.context().close();
};

/** The area of a path of straight lines. */
const areaOf = (path) => {
  const corners = path
    .replace(/[MZ]/g, '')
    .split('L')
    .map((corner) => corner.split(' ').map(Number));
  return Math.abs(
    corners.reduce((sum, [x, y], i) => {
      const [x1, y1] = corners[(i + 1) % corners.length];
      return sum + (y * x1 - x * y1) / 2;
    }, 0),
  );
};

/** The areas of the cells on the page. */
const areasOn = async (page) =>
  (
    await page
      .locator('path[data-cell]')
      .evaluateAll((all) => all.map((path) => path.getAttribute('d')))
  ).map(areaOf);

const downloaded = async (page, button) => {
  const [download] = await Promise.all([page.waitForEvent('download'), page.click(button)]);
  const path = join(folder, download.suggestedFilename());
  await download.saveAs(path);
  return { name: download.suggestedFilename(), content: readFileSync(path, 'utf8') };
};

test('an example is drawn with exact areas and names, light and dark, and is accessible', async () => {
  for (const colorScheme of ['light', 'dark']) {
    const page = await openTreemap('', { colorScheme });
    const areas = await areasOn(page);
    assert.equal(areas.length, 70);
    assert.ok(Math.abs(areas.reduce((sum, area) => sum + area) - 1e6) < 1e3);
    // Of the sum, 7124 million.
    assert.match(
      await text(page, 'result'),
      /^70 cells in .*: no area is off by more than 0\.\d+%\.$/,
    );
    const label = await page.locator('#picture svg').getAttribute('aria-label');
    assert.match(label, /Treemap of 70 cells.*Asia › India: 1,451/);
    assert.ok((await page.locator('#picture text').count()) > 40);
    await pictureOf(page, `treemap-${colorScheme}`);
    await expectAccessible(page, colorScheme);
    await page.hover('path[data-cell="0"]');
    assert.match(await text(page, 'tip'), /^Asia › India: 1,451 \(19\.7%\)$/);
    await close(page);
  }
});

test('a table that is dropped: areas, rows without a cell, columns, and files to save', async () => {
  const page = await openTreemap();
  const table = 'City,State,Area,People\nA,x,10,1\nB,x,20,3\nC & "D",y,0,5\nE,y,30,=7\n'.replace(
    '=7',
    '7',
  );
  await drop(page, 'cities.csv', table);
  assert.match(await text(page, 'notes'), /No cell for 1 row with the number 0: C & "D"\./);
  const areas = await areasOn(page);
  [10, 20, 30].forEach((value, i) => {
    assert.ok(Math.abs(areas[i] / 1e6 / (value / 60) - 1) < 2e-3, `${areas}`);
  });

  await page.selectOption('#column-value', { label: 'People' });
  await settled(page);
  await page.selectOption('#column-group', { label: 'State' });
  await settled(page);
  assert.ok(await page.locator('#notes').isHidden());
  const grouped = await areasOn(page);
  assert.equal(grouped.length, 4);
  assert.ok(Math.abs((grouped[0] + grouped[1]) / 1e6 - 4 / 16) < 1e-3);
  await page.click('#figures summary');
  assert.equal(await page.locator('#rows tr').count(), 4);
  assert.match(await page.locator('#rows tr').nth(2).textContent(), /^y › C & "D"531\.3%/);

  const svg = await downloaded(page, '#save-svg');
  assert.equal(svg.name, 'cities.svg');
  const parsed = await page.evaluate((content) => {
    const svg = new DOMParser().parseFromString(content, 'image/svg+xml').documentElement;
    return {
      root: svg.localName,
      role: svg.getAttribute('role'),
      title: svg.querySelector('title').textContent,
      text: svg.querySelector('desc').textContent,
      cells: [...svg.querySelectorAll('path > title')].map((title) => title.textContent),
    };
  }, svg.content);
  assert.deepEqual([parsed.root, parsed.role, parsed.title], ['svg', 'img', 'cities']);
  assert.match(parsed.text, /Treemap of 4 cells/);
  assert.deepEqual(parsed.cells[2], 'y › C & "D": 5 (31.3%)');
  const csv = await downloaded(page, '#save-csv');
  assert.match(
    csv.content,
    /^group,name,number,share,share of the area,site x,site y\nx,A,1,0\.0625,0\.06/,
  );
  assert.match(csv.content, /\ny,"C & ""D""",5,/);

  // A link holds the table.
  assert.equal(await copied(page, '#share'), await hrefOf(page));
  const other = await openTreemap(new URL(await hrefOf(page)).hash);
  assert.deepEqual(await areasOn(other), grouped);
  assert.equal(await other.locator('#source').inputValue(), '');
  await close(other);
  await close(page);
});

test('what is wrong with a table is said, and the next one is drawn', async () => {
  const page = await openTreemap();
  for (const [table, message] of [
    ['a,1\nb,-2\nc,3', /Line 2 \(b\): -2 is negative/],
    ['a,1\nb,x\nc,2', /Line 2 \(b\): “x” .*is not a number/],
    ['a,0\nb,0', /are 0/],
    ['a,b\nc,d', /No column has numbers/],
    ['', /no rows/],
  ]) {
    await drop(page, 'table.csv', table);
    assert.match(await text(page, 'message'), message);
    assert.equal(await page.locator('#picture svg').count(), 0);
    assert.ok(await page.locator('#save-svg').isDisabled());
  }
  await page.click('details:not(#figures) summary');
  await page.fill('#text', 'a,1\nb,3');
  await page.click('#draw');
  await until(page, () => document.querySelectorAll('path[data-cell]').length === 2);
  assert.ok(await page.locator('#message').isHidden());
  await close(page);
});

test('the page is busy as soon as a table is dropped, and the last one of several is drawn', async () => {
  const page = await openTreemap();
  const busy = await page.evaluate(() => {
    const stage = document.getElementById('stage');
    const rows = Array.from({ length: 20_000 }, (_, i) => `row ${i},1`).join('\n');
    return [`name,number\n${rows}`, 'a,1\nb,3'].map((table, i) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([table], `${i}.csv`));
      stage.dispatchEvent(new DragEvent('drop', { dataTransfer, bubbles: true, cancelable: true }));
      return stage.getAttribute('aria-busy');
    });
  });
  assert.deepEqual(busy, ['true', 'true']);
  await settled(page);
  assert.equal((await areasOn(page)).length, 2);
  await close(page);
});

test('shapes: each keeps its areas, and the address says which it is', async () => {
  const page = await openTreemap('#example=body');
  for (const shape of ['circle', 'hexagon', 'rectangle']) {
    await page.locator(`input[name=shape][value=${shape}]`).evaluate((radio) => radio.click());
    await settled(page);
    const areas = await areasOn(page);
    assert.equal(areas.length, 11);
    assert.ok(Math.abs(areas[0] / 1e6 - 65 / 99.9) < 1e-3, `${areas[0]}`);
    const { hash } = new URL(await hrefOf(page));
    assert.equal(hash, shape === 'rectangle' ? '#example=body' : `#example=body&shape=${shape}`);
    await pictureOf(page, `treemap-${shape}`);
  }
  await close(page);
});

test('cells move from equal areas to exact ones, by themselves or by the slider', async () => {
  const page = await openTreemap('#example=body', { reducedMotion: 'no-preference' });
  const set = async (value) => {
    await page.locator('#way').evaluate((slider, value) => {
      slider.value = String(value);
      slider.dispatchEvent(new Event('input', { bubbles: true }));
    }, value);
  };
  const areas = () =>
    page.locator('path[data-top]').evaluateAll((all) => all.map((path) => path.getAttribute('d')));
  await set(0);
  await until(page, () => document.querySelectorAll('path[data-top][d]').length === 11);
  const equal = (await areas()).map(areaOf);
  for (const area of equal) assert.ok(Math.abs(area / 1e6 - 1 / 11) < 1e-3, `${equal}`);
  const [before] = await areas();
  await set(0.5);
  await until(
    page,
    (before) => document.querySelector('path[data-top]').getAttribute('d') !== before,
    before,
  );
  const half = (await areas()).map(areaOf);
  assert.ok(half[0] > equal[0] && half[10] < equal[10]);
  await page.click('#play');
  await until(page, () => document.querySelectorAll('path[data-cell]').length === 11);
  assert.equal(await page.inputValue('#way'), '1');
  await close(page);
});

test('3,000 cells, by the keyboard', async () => {
  const page = await openTreemap('#example=many');
  assert.equal((await areasOn(page)).length, 3000);
  const { error } = await page.locator('#stage').evaluate(({ dataset }) => ({ ...dataset }));
  assert.ok(Number(error) <= 1e-3);
  await pictureOf(page, 'treemap-many');
  await page.focus('#source');
  await page.keyboard.press('ArrowUp');
  await until(page, () => document.querySelectorAll('path[data-cell]').length === 11);
  await close(page);
});

test('the page for points in the plane leads here', async () => {
  const context = await here.browser.newContext({ serviceWorkers: 'block' });
  const page = await context.newPage();
  await page.goto(`${here.url}#dim=2`);
  await page.click('a[href="./treemap/"]');
  await settled(page);
  assert.equal((await areasOn(page)).length, 70);
  await context.close();
});

test('on a phone nothing is wider than the screen', async () => {
  const page = await openTreemap('', {
    viewport: { width: 390, height: 844 },
    isMobile: true,
    hasTouch: true,
    deviceScaleFactor: 2,
  });
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(width <= 390, `${width} pixels wide`);
  await page.tap('path[data-cell="0"]');
  await pictureOf(page, 'treemap-phone');
  await expectAccessible(page, 'a phone');
  await close(page);
});
