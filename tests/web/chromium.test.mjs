// The installed package in headless Chromium, with WebGPU on SwiftShader.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launchChromium, WEBGPU } from './browsers.mjs';
import { dist, pinned, project, root } from './package.mjs';
import { testPages } from './pages.mjs';
import { serve } from './server.mjs';

// scripts/browser-gpu.sh runs this file in a Chromium that always has WebGPU, on a GPU.
const onGpu = process.env.GDEL_REAL_GPU ? 'Chromium has WebGPU on a GPU' : false;

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

test('the CPU backend gives the native meshes, in a worker', async () => {
  const page = await open();
  for (const { kind, count, seed, fingerprint } of pinned) {
    const found = await page.evaluate(
      async ({ kind, count, seed }) => {
        const { delaunay3d, generate } = await import('/gdel/index.js');
        const { fingerprint } = await import('/tests/fingerprints.mjs');
        const mesh = await delaunay3d(await generate(kind, count, { seed }), { backend: 'cpu' });
        return { fingerprint: fingerprint(mesh.tetrahedra), stats: mesh.stats };
      },
      { kind, count, seed },
    );
    assert.equal(found.fingerprint, fingerprint, kind);
    assert.equal(found.stats.thread, 'worker');
    assert.equal(found.stats.fallback, null);
    assert.ok(found.stats.phases.some(({ milliseconds }) => milliseconds > 0));
  }
  await page.close();
});

test('auto avoids a software adapter, and says so', { skip: onGpu }, async () => {
  const page = await open();
  const stats = await page.evaluate(async () => {
    const { delaunay3d, generate } = await import('/gdel/index.js');
    return (await delaunay3d(await generate('uniform', 30_000))).stats;
  });
  assert.equal(stats.backend, 'cpu');
  assert.match(stats.fallback, /swiftshader.*software/);
  const few = await page.evaluate(
    async (points) => (await (await import('/gdel/index.js')).delaunay3d(points)).stats,
    TETRAHEDRON,
  );
  assert.match(few.fallback, /too few/);
  await page.close();
});

// One device for all of this: SwiftShader takes long to compile the kernels.
test('the GPU backend: native mesh, trace, progress, abort, device loss', {
  timeout: 900_000,
}, async () => {
  // The worker destroys its device after as many submits as it was told, so that it gets lost in
  // the middle of a run.
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
    change: (path, content) => (path === '/gdel/worker-3d.js' ? loseDevice + content : content),
  });
  const small = pinned.find(({ count }) => count < 100);
  const found = await page.evaluate(async ({ kind, count, seed }) => {
    const { createTriangulator, generate } = await import('/gdel/index.js');
    const { fingerprint } = await import('/tests/fingerprints.mjs');
    const { abortOf } = await import('/tests/abort.mjs');
    const points = await generate(kind, count, { seed });
    const triangulator = await createTriangulator({ backend: 'gpu' });
    const fractions = [];
    const onProgress = ({ fraction }) => fractions.push(fraction);
    const mesh = await triangulator.delaunay3d(points, {
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
    const lossCode = await code(triangulator.delaunay3d(points));
    const again = await triangulator.delaunay3d(points);

    const aborted = await abortOf((options) => triangulator.delaunay3d(points, options));
    triangulator.dispose();
    const prints = [mesh, again].map(({ tetrahedra }) => fingerprint(tetrahedra));
    return {
      info: triangulator.info,
      stats: mesh.stats,
      prints,
      trace,
      fractions,
      aborted,
      lossCode,
    };
  }, small);
  assert.deepEqual(found.prints, [small.fingerprint, small.fingerprint]);
  assert.equal(found.info.backend, 'gpu');
  assert.equal(found.stats.backend, 'gpu');
  assert.equal(found.stats.fallback, null);
  const { architecture, software } = found.stats.adapter;
  if (onGpu) assert.equal(software, false);
  else assert.equal(architecture, 'swiftshader');
  for (const count of ['readbacks', 'dispatches', 'submits', 'bytes'])
    assert.ok(found.stats.gpu[count] > 0, count);
  assert.equal(found.trace.rounds.length, found.stats.gpu.rounds.length);
  assert.equal(found.trace.created, small.tetrahedra);
  assert.equal(found.fractions.at(-1), 1);
  assert.deepEqual(found.aborted, { code: 'ABORTED', atOnce: true });
  assert.equal(found.lossCode, 'DEVICE_LOST');
  await page.close();
});

