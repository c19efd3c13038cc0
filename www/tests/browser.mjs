// What all tests of the page need: the built page behind a static server, and Chromium with or without WebGPU.

import { mkdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import { preview } from 'vite';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

export const SCREENSHOTS = here('./screenshots/');
mkdirSync(SCREENSHOTS, { recursive: true });

/** Serves www/dist. Resolves to its address and how to end it. */
export async function serve() {
  const server = await preview({ root: here('..'), preview: { port: 0, host: '127.0.0.1' }, logLevel: 'error' });
  return { url: server.resolvedUrls.local[0].replace('localhost', '127.0.0.1'), close: () => server.close() };
}

const FLAGS = ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'];

// SwiftShader, Chromium's software rasteriser. Without its Vulkan, headless Chromium cannot show what WebGPU draws.
const WEBGPU = [
  '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader', '--enable-features=Vulkan', '--use-vulkan=swiftshader',
  '--use-angle=vulkan',
];

export function launch({ webgpu = true } = {}) {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: [...FLAGS, ...(webgpu ? WEBGPU : ['--enable-unsafe-swiftshader'])],
  });
}

/** Opens the page and waits for the first drawing. Collects the errors that the page does not handle. */
export async function open(browser, url, options = {}) {
  // A context of its own: axe needs one, and no visit sees what another left.
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, colorScheme: 'light', ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(120_000);
  page.problems = [];
  page.on('pageerror', (error) => page.problems.push(error.stack ?? error.message));
  page.on('console', (message) => message.type() === 'error' && page.problems.push(message.text()));
  await page.goto(url);
  await drawn(page);
  return page;
}

/** The page has drawn what its last run gave. Asked by the clock: a page that is new to a busy machine may get no frame for long. */
export async function drawn(page) {
  const isDrawn = () => document.querySelector('#shown').textContent !== '' && document.querySelector('#busy').hidden;
  await page.waitForFunction(isDrawn, undefined, { polling: 100 });
}

/** The numbers in a text, without their commas. */
export const numbers = (text) => (text.match(/\d[\d,.]*/g) ?? []).map((n) => Number(n.replaceAll(',', '')));

export const text = (page, id) => page.locator(`#${id}`).textContent();

/** How many tetrahedra are shown, and of how many. */
export async function shown(page) {
  const found = numbers(await text(page, 'shown'));
  return { shown: found[0], total: found.at(-1) };
}

export async function tab(page, name) {
  await page.click(`#tab-${name}`);
}

/** Sets a slider as a visitor's hand does. */
export async function slide(page, id, value) {
  await page.locator(`#${id}`).evaluate((slider, value) => {
    slider.value = String(value);
    slider.dispatchEvent(new Event('input', { bubbles: true }));
  }, value);
}

/** Chooses a radio button, whose own box is not to be seen. */
export async function choose(page, name, value) {
  await page.locator(`input[name="${name}"][value="${value}"]`).evaluate((radio) => radio.click());
}

/** Generates points with a given engine, through the panel. */
export async function generate(page, distribution, points, { engine = 'auto', wait = true } = {}) {
  await tab(page, 'points');
  if (!(await page.isChecked(`input[name=engine][value=${engine}]`))) {
    await choose(page, 'engine', engine);
    await drawn(page);
  }
  await page.selectOption('#distribution', distribution);
  await page.fill('#number', String(points));
  await page.click('#generator button[type=submit]');
  if (wait) await page.waitForFunction((n) => document.querySelector('#count').textContent.startsWith(`${n} points`), points.toLocaleString('en'));
  if (wait) await drawn(page);
}

/** Drops a file on the page. */
export async function drop(page, name, bytes) {
  const transfer = await page.evaluateHandle(
    ({ name, base64 }) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
      return transfer;
    },
    { name, base64: Buffer.from(bytes).toString('base64') },
  );
  await page.dispatchEvent('#stage', 'dragover', { dataTransfer: transfer });
  await page.dispatchEvent('#stage', 'drop', { dataTransfer: transfer });
}

/** Saves a picture of the page. */
export async function pictureOf(page, name) {
  // Fonts and transitions settle.
  await page.waitForTimeout(400);
  return page.screenshot({ path: `${SCREENSHOTS}${name}.png` });
}
