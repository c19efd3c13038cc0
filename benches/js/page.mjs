// How long visitors of the page and users of the package wait: times against their budgets, on the
// machine at hand, a line of JSON each. For a machine that does nothing else.
//
//   npm run bench:page
//
// Exits with 1 if a budget is exceeded.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { launchChromium, launchFirefox } from '../../tests/web/browsers.mjs';
import { dist, project, root } from '../../tests/web/package.mjs';
import { serve } from '../../tests/web/server.mjs';
import {
  drop,
  generate,
  launch,
  nextPicture,
  open,
  serve as servePage,
  settled,
  slide,
} from '../../www/tests/browser.mjs';
import { airborne, xyz } from '../../www/tests/models.mjs';
import { median, print } from './common.mjs';

let kept = true;

/** Prints a row. Without a budget, a figure is only shown. */
function report(what, all, budget, figure = 'median') {
  const ms = figure === 'median' ? median(all) : Math.max(...all);
  const isKept = budget === undefined || ms <= budget;
  kept &&= isKept;
  print({ what, figure, ms, all_ms: all, budget_ms: budget, kept: isKept });
}

const times = async (count, measure) => {
  const found = [];
  for (let i = 0; i < count; i++) found.push(await measure());
  return found;
};

/** How long a dropped scan is not to be seen yet once its mesh is there. */
async function pictureTimes(page) {
  const scan = xyz(airborne(110_000));
  return times(5, async () => {
    const { meshed, shown } = await nextPicture(page, () => drop(page, 'hills.xyz', scan));
    return shown - meshed;
  });
}

/** How long the page for treemaps takes for 3,000 cells, from their values on, when its module is loaded. */
async function treemapTimes(browser, url) {
  const context = await browser.newContext({ reducedMotion: 'reduce', serviceWorkers: 'block' });
  const page = await context.newPage();
  await page.goto(`${url}treemap/#example=body`);
  await settled(page);
  const found = await times(7, async () => {
    await page.selectOption('#source', 'many');
    await settled(page);
    const { milliseconds, error } = await page
      .locator('#stage')
      .evaluate(({ dataset }) => ({ ...dataset }));
    assert.ok(Number(error) <= 1e-3, error);
    await page.selectOption('#source', 'body');
    await settled(page);
    return Number(milliseconds);
  });
  await context.close();
  return found;
}

async function benchPage() {
  const server = await servePage();
  const browser = await launch();
  try {
    const visit = async () => {
      const page = await open(browser, server.url);
      const now = await page.evaluate(() => performance.now());
      await page.context().close();
      return now;
    };
    // The first visit fills Chromium's cache of compiled shaders.
    await visit();
    report('first view', await times(7, visit), 2000);

    const page = await open(browser, server.url);
    await page.evaluate(() => {
      globalThis.tasks = [0];
      new PerformanceObserver((list) =>
        tasks.push(...list.getEntries().map(({ duration }) => duration)),
      ).observe({ type: 'longtask' });
    });
    await generate(page, 'uniform', 1_000_000, { backend: 'cpu' });
    report('longest task of the page, 1 M points', await page.evaluate(() => tasks), 50, 'maximum');
    const cuts = [];
    for (const keep of [0.4, 0.45, 0.6, 0.62, 0.64]) {
      await slide(page, 'keep', keep);
      await settled(page);
      cuts.push(parseFloat(await page.locator('#shown').getAttribute('title')));
    }
    report('cut through 1 M points', cuts, 500);
    report('picture of a scan of 110,000 points, from its mesh on', await pictureTimes(page), 1000);
    report('treemap of 3,000 cells', await treemapTimes(browser, server.url), 300);
  } finally {
    await browser.close();
    await server.close();
  }
}

/**
 * Runs in pages and in Node: the time from an abort in the middle of a run until its promise is
 * rejected, and until the next run is done.
 */
async function abortTimes(module) {
  const { delaunay3d, generate } = await import(module);
  const points = await generate('uniform', 200_000);
  const controller = new AbortController();
  let aborted;
  const onProgress = ({ phase }) => {
    if (phase !== 'insert' || aborted) return;
    aborted = performance.now();
    controller.abort();
  };
  await delaunay3d(points, { backend: 'cpu', signal: controller.signal, onProgress }).catch(
    () => {},
  );
  const rejected = performance.now() - aborted;
  await delaunay3d([
    [0, 0, 0],
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ]);
  return { rejected, next: performance.now() - aborted };
}

function reportAborts(where, found) {
  const of = (key) => found.map((each) => each[key]);
  report(`abort in ${where}, until the promise is rejected`, of('rejected'), 100);
  report(`abort in ${where}, until the next run is done`, of('next'));
}

/**
 * The longest task of the page's main thread, in milliseconds on the processor, while `work` runs.
 */
async function longestTask(browser, page, work) {
  await browser.startTracing(page, { categories: ['toplevel', 'devtools.timeline'] });
  await page.evaluate(work);
  const { traceEvents } = JSON.parse((await browser.stopTracing()).toString());
  const main = traceEvents.filter(
    ({ name, args }) => name === 'thread_name' && args.name === 'CrRendererMain',
  );
  const threads = new Set(main.map(({ pid, tid }) => `${pid} ${tid}`));
  const tasks = traceEvents.filter(
    ({ pid, tid, tdur }) => tdur !== undefined && threads.has(`${pid} ${tid}`),
  );
  return tasks.reduce((longest, { tdur }) => Math.max(longest, tdur), 0) / 1e3;
}

async function benchPackage() {
  const folder = project();
  const server = await serve({ '/gdel/': dist(folder), '/tests/': join(root, 'tests/web') });
  const browsers = [
    ['Chromium', launchChromium],
    ['Firefox', launchFirefox],
  ];
  try {
    for (const [name, launchIt] of browsers) {
      const browser = await launchIt();
      try {
        const page = await browser.newPage();
        page.setDefaultTimeout(0);
        await page.goto(server.url);
        if (name === 'Chromium') {
          await page.evaluate(async () => {
            const { delaunay3d, generate } = await import('/gdel/index.js');
            Object.assign(globalThis, { delaunay3d, points: await generate('uniform', 1_000_000) });
          });
          const longest = () =>
            longestTask(
              browser,
              page,
              async () => void (await delaunay3d(points, { backend: 'cpu' })),
            );
          report(
            'longest task of a page that triangulates 1 M points',
            await times(3, longest),
            16,
          );
        }
        reportAborts(name, await times(5, () => page.evaluate(abortTimes, '/gdel/index.js')));
      } finally {
        await browser.close();
      }
    }
    reportAborts(
      'Node',
      await times(5, () => abortTimes(pathToFileURL(join(dist(folder), 'index.js')).href)),
    );
  } finally {
    server.close();
  }
}

await benchPage();
await benchPackage();
process.exitCode = kept ? 0 : 1;
