// Times the package and the page in Chromium on the machine's GPU: a line of JSON per row. scripts/browser-gpu.sh
// starts it.
//
//   node benches/js/browser.mjs [--only package,page] [--points 10000,100000,1000000,5000000]
//     [--modes worker,device,caller] [--results all,tetrahedra,resident] [--backend auto] [--double]
//     [--runs 7] [--processes 3] [--pictures FOLDER] [--any-adapter]
//
// Modes: `worker` is what `import { delaunay3d }` gives; `device` has a device of the caller's, and a worker;
// `caller` has no worker. Each process is a Chromium of its own, with an empty profile. It fails where the adapter is
// software, unless --any-adapter is given, where a page has an error on its console, and where two rows of the
// same points have different numbers of tetrahedra.

import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { launchChromium, WEBGPU_DRAWING } from '../../tests/web/browsers.mjs';
import { serve } from '../../tests/web/server.mjs';
import { nextPicture, open, request, settled } from '../../www/tests/driving.mjs';
import { airborne, xyz } from '../../www/tests/models.mjs';
import { print, root, times } from './common.mjs';

const { values } = parseArgs({
  options: {
    only: { type: 'string', default: 'package,page' },
    points: { type: 'string', default: '10000,100000,1000000,5000000' },
    modes: { type: 'string', default: 'worker,device,caller' },
    results: { type: 'string', default: 'all,tetrahedra,resident' },
    backend: { type: 'string', default: 'auto' },
    double: { type: 'boolean', default: false },
    runs: { type: 'string', default: '7' },
    processes: { type: 'string', default: '3' },
    pictures: { type: 'string' },
    'any-adapter': { type: 'boolean', default: false },
  },
});
const list = (text) => text.split(',').filter(Boolean);
const only = list(values.only);
const problems = [];

/** Runs in the page: times one kind of result, of one size, in one mode. Returns a row. */
async function measure({ points: n, mode, result, backend, runs, double }) {
  const WARM_UP_MILLISECONDS = 1500;
  const state = (globalThis.state ??= { triangulators: {} });
  const gdel = (state.gdel ??= await import('/gdel/index.js'));
  if (state.n !== n) {
    const all = await gdel.generate('uniform', n, { seed: 1 });
    Object.assign(state, { n, points: double ? all : Float32Array.from(all) });
  }

  async function triangulator() {
    if (mode === 'worker') return gdel;
    const adapter = await navigator.gpu.requestAdapter({ powerPreference: 'high-performance' });
    const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
    const requiredLimits = { maxBufferSize, maxStorageBufferBindingSize };
    const device = await adapter.requestDevice({ requiredLimits });
    device.addEventListener('uncapturederror', ({ error }) => console.error(error.message));
    return gdel.createTriangulator({ device, worker: mode === 'device' });
  }
  state.triangulators[mode] ??= await triangulator();

  const options = { backend };
  if (result === 'tetrahedra') options.outputs = [];
  if (result === 'resident') options.resident = true;
  let mesh;
  const run = async () => {
    mesh = undefined;
    if (n >= 2e6) globalThis.gc?.();
    await new Promise((done) => setTimeout(done, 0));
    const began = performance.now();
    mesh = await state.triangulators[mode].delaunay3d(state.points, options);
    const milliseconds = performance.now() - began;
    if (result === 'resident') mesh.destroy();
    return milliseconds;
  };
  const began = performance.now();
  const first = await run();
  do await run();
  while (performance.now() - began < WARM_UP_MILLISECONDS);
  const all = [];
  while (all.length < runs) all.push(await run());

  // How long the page's thread is held up, in two more runs: timers that are nested fire each 4 ms.
  const PERIOD = 4;
  let stall = 0;
  for (let i = 0; i < 2; i++) {
    let last = performance.now();
    let timer;
    const tick = () => {
      const now = performance.now();
      stall = Math.max(stall, now - last - PERIOD);
      last = now;
      timer = setTimeout(tick, 0);
    };
    timer = setTimeout(tick, 0);
    await run();
    tick();
    clearTimeout(timer);
  }
  const { stats } = mesh;
  return {
    first,
    all,
    stall,
    tetrahedra: mesh.tetrahedronCount ?? mesh.tetrahedra.length / 4,
    backend: stats.backend,
    fallback: stats.fallback,
    thread: stats.thread,
    adapter: stats.adapter && { ...stats.adapter },
    phases: Object.fromEntries(stats.phases.map(({ name, milliseconds }) => [name, milliseconds])),
    gpu: stats.gpu && { ...stats.gpu, rounds: stats.gpu.rounds?.length },
    wasmBytes: stats.wasmBytes,
  };
}

const counts = new Map();

/** Prints a row, with the adapter by a name, after it was checked. */
function report({ adapter, ...row }) {
  const name = adapter && [adapter.description, adapter.vendor, adapter.architecture].find(Boolean);
  if (row.tetrahedra !== undefined) {
    const key = `${row.points} ${row.precision}`;
    if ((counts.get(key) ?? row.tetrahedra) !== row.tetrahedra)
      problems.push(`${key}: ${counts.get(key)} and ${row.tetrahedra} tetrahedra`);
    counts.set(key, row.tetrahedra);
  }
  print({ browser: version, adapter: name, ...row });
}

let version;
async function launch() {
  const browser = await launchChromium(WEBGPU_DRAWING);
  version = `Chromium ${browser.version()}`;
  return browser;
}

