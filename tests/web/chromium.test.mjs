// The installed package in headless Chromium, with WebGPU on SwiftShader.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launchChromium, WEBGPU } from './browsers.mjs';
import { dist, pinned, project, root } from './package.mjs';
import { serve } from './server.mjs';

const folder = project();
const folders = { '/gdel/': dist(folder), '/tests/': `${root}/tests/web` };

let browser;
const servers = [];
before(async () => {
  browser = await launchChromium(WEBGPU);
});
after(async () => {
  await browser.close();
  for (const server of servers) server.close();
});

async function server(options) {
  const started = await serve(folders, options);
  servers.push(started);
  return started;
}

/** An empty page, of a server with these options. */
async function open(options = {}, inBrowser = browser) {
  const page = await inBrowser.newPage();
  await page.goto((await server(options)).url);
  return page;
}

const TETRAHEDRON = [
  [0, 0, 0],
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];

test('the CPU engine gives the native meshes, in a worker', async () => {
  const page = await open();
  for (const { kind, count, seed, fingerprint } of pinned) {
    const found = await page.evaluate(
      async ({ kind, count, seed }) => {
        const { delaunay3d, generate } = await import('/gdel/index.js');
        const { fingerprint } = await import('/tests/fingerprints.mjs');
        const mesh = await delaunay3d(await generate(kind, count, { seed }), { engine: 'cpu' });
        return { fingerprint: fingerprint(mesh.tetrahedra), stats: mesh.stats };
      },
      { kind, count, seed },
    );
    assert.equal(found.fingerprint, fingerprint, kind);
    assert.equal(found.stats.thread, 'worker');
    assert.equal(found.stats.why, null);
    assert.ok(found.stats.phases.some(({ milliseconds }) => milliseconds > 0));
  }
  await page.close();
});

test('auto avoids a software adapter, and says so', async () => {
  const page = await open();
  const stats = await page.evaluate(async () => {
    const { delaunay3d, generate } = await import('/gdel/index.js');
    return (await delaunay3d(await generate('uniform', 30_000))).stats;
  });
  assert.equal(stats.engine, 'cpu');
  assert.match(stats.why, /swiftshader.*software/);
  const few = await page.evaluate(
    async (points) => (await (await import('/gdel/index.js')).delaunay3d(points)).stats,
    TETRAHEDRON,
  );
  assert.match(few.why, /too few/);
  await page.close();
});

// One device for all of this: SwiftShader takes long to compile the kernels.
test('the GPU engine: native mesh, trace, progress, abort, device loss', {
  timeout: 900_000,
}, async () => {
  // The worker destroys its device after as many submits as it was told, so that it gets lost in the middle of a run.
  const loseDevice = `
    const { requestDevice } = GPUAdapter.prototype;
    const { submit } = GPUQueue.prototype;
    const channel = new BroadcastChannel('test');
    let device;
    let submits = 0;
    GPUAdapter.prototype.requestDevice = async function (...args) {
      return (device = await requestDevice.apply(this, args));
    };
    GPUQueue.prototype.submit = function (...args) {
      submit.apply(this, args);
      if (submits > 0 && --submits === 0) device.destroy();
    };
    channel.onmessage = ({ data }) => {
      // There is a worker that generates points, too, which also answers.
      if (typeof data !== 'number') return;
      submits = data;
      channel.postMessage('told');
    };\n`;
  const page = await open({
    change: (path, content) => (path === '/gdel/worker.js' ? loseDevice + content : content),
  });
  const small = pinned.find(({ count }) => count < 100);
  const found = await page.evaluate(async ({ kind, count, seed }) => {
    const { createEngine, generate } = await import('/gdel/index.js');
    const { fingerprint } = await import('/tests/fingerprints.mjs');
    const { abortOf } = await import('/tests/abort.mjs');
    const points = await generate(kind, count, { seed });
    const engine = await createEngine({ engine: 'gpu' });
    const fractions = [];
    const onProgress = ({ fraction }) => fractions.push(fraction);
    const mesh = await engine.delaunay3d(points, {
      outputs: ['neighbors', 'hull', 'duplicateOf', 'trace'],
      onProgress,
    });
    const trace = {
      rounds: mesh.trace.rounds.map(({ tetrahedra }) => tetrahedra.length / 4),
      created: mesh.trace.created.length,
      facets: mesh.trace.nonDelaunayFacets.length,
    };

    const code = (promise) =>
      promise.then(
        () => 'none',
        (error) => error.code,
      );
    const channel = new BroadcastChannel('test');
    await new Promise((told) => {
      channel.onmessage = told;
      channel.postMessage(3);
    });
    const lossCode = await code(engine.delaunay3d(points));
    const again = await engine.delaunay3d(points);

    const aborted = await abortOf((options) => engine.delaunay3d(points, options));
    engine.dispose();
    const prints = [mesh, again].map(({ tetrahedra }) => fingerprint(tetrahedra));
    return { info: engine.info, stats: mesh.stats, prints, trace, fractions, aborted, lossCode };
  }, small);
  assert.deepEqual(found.prints, [small.fingerprint, small.fingerprint]);
  assert.equal(found.info.engine, 'gpu');
  assert.equal(found.stats.engine, 'gpu');
  assert.equal(found.stats.why, null);
  assert.equal(found.stats.adapter.architecture, 'swiftshader');
  for (const count of ['readbacks', 'dispatches', 'submits', 'bytes'])
    assert.ok(found.stats.gpu[count] > 0, count);
  assert.equal(found.trace.rounds.length, found.stats.gpu.rounds.length);
  assert.equal(found.trace.created, small.tetrahedra);
  assert.equal(found.fractions.at(-1), 1);
  assert.deepEqual(found.aborted, { code: 'ABORTED', atOnce: true });
  assert.equal(found.lossCode, 'DEVICE_LOST');
  await page.close();
});

