// How long runs on a device of the caller's block the calling thread, in Node through the npm package
// `webgpu` (Dawn), or in a page of headless Chromium. Prints a line of JSON per run.
//
//   node benches/js/blocked.mjs [--package FOLDER] [--in node|chromium] [--points 100000]
//     [--kind uniform] [--dimension 3] [--backend gpu] [--runs 3] [--resident]
//
// A timer looks at the clock as often as it may, which is each millisecond in Node and every four in
// browsers. What lies between two looks beyond that is what other tasks of the thread had to wait, and
// what the system gave to other processes, of which a GPU in software makes many.

import { existsSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { launchChromium, WEBGPU } from '../../tests/web/browsers.mjs';
import { root } from '../../tests/web/package.mjs';
import { serve } from '../../tests/web/server.mjs';
import { print } from './common.mjs';

const { values } = parseArgs({
  options: {
    package: { type: 'string', default: join(root, 'web/dist') },
    in: { type: 'string', default: 'node' },
    points: { type: 'string', default: '100000' },
    kind: { type: 'string', default: 'uniform' },
    dimension: { type: 'string', default: '3' },
    backend: { type: 'string', default: 'gpu' },
    runs: { type: 'string', default: '3' },
    resident: { type: 'boolean', default: false },
  },
});
const settings = {
  points: Number(values.points),
  kind: values.kind,
  backend: values.backend,
  period: values.in === 'node' ? 1 : 4,
  dimension: Number(values.dimension),
  runs: Number(values.runs),
  resident: values.resident,
};

/** Returns a row for what opens a triangulator, and one for each run. Pages get its text. */
async function measure(gdel, gpu, settings) {
  const { points, kind, backend, period, dimension, runs, resident } = settings;
  /** Returns how long something takes, and how long the thread was blocked meanwhile. */
  async function watch(what, work) {
    const blocks = [];
    let timer;
    let last = performance.now();
    const look = () => {
      const now = performance.now();
      blocks.push(now - last - period);
      last = now;
      timer = setTimeout(look, 0);
    };
    timer = setTimeout(look, 0);
    const started = performance.now();
    const result = await work();
    const milliseconds = performance.now() - started;
    look();
    clearTimeout(timer);
    const round = (x) => Math.round(10 * x) / 10;
    const long = blocks.filter((block) => block > 8).sort((a, b) => b - a);
    const row = {
      what,
      milliseconds: round(milliseconds),
      longestBlock: round(Math.max(...blocks)),
      above8: long.length,
      theirSum: round(long.reduce((sum, block) => sum + block, 0)),
      longest: long.slice(0, 5).map(round),
    };
    return [result, row];
  }

  const adapter = await gpu.requestAdapter({ powerPreference: 'high-performance' });
  const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
  const requiredLimits = { maxBufferSize, maxStorageBufferBindingSize };
  const device = await adapter.requestDevice({ requiredLimits });
  const generate = dimension === 3 ? gdel.generate : gdel.generate2d;
  // The flat points of a device are the CPU's.
  const all = await generate(kind === 'flat' ? 'uniform' : kind, points, { seed: 1 });
  if (kind === 'flat') for (let i = 0; i < all.length; i += dimension) all[i] = 0.5;
  const [triangulator, opening] = await watch('opening', () =>
    gdel.createTriangulator({ device, backend: 'gpu' }),
  );
  const rows = [opening];
  for (let run = 0; run < runs; run++) {
    const copy = all.slice();
    const [mesh, row] = await watch(run === 0 ? 'first run' : 'run', () =>
      triangulator[`delaunay${dimension}d`](copy, { transfer: true, resident, backend }),
    );
    const { thread, backend: used, fallback, splay } = mesh.stats;
    rows.push({ ...row, thread, used, fallback, stars: splay?.built });
    if (resident) mesh.destroy();
  }
  triangulator.dispose();
  device.destroy();
  return rows;
}

async function inNode() {
  const swiftshader = '/usr/lib/chromium/vk_swiftshader_icd.json';
  if (!process.env.VK_DRIVER_FILES && existsSync(swiftshader))
    process.env.VK_DRIVER_FILES = swiftshader;
  const { create } = await import('webgpu');
  // When it is garbage, its devices are lost.
  globalThis.gpu = create([]);
  const gdel = await import(pathToFileURL(join(resolve(values.package), 'index.js')));
  return measure(gdel, globalThis.gpu, settings);
}

async function inChromium() {
  const browser = await launchChromium(WEBGPU);
  const server = await serve({ '/gdel/': resolve(values.package) });
  try {
    const page = await browser.newPage();
    await page.goto(server.url);
    const code = `(async () => (${measure})(await import('/gdel/index.js'), navigator.gpu, ${JSON.stringify(settings)}))()`;
    return await page.evaluate(code);
  } finally {
    await browser.close();
    server.close();
  }
}

const rows = await (values.in === 'chromium' ? inChromium() : inNode());
for (const row of rows) print({ in: values.in, ...settings, ...row });
// Dawn keeps Node alive.
process.exit();
