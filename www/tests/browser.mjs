// What all tests of the page need: the built page behind a static server, and Chromium with or
// without WebGPU.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import AxeBuilder from '@axe-core/playwright';
import { preview } from 'vite';
import { launchChromium, WEBGPU_DRAWING } from '../../tests/web/browsers.mjs';
import { open, settled, shown, tab, text, until } from './driving.mjs';

export * from './driving.mjs';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

export const SCREENSHOTS = here('./screenshots/');
mkdirSync(SCREENSHOTS, { recursive: true });

/** Serves www/dist. Resolves to its address and how to end it. */
export async function serve() {
  const server = await preview({
    root: here('..'),
    // As GitHub Pages does: frames in a sandbox have no origin of their own.
    preview: { port: 0, host: '127.0.0.1', cors: { origin: '*' } },
    logLevel: 'error',
  });
  return {
    url: server.resolvedUrls.local[0].replace('localhost', '127.0.0.1'),
    close: () => server.close(),
  };
}

export function launch({ webgpu = true } = {}) {
  return launchChromium(webgpu ? WEBGPU_DRAWING : ['--enable-unsafe-swiftshader']);
}

/** The share of the drawing's pixels in which red (0), green (1) or blue (2) is by far the most. */
export async function shareOfPixels(page, channel) {
  const picture = (await page.locator('#canvas').screenshot()).toString('base64');
  return page.evaluate(
    async ([picture, channel]) => {
      const bytes = Uint8Array.from(atob(picture), (character) => character.charCodeAt(0));
      const image = await createImageBitmap(new Blob([bytes]));
      const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
      context.drawImage(image, 0, 0);
      const { data } = context.getImageData(0, 0, image.width, image.height);
      let found = 0;
      for (let at = 0; at < data.length; at += 4) {
        const others = [0, 1, 2].filter((other) => other !== channel);
        if (others.every((other) => data[at + channel] > 2 * data[at + other])) found++;
      }
      return (4 * found) / data.length;
    },
    [picture, channel],
  );
}

/** Chooses what the simplices are coloured by. */
export async function colorBy(page, color) {
  await tab(page, 'view');
  await page.selectOption('#color', color);
  await settled(page);
}

/** The address of the page, of which Playwright learns only later. */
export const hrefOf = (page) => page.evaluate(() => location.href);

/** The address of the page once it says what the page shows. */
export async function addressOf(page) {
  // The page writes it with a delay: sharing writes it once the file is packed.
  await page.click('#share');
  await settled(page);
  return hrefOf(page);
}

/** Expects that the page shows the alpha shape of a mesh, uncut, for the radius that suits. */
export async function expectAlphaShape(page, mesh) {
  const { alpha, solid } = await mesh.alphaShape({ alpha: 'auto' });
  assert.equal(await text(page, 'alpha-value'), `α = ${Number(alpha.toPrecision(3))}`);
  assert.equal((await shown(page)).shown, solid.length);
  assert.equal(await page.getAttribute('#alpha-auto', 'aria-pressed'), 'true');
}

/** Clicks on a button that copies something, and returns that. */
export async function copied(page, button) {
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.evaluate(() => navigator.clipboard.writeText(''));
  await page.click(button);
  await until(page, async () => (await navigator.clipboard.readText()) !== '');
  return page.evaluate(() => navigator.clipboard.readText());
}

/**
 * Runs the points on both backends and the other library and returns what the page says of them.
 */
export async function compare(page) {
  await tab(page, 'compare');
  await page.click('#compare-run');
  await until(
    page,
    () => document.querySelector('#compare-run').textContent === 'Run the comparison',
  );
  return text(page, 'times-note');
}

/** Has the mesh verified. Resolves to how many checks passed and failed. */
export async function prove(page) {
  await tab(page, 'compare');
  await page.click('#verify-run');
  await page.locator('#verify-run:enabled').waitFor();
  const [passed, failed] = await Promise.all(
    ['pass', 'fail'].map((verdict) => page.locator(`#verdicts .${verdict}`).count()),
  );
  return { note: await text(page, 'verify-note'), passed, failed };
}

/** Downloads the mesh in one format into a folder. Resolves to the paths of its files. */
export async function save(page, format, folder, files = 1) {
  const downloads = [];
  // Where the page says something else instead, this ends with an error after the time that the page may take.
  const all = page.waitForEvent('download', {
    predicate: (download) => downloads.push(download) === files,
  });
  await Promise.all([all, page.getByRole('button', { name: format, exact: true }).click()]);
  const paths = downloads.map((download) => join(folder, download.suggestedFilename()));
  await Promise.all(downloads.map((download, i) => download.saveAs(paths[i])));
  return paths;
}

/** Runs the command line, as scripts/test.sh has built it, and fails when it does. */
export function gdel(...args) {
  const [command, ...first] = process.env.GDEL
    ? [process.env.GDEL]
    : ['cargo', 'run', '--quiet', '--locked', '-p', 'gdel-cli', '--'];
  execFileSync(command, [...first, ...args], {
    cwd: here('../..'),
    stdio: ['ignore', 'pipe', 'inherit'],
  });
}

/** Saves a picture of the page, with its transitions ended. */
export async function pictureOf(page, name) {
  return page.screenshot({ path: `${SCREENSHOTS}${name}.png`, animations: 'disabled' });
}

/** Expects no accessibility faults in what the page shows. */
export async function expectAccessible(page, what, axe = new AxeBuilder({ page })) {
  const { violations } = await axe.analyze();
  assert.deepEqual(
    violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(' ')}`),
    [],
    what,
  );
}

/** Expects no accessibility faults in any panel, and saves a picture of each. */
export async function expectAccessiblePanels(page, pictures) {
  for (const name of ['points', 'view', 'run', 'compare', 'use']) {
    await tab(page, name);
    await pictureOf(page, `${pictures}-${name}`);
    await expectAccessible(page, name);
  }
}

/** Opens the page on a phone, on which it must not be wider than the screen. */
export async function openOnPhone(browser, url, options = {}) {
  const viewport = { width: 390, height: 844 };
  const phone = { viewport, isMobile: true, hasTouch: true, deviceScaleFactor: 1 };
  const page = await open(browser, url, { ...phone, ...options });
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(width <= page.viewportSize().width, `${width} pixels wide`);
  return page;
}
