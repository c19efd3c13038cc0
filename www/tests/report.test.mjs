// The page that tests the GPU of a visitor, with few points, since the GPU here is software.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { faultsOf, parse, rowOf } from '../../scripts/devices.mjs';
import { copied, expectAccessible, hrefOf, pictureOf, text, until } from './browser.mjs';
import { site } from './site.mjs';

/** Opens the report page. */
async function openReport(here, address, options = {}) {
  const context = await here.browser.newContext({
    viewport: { width: 1000, height: 900 },
    colorScheme: 'light',
    serviceWorkers: 'block',
    ...options,
  });
  const page = await context.newPage();
  page.setDefaultTimeout(600_000);
  page.problems = [];
  page.on('pageerror', (error) => page.problems.push(error.stack ?? error.message));
  await page.goto(`${here.url}report/${address}`);
  return page;
}

/** Runs the test, and returns the report. */
async function run(page) {
  await page.click('#run');
  await until(page, () => document.querySelector('#block').textContent.includes('\nresult: '));
  return text(page, 'block');
}

const TESTS = ['self-test 3D', 'self-test 2D', '3D 60', '3D 300', '2D 60', '2D 300'];

test('the table of devices has a form, which is checked', () => {
  const document = readFileSync(new URL('../../DEVICES.md', import.meta.url), 'utf8');
  assert.deepEqual(faultsOf(document), []);
  const broken = (from, to) => faultsOf(document.replace(from, to)).join();
  assert.match(broken('| right |', '| fine |'), /^result is fine/);
  assert.match(broken('| webgpu, ', '| opengl, '), /^driver is opengl/);
  assert.match(broken(/\d+ threads/, 'many'), /^system is/);
  assert.match(broken(/\| [\d.]+ \/ \d+ \|/, '| soon |'), /^3D 10⁴ is soon/);
  assert.match(broken(/ours, [\d-]+/, 'mine'), /^report is mine/);
  assert.match(broken('| google', '| zoo'), /^not in alphabetical order/);
  assert.match(broken('| device | driver |', '| device | system |'), /^the columns are not/);
});

describe('without WebGPU', () => {
  const here = site({ webgpu: false });

  test('the CPU alone is measured; the address has the report', async () => {
    const page = await openReport(here, '?points=1000,3000');
    await expectAccessible(page, 'before the test');
    const block = await run(page);
    const said = parse(block);
    assert.equal(said.device, 'none');
    assert.equal(said.result, 'incomplete');
    assert.match(said.driver, /^webgpu, Chromium \d+$/);
    assert.match(said.system, /^linux, \d+ threads$/);
    for (const dimension of ['3D', '2D']) {
      assert.match(said[`self-test ${dimension}`], /^none, WebGPU/);
      assert.match(said[`${dimension} 1000`], /^CPU [\d.]+ ms, GPU none$/);
      assert.match(said[`${dimension} 3000`], /^CPU [\d.]+ ms, GPU none$/);
    }
    assert.match(await text(page, 'state'), /not everything could be compared/);
    await pictureOf(page, 'report');
    await expectAccessible(page, 'after the test');
    assert.equal(await copied(page, '#copy'), block);
    const issue = new URL(await page.getAttribute('#issue', 'href'));
    assert.match(issue.pathname, /\/issues\/new$/);
    assert.ok(issue.searchParams.get('body').includes(block));

    const address = new URL(await hrefOf(page));
    const other = await openReport(here, address.hash, {
      colorScheme: 'dark',
      viewport: { width: 390, height: 844 },
    });
    assert.equal(await text(other, 'block'), block);
    assert.match(await text(other, 'state'), /from the address/);
    const width = await other.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(width <= 390, `${width} pixels wide`);
    await pictureOf(other, 'report-phone-dark');
    await expectAccessible(other, 'a report from an address');
    assert.deepEqual([...page.problems, ...other.problems], []);
    await Promise.all([page, other].map((page) => page.context().close()));
  });

  test('a test can be stopped, and begun anew', async () => {
    const page = await openReport(here, '?points=1000,200000');
    await page.click('#run');
    await until(page, () => document.querySelector('#block').textContent.includes('3D 1000: '));
    await page.click('#stop');
    await until(page, () => document.querySelector('#state').textContent === 'Stopped.');
    const block = await text(page, 'block');
    assert.equal(parse(block).result, 'incomplete');
    assert.ok(!block.includes('2D 200000'));
    assert.ok(await page.locator('#run').isVisible());
    assert.ok(await page.locator('#stop').isHidden());
    await page.context().close();
  });
});

describe('with WebGPU', () => {
  const here = site();

  test('both backends make the same meshes', { timeout: 900_000 }, async () => {
    const page = await openReport(here, '?points=60,300');
    const block = await run(page);
    const said = parse(block);
    assert.match(said.device, /SwiftShader.*\(software\)$/i);
    assert.equal(said.result, 'right', block);
    assert.deepEqual(Object.keys(said).slice(4, -1), TESTS);
    for (const name of TESTS.slice(0, 2))
      assert.match(said[name], /^passed in \d+ ms \(few .* ms\)$/);
    for (const name of TESTS.slice(2)) assert.match(said[name], /^CPU .* ms, GPU .* ms, same$/);
    assert.match(await text(page, 'state'), /Everything is right/);
    assert.match(rowOf(block), /^\| .*SwiftShader.* \| right \|/i);
    await pictureOf(page, 'report-gpu');
    assert.deepEqual(page.problems, []);
    await page.context().close();
  });
});