test('without WebGPU: auto takes the CPU backend and says why, gpu is an error', {
  skip: onGpu,
}, async (t) => {
  const plain = await launchChromium(['--disable-features=WebGPU']);
  t.after(() => plain.close());
  const page = await open({}, plain);
  const found = await page.evaluate(async () => {
    const { delaunay3d, generate } = await import('/gdel/index.js');
    const points = await generate('uniform', 30_000);
    const code = await delaunay3d(points, { backend: 'gpu' }).catch((error) => error.code);
    return { code, stats: (await delaunay3d(points)).stats };
  });
  assert.equal(found.code, 'NO_ADAPTER');
  assert.equal(found.stats.backend, 'cpu');
  assert.match(found.stats.fallback, /WebGPU/);
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
  assert.match(stats.whyInlined, /Worker/);
  await page.close();
});

/** The files that a page asks for, and what it finds. */
async function requestsOf(source) {
  const page = await open();
  const requests = [];
  page.on('request', (request) => requests.push(new URL(request.url()).pathname));
  const found = await page.evaluate(
    async ({ source, points }) => {
      const { delaunay3d } = await import(source);
      const { stats } = await delaunay3d(points);
      return { thread: stats.thread, whyInlined: stats.whyInlined };
    },
    { source, points: TETRAHEDRON },
  );
  const files = requests.filter((path) => path.startsWith('/gdel/')).sort();
  await page.close();
  return { files, ...found };
}

test('a page downloads what it uses, and no copies', async () => {
  assert.deepEqual(await requestsOf('/gdel/index.js'), {
    files: ['/gdel/gdel-3d.wasm', '/gdel/index.js', '/gdel/worker-3d.js'],
    thread: 'worker',
    whyInlined: null,
  });
});

test('with the inlined build, a page downloads what it uses, and only JavaScript', async () => {
  assert.deepEqual(await requestsOf('/gdel/inline.js'), {
    files: ['/gdel/inline-3d.js', '/gdel/inline-worker-3d.js', '/gdel/inline.js'],
    thread: 'worker',
    whyInlined: 'gdel-wasm/inline was imported',
  });
});

test('an abort takes effect at once, and the triangulator keeps working', async () => {
  const page = await open();
  const found = await page.evaluate(async (tetrahedron) => {
    const { delaunay3d, generate } = await import('/gdel/index.js');
    const { abortOf } = await import('/tests/abort.mjs');
    const points = await generate('uniform', 200_000);
    const aborted = await abortOf(
      (options) => delaunay3d(points, { backend: 'cpu', ...options }),
      'insert',
    );
    return { ...aborted, next: (await delaunay3d(tetrahedron)).tetrahedra.length };
  }, TETRAHEDRON);
  assert.deepEqual(found, { code: 'ABORTED', atOnce: true, next: 4 });
  await page.close();
});

test('50 runs need no more memory than a few', async () => {
  const page = await open();
  // By one backend: a GPU would take over once its kernels are compiled, and needs more at once.
  const bytes = await page.evaluate(async () => {
    const { delaunay3d, generate } = await import('/gdel/index.js');
    const points = await generate('uniform', 10_000);
    const bytes = [];
    for (let i = 0; i < 50; i++)
      bytes.push((await delaunay3d(points, { backend: 'cpu' })).stats.wasmBytes);
    return bytes;
  });
  assert.equal(bytes.at(-1), bytes[2]);
  await page.close();
});

testPages(() => browser, folders);
