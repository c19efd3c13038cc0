// The packed package in the tools that people use: bundlers, a plain script, TypeScript.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readdirSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import * as esbuild from 'esbuild';
import * as vite from 'vite';
import webpack from 'webpack';
import { launchChromium } from './browsers.mjs';
import { dist, project, root } from './package.mjs';
import { serve } from './server.mjs';

const MAIN = (source) => `
  import { delaunay3d } from '${source}';
  const points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]];
  delaunay3d(points).then(async (mesh) => {
    globalThis.result = { tetrahedra: mesh.tetrahedra.length / 4, thread: mesh.stats.thread, ply: (await mesh.toPLY()).length > 0 };
  }, (error) => {
    globalThis.result = String(error);
  });`;
const PAGE = (script) =>
  `<!doctype html><title>test</title><script type="module" src="${script}"></script>`;
/** No machine needs nearly as long. */
const HANG = 300_000;

const EXPECTED = { tetrahedra: 2, thread: 'worker', ply: true };

let browser;
before(async () => {
  browser = await launchChromium();
});
after(() => browser.close());

/** What the page at `url` finds. */
async function resultAt(url) {
  const page = await browser.newPage();
  page.on('console', (message) => message.type() === 'error' && console.log(message.text()));
  await page.goto(url);
  await page.waitForFunction(() => globalThis.result, null, { polling: 50, timeout: HANG });
  const result = await page.evaluate(() => globalThis.result);
  await page.close();
  return result;
}

async function resultIn(folder, path) {
  const server = await serve({ '/site/': folder });
  try {
    return await resultAt(`${server.url}/site/${path}`);
  } finally {
    server.close();
  }
}

test('Vite 8, in development and built', async () => {
  const folder = project({ 'index.html': PAGE('/main.js'), 'main.js': MAIN('gdel-wasm') });
  const config = { root: folder, base: './', configFile: false, logLevel: 'error' };
  const server = await vite.createServer({
    ...config,
    base: '/',
    server: { port: 0, host: '127.0.0.1' },
  });
  try {
    await server.listen();
    assert.deepEqual(
      await resultAt(`http://127.0.0.1:${server.httpServer.address().port}/`),
      EXPECTED,
    );
  } finally {
    await server.close();
  }
  await vite.build(config);
  assert.deepEqual(await resultIn(join(folder, 'dist'), 'index.html'), EXPECTED);
});

test('webpack 5', async () => {
  const folder = project({ 'main.js': MAIN('gdel-wasm') });
  const out = join(folder, 'out');
  const stats = await new Promise((resolve, reject) =>
    webpack(
      {
        mode: 'production',
        context: folder,
        entry: './main.js',
        output: { path: out, publicPath: 'auto' },
        performance: false,
      },
      (error, stats) => (error ? reject(error) : resolve(stats)),
    ),
  );
  assert.ok(!stats.hasErrors() && !stats.hasWarnings(), stats.toString());
  writeFileSync(join(out, 'index.html'), PAGE('./main.js'));
  assert.deepEqual(await resultIn(out, 'index.html'), EXPECTED);
});

test('esbuild, with the inlined build', async () => {
  const folder = project({ 'main.js': MAIN('gdel-wasm/inline'), 'index.html': PAGE('./out.js') });
  await esbuild.build({
    entryPoints: [join(folder, 'main.js')],
    bundle: true,
    format: 'esm',
    outfile: join(folder, 'out.js'),
  });
  assert.deepEqual(await resultIn(folder, 'index.html'), EXPECTED);
});

test('a plain script, without a bundler', async () => {
  const folder = project({
    'index.html': PAGE('./main.js'),
    'main.js': MAIN('./node_modules/gdel-wasm/dist/index.js'),
  });
  assert.deepEqual(await resultIn(folder, 'index.html'), EXPECTED);
});

test('TypeScript, strict, with both resolutions, whatever else is switched on', () => {
  const folder = project({
    'main.ts': `
      import { createTriangulator, delaunay3d, GdelError, generate, type Mesh3, type Stats } from 'gdel-wasm';
      import { delaunay3d as inlined } from 'gdel-wasm/inline';
      import Delaunator from 'gdel-wasm/delaunator';
      const mesh: Mesh3 = await delaunay3d(new Float32Array(3), { outputs: ['hull'], onProgress: ({ fraction }) => fraction.toFixed() });
      const bytes: Uint8Array = await mesh.toVTU();
      await delaunay3d([{ x: 1, y: 2, z: 3 }], { point: ({ x, y, z }) => [x, y, z] });
      await inlined([[1, 2, 3]] as const);
      const { gpu }: Stats = mesh.stats;
      const halfedges: Int32Array = Delaunator.from([[0, 0], [1, 0], [0, 1]]).halfedges;
      using triangulator = await createTriangulator({ backend: 'cpu' });
      await triangulator.delaunay3d(await generate('ball', 10, { seed: 3 }), { signal: new AbortController().signal });
      try { await delaunay3d([]); } catch (error) { if (error instanceof GdelError && error.code === 'ABORTED') console.log(gpu, bytes, halfedges); }
      // @ts-expect-error: there is no such backend
      await delaunay3d([], { backend: 'tpu' });
      // @ts-expect-error: objects need an accessor
      await delaunay3d([{ x: 1 }]);`,
  });
  const compiler = join(root, 'node_modules/typescript/bin/tsc');
  for (const [module, moduleResolution] of [
    ['esnext', 'bundler'],
    ['node16', 'node16'],
    ['nodenext', 'nodenext'],
  ]) {
    execFileSync(
      process.execPath,
      [
        compiler,
        '--noEmit',
        '--strict',
        '--exactOptionalPropertyTypes',
        '--noUncheckedIndexedAccess',
        '--isolatedModules',
        '--target',
        'es2022',
        '--lib',
        'es2022,dom',
        '--module',
        module,
        '--moduleResolution',
        moduleResolution,
        'main.ts',
      ],
      { cwd: folder, stdio: 'inherit' },
    );
  }
});

test('every file that the package names is in it', () => {
  const folder = dist(project());
  assert.deepEqual(readdirSync(join(folder, '..')).sort(), [
    'LICENSE-APACHE',
    'LICENSE-MIT',
    'README.md',
    'dist',
    'package.json',
  ]);
  const files = readdirSync(folder);
  for (const file of [
    'index.js',
    'node.js',
    'inline.js',
    'worker.js',
    'worker-node.js',
    'delaunator.js',
    'delaunator-node.js',
    'gdel-3d.wasm',
    'gdel-2d.wasm',
    'gdel-tools.wasm',
    'index.d.ts',
    'inline.d.ts',
    'delaunator.d.ts',
  ]) {
    assert.ok(files.includes(file), file);
  }
  assert.ok(createRequire(import.meta.url).resolve('gdel-wasm/package.json'));
});