test('without WebGPU: auto takes the CPU engine and says why, gpu is an error', async (t) => {
  const plain = await launchChromium(['--disable-features=WebGPU']);
  t.after(() => plain.close());
  const page = await open({}, plain);
  const found = await page.evaluate(async () => {
    const { delaunay3d, generate } = await import('/gdel/index.js');
    const points = await generate('uniform', 30_000);
    const code = await delaunay3d(points, { engine: 'gpu' }).catch((error) => error.code);
    return { code, stats: (await delaunay3d(points)).stats };
  });
  assert.equal(found.code, 'NO_ADAPTER');
  assert.equal(found.stats.engine, 'cpu');
  assert.match(found.stats.why, /WebGPU/);
});

test('a worker that is blocked: the calling thread does the work', async () => {
  const page = await open({
    headers: {
      'content-security-policy': "worker-src 'none'; script-src 'self' 'wasm-unsafe-eval'",
    },
  });
  const stats = await page.evaluate(
    async (points) => (await (await import('/gdel/index.js')).delaunay3d(points)).stats,
    TETRAHEDRON,
  );
  assert.equal(stats.thread, 'caller');
  assert.match(stats.whyThread, /worker/);
  await page.close();
});

test('a policy without wasm-unsafe-eval is a typed error', async () => {
  const page = await open({ headers: { 'content-security-policy': "script-src 'self'" } });
  const error = await page.evaluate(async (points) => {
    const { delaunay3d } = await import('/gdel/index.js');
    return delaunay3d(points).catch(({ code, message }) => ({ code, message }));
  }, TETRAHEDRON);
  assert.equal(error.code, 'LOAD_FAILED');
  assert.match(error.message, /Content Security Policy/i);
  await page.close();
});

test('from another origin, the worker comes through a blob', async () => {
  const other = await server({ headers: { 'access-control-allow-origin': '*' } });
  const page = await open();
  const stats = await page.evaluate(
    async ({ url, points }) =>
      (await (await import(`${url}/gdel/index.js`)).delaunay3d(points)).stats,
    { url: other.url, points: TETRAHEDRON },
  );
  assert.equal(stats.thread, 'worker');
  await page.close();
});

test('the inlined build works from one file', async () => {
  const page = await open();
  const requests = [];
  page.on('request', (request) => requests.push(new URL(request.url()).pathname));
  const found = await page.evaluate(async (points) => {
    const { delaunay3d } = await import('/gdel/inline.js');
    const mesh = await delaunay3d(points);
    return { thread: mesh.stats.thread, ply: (await mesh.toPLY()).length };
  }, TETRAHEDRON);
  assert.equal(found.thread, 'worker');
  assert.ok(found.ply > 0);
  assert.deepEqual(
    requests.filter((path) => path.startsWith('/gdel/')),
    ['/gdel/inline.js'],
  );
  await page.close();
});

test('an abort takes effect at once, and the engine goes on', async () => {
  const page = await open();
  const found = await page.evaluate(async (tetrahedron) => {
    const { delaunay3d, generate } = await import('/gdel/index.js');
    const { abortOf } = await import('/tests/abort.mjs');
    const points = await generate('uniform', 200_000);
    const aborted = await abortOf(
      (options) => delaunay3d(points, { engine: 'cpu', ...options }),
      'insert',
    );
    return { ...aborted, next: (await delaunay3d(tetrahedron)).tetrahedra.length };
  }, TETRAHEDRON);
  assert.deepEqual(found, { code: 'ABORTED', atOnce: true, next: 4 });
  await page.close();
});

test('50 runs need no more memory than a few', async () => {
  const page = await open();
  const bytes = await page.evaluate(async () => {
    const { delaunay3d, generate } = await import('/gdel/index.js');
    const points = await generate('uniform', 10_000);
    const bytes = [];
    for (let i = 0; i < 50; i++) bytes.push((await delaunay3d(points)).stats.wasmBytes);
    return bytes;
  });
  assert.equal(bytes.at(-1), bytes[2]);
  await page.close();
});
