// What the page may cost at a million points. Prints what it measures.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { generate, launch, open, serve, slide } from '../browser.mjs';

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
