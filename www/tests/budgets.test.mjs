// What the page may cost. Prints what it measures.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { drawn, generate, launch, open, serve, slide } from './browser.mjs';

const dist = fileURLToPath(new URL('../dist/', import.meta.url));

let server;
let browser;
before(async () => {
  server = await serve();
  browser = await launch();
});
after(async () => {
  await browser.close();
  await server.close();
});

test('the first view comes within two seconds, and takes less than 500 kB', async () => {
  // The first visit fills Chromium's caches of compiled shaders; the best of the later ones is what a machine with other
  // things to do can say.
  const seconds = [];
  let files;
  for (let visit = 0; visit < 4; visit++) {
    const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
    const page = await context.newPage();
    page.setDefaultTimeout(120_000);
    files = new Set();
    page.on('response', (response) => files.add(new URL(response.url()).pathname));
    await page.goto(server.url);
    await drawn(page);
    seconds.push((await page.evaluate(() => performance.now())) / 1000);
    await context.close();
  }
  console.log(`first view after ${seconds.map((s) => s.toFixed(2)).join(', ')} s`);
  const counted = [...files].filter((path) => !path.startsWith('/samples/') && !/viewer|three/.test(path));
  const kilobytes = (path) => gzipSync(readFileSync(dist + (path === '/' ? 'index.html' : path.slice(1)))).length / 1e3;
  let sum = 0;
  for (const path of counted.sort()) {
    console.log(`${kilobytes(path).toFixed(1).padStart(8)} kB ${path}`);
    sum += kilobytes(path);
  }
  console.log(`${sum.toFixed(1).padStart(8)} kB gzipped, without samples and three.js`);
  assert.ok(sum < 500, `${sum} kB`);
  // On a machine with nothing else to do.
  assert.ok(Math.min(...seconds) < 2, `${Math.min(...seconds)} s`);
});

test('triangulating blocks the page for less than 50 ms, and a plane cuts a million points in less than 500 ms', async () => {
  const page = await open(browser, server.url);
  await page.evaluate(() => {
    window.longest = 0;
    // A timer that comes late tells how long the thread was taken.
    let last = performance.now();
    setInterval(() => {
      const now = performance.now();
      window.longest = Math.max(window.longest, now - last);
      last = now;
    }, 1);
    window.tasks = [];
    new PerformanceObserver((list) => window.tasks.push(...list.getEntries().map(({ duration }) => duration))).observe({ type: 'longtask' });
  });
  page.setDefaultTimeout(300_000);
  await generate(page, 'uniform', 1_000_000, { engine: 'cpu' });
  const { longest, tasks } = await page.evaluate(() => ({ longest: window.longest, tasks: window.tasks }));
  console.log(`a million points: the page waited for ${longest.toFixed(0)} ms at most, its longest task took ${Math.max(0, ...tasks).toFixed(0)} ms`);
  const times = [];
  for (const keep of [0.4, 0.45, 0.6, 0.62, 0.64]) {
    const before = await page.locator('#shown').getAttribute('title');
    await slide(page, 'keep', keep);
    await page.waitForFunction((before) => document.querySelector('#shown').title !== before, before);
    times.push(parseFloat(await page.locator('#shown').getAttribute('title')));
  }
  console.log(`a million points: the cut was rebuilt in ${times.join(', ')} ms`);
  assert.ok(Math.max(0, ...tasks) < 50, `a task of ${Math.max(...tasks)} ms`);
  assert.ok(Math.max(...times) < 500, `${Math.max(...times)} ms`);
});