/** Notes what a page says that it should not. */
function watch(page) {
  page.on('console', (message) => message.type() === 'error' && problems.push(message.text()));
  page.on('pageerror', (error) => problems.push(error.stack ?? error.message));
  page.on('crash', () => problems.push('the page has crashed'));
}

/** Fails where pages have no adapter but a software one, which Chromium gives them without a word. */
async function checkAdapter(page) {
  const info = await page.evaluate(async () => {
    const adapter = await navigator.gpu?.requestAdapter();
    const { vendor, architecture, description } = adapter?.info ?? {};
    return (
      adapter && { vendor, architecture, description, software: adapter.info.isFallbackAdapter }
    );
  });
  const isSoftware = !info || info.software || /swiftshader/i.test(JSON.stringify(info));
  if (isSoftware && !values['any-adapter'])
    throw new Error(`there is no adapter of a GPU: ${JSON.stringify(info)}`);
  return info;
}

async function benchPackage(server, number) {
  const browser = await launch();
  try {
    const page = await browser.newPage();
    page.setDefaultTimeout(0);
    watch(page);
    await page.goto(server.url);
    const adapter = await checkAdapter(page);
    for (const points of list(values.points).map(Number))
      for (const mode of list(values.modes))
        for (const result of list(values.results)) {
          // Meshes stay on a device of the caller's only.
          if (result === 'resident' && mode === 'worker') continue;
          const settings = { points, mode, result, backend: values.backend, double: values.double };
          const row = await page.evaluate(measure, { ...settings, runs: Number(values.runs) });
          const { all, first, ...others } = row;
          report({
            ...settings,
            input: 'uniform',
            precision: values.double ? 'f64' : 'f32',
            process: number,
            ...others,
            asked: values.backend,
            ...times('ms', all),
            first_ms: first,
            adapter,
          });
        }
  } finally {
    await browser.close();
  }
}

/** How many pictures a second the page draws while `work` goes on, and the longest time between two. */
async function frames(page, work) {
  await page.evaluate(() => {
    const seen = (globalThis.frames = []);
    const frame = (time) => {
      seen.push(time);
      if (globalThis.frames === seen) requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  });
  await work();
  return page.evaluate(() => {
    const seen = globalThis.frames;
    globalThis.frames = undefined;
    const gaps = seen.slice(1).map((time, i) => time - seen[i]);
    return {
      frames_per_second: (1e3 * gaps.length) / (seen.at(-1) - seen[0]),
      longest_frame_ms: Math.max(...gaps),
    };
  });
}

/** Drops the scan that is served: not by the way of the tests, which takes longer than the page. */
async function dropScan(page) {
  await page.evaluate(async (address) => {
    globalThis.scan ??= await (await fetch(address)).arrayBuffer();
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File([globalThis.scan], 'hills.xyz'));
    const stage = document.getElementById('stage');
    for (const type of ['dragover', 'drop'])
      stage.dispatchEvent(new DragEvent(type, { bubbles: true, cancelable: true, dataTransfer }));
  }, '/scan/hills.xyz');
}

async function benchPage(server, number) {
  const browser = await launch();
  try {
    const blank = await browser.newPage();
    await blank.goto(server.url);
    const adapter = await checkAdapter(blank);
    await blank.close();
    const say = (what, ms, more = {}) => report({ what, ms, process: number, adapter, ...more });

    const began = performance.now();
    const page = await open(browser, `${server.url}/page/index.html`);
    watch(page);
    say('page settled, first visit', performance.now() - began);
    const timed = async (what, work) => {
      let picture;
      const drawn = await frames(page, async () => {
        picture = await nextPicture(page, work);
      });
      await settled(page);
      const shown = await page.evaluate(() => ({
        took: document.getElementById('took')?.textContent,
        backend: document.getElementById('backend-used')?.textContent.trim(),
      }));
      const { began, meshed, shown: there } = picture;
      say(what, there - began, { meshed_ms: meshed - began, ...drawn, ...shown });
    };
    for (const which of ['first', 'second'])
      await timed(`${which} drop of a scan of 110,000 points`, () => dropScan(page));
    for (const seed of [1, 2, 3])
      await timed(`a million points generated, seed ${seed}`, async () => {
        await page.fill('#seed', String(seed));
        await request(page, 'uniform', 1_000_000);
      });
    if (values.pictures) {
      mkdirSync(values.pictures, { recursive: true });
      await page.screenshot({ path: join(values.pictures, `page-${number}.png`) });
    }
    problems.push(...page.problems);
  } finally {
    await browser.close();
  }
}

const scans = mkdtempSync(join(tmpdir(), 'gdel-scan-'));
writeFileSync(join(scans, 'hills.xyz'), xyz(airborne(110_000)));
const server = await serve({
  '/gdel/': join(root, 'web/dist'),
  '/page/': join(root, 'www/dist'),
  '/scan/': scans,
});
try {
  for (let number = 1; number <= Number(values.processes); number++) {
    if (only.includes('package')) await benchPackage(server, number);
    if (only.includes('page')) await benchPage(server, number);
  }
} finally {
  server.close();
  rmSync(scans, { recursive: true });
}
for (const problem of new Set(problems)) console.error(`browser: ${problem}`);
if (problems.length > 0) process.exitCode = 1;
