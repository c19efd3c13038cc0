// The packed package in the tools that people use: bundlers, a plain script, TypeScript.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { nodeResolve } from '@rollup/plugin-node-resolve';
import * as esbuild from 'esbuild';
import { rollup } from 'rollup';
import * as vite from 'vite';
import webpack from 'webpack';
import { launchChromium } from './browsers.mjs';
import { dist, project, root } from './package.mjs';
import { serve } from './server.mjs';

const MAIN = (source) => `
  import { delaunay3d } from '${source}';
  const points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]];
  delaunay3d(points).then(async (mesh) => {
    const { thread, whyInlined } = mesh.stats;
    globalThis.result = { tetrahedra: mesh.tetrahedra.length / 4, thread, lost: whyInlined !== null, ply: (await mesh.toPLY()).length > 0 };
  }, (error) => {
    globalThis.result = String(error);
  });`;
const PAGE = (script) =>
  `<!doctype html><title>test</title><script type="module" src="${script}"></script>`;
/** No machine needs nearly as long. */
const HANG = 300_000;

const EXPECTED = { tetrahedra: 2, thread: 'worker', lost: false, ply: true };

let browser;
before(async () => {
  browser = await launchChromium();
});
after(() => browser.close());

/** What the page at `url` finds. */
async function resultAt(url) {
  const page = await browser.newPage();
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

/** Bundles `main.js` of a folder by esbuild into the folder `out`. */
async function bundled(folder, options) {
  const { metafile } = await esbuild.build({
    entryPoints: [join(folder, 'main.js')],
    bundle: true,
    format: 'esm',
    outdir: join(folder, 'out'),
    metafile: true,
    logLevel: 'error',
    logOverride: { 'empty-import-meta': 'silent' },
    ...options,
  });
  return Object.keys(metafile.inputs).map((path) => path.split('/').at(-1));
}

const LOST = { ...EXPECTED, lost: true };

test('esbuild, with chunks: what is not found by its URL comes from a chunk of its own', async () => {
  const folder = project({ 'main.js': MAIN('gdel-wasm'), 'index.html': PAGE('./out/main.js') });
  await bundled(folder, { splitting: true });
  assert.deepEqual(await resultIn(folder, 'index.html'), LOST);
});

test('esbuild, into one file, holds what is used and nothing else', async () => {
  const folder = project({ 'main.js': MAIN('gdel-wasm'), 'index.html': PAGE('./out/main.js') });
  const inputs = await bundled(folder);
  assert.ok(inputs.includes('inline-3d.js') && inputs.includes('inline-tools.js'));
  const output = readFileSync(join(folder, 'out/main.js'), 'utf8');
  assert.ok(!output.includes('inline-2d.js'), 'the 2D module is in the bundle');
  assert.deepEqual(await resultIn(folder, 'index.html'), LOST);
});

test('esbuild, into a classic script, also from a file of the disk', async () => {
  const folder = project({
    'main.js': MAIN('gdel-wasm'),
    'index.html': '<!doctype html><title>test</title><script src="./out/main.js"></script>',
  });
  await bundled(folder, { format: 'iife' });
  assert.deepEqual(await resultIn(folder, 'index.html'), LOST);
  assert.deepEqual(await resultAt(pathToFileURL(join(folder, 'index.html')).href), LOST);
});

test('a bundle of the delaunator class alone holds the 2D module alone', async () => {
  const folder = project({
    'main.js': `
      import Delaunator from 'gdel-wasm/delaunator';
      Delaunator.load().then(() => {
        globalThis.result = Delaunator.from([[0, 0], [1, 0], [0, 1]]).triangles.length;
      }, (error) => { globalThis.result = String(error); });`,
    'index.html': PAGE('./out/main.js'),
  });
  await bundled(folder, { minify: true });
  assert.equal(await resultIn(folder, 'index.html'), 3);
  const { length } = readFileSync(join(folder, 'out/main.js'));
  const sizes = ['inline-2d.js', 'core-2d.js', 'index.js'].map(
    (file) => readFileSync(join(dist(folder), file)).length,
  );
  assert.ok(length < sizes.reduce((a, b) => a + b), `${length} bytes`);
});

test('delaunator is replaced by one line of configuration', async () => {
  const source = `
    import Delaunator from 'delaunator';
    (Delaunator.load?.() ?? Promise.reject('this is delaunator')).then(() => {
      globalThis.result = Delaunator.from([[0, 0], [1, 0], [0, 1]]).duplicateOf.length;
    }, (error) => { globalThis.result = String(error); });`;
  const folder = project({ 'main.js': source, 'index.html': PAGE('./main.js') });
  await bundled(folder, {
    alias: { delaunator: 'gdel-wasm/delaunator' },
    outdir: join(folder, 'a'),
  });
  writeFileSync(join(folder, 'a.html'), PAGE('./a/main.js'));
  assert.equal(await resultIn(folder, 'a.html'), 3);
  await vite.build({
    root: folder,
    base: './',
    configFile: false,
    logLevel: 'error',
    resolve: { alias: { delaunator: 'gdel-wasm/delaunator' } },
  });
  assert.equal(await resultIn(join(folder, 'dist'), 'index.html'), 3);
});

for (const [name, plugins, options] of [
  ['Rollup, with chunks', [nodeResolve()], {}],
  ['Rollup, with chunks, for browsers', [nodeResolve({ browser: true })], {}],
  ['Rollup, into one file', [nodeResolve()], { inlineDynamicImports: true }],
]) {
  test(name, async () => {
    const folder = project({ 'main.js': MAIN('gdel-wasm'), 'index.html': PAGE('./out/main.js') });
    const warnings = [];
    const bundle = await rollup({
      input: join(folder, 'main.js'),
      plugins,
      onwarn: ({ message }) => warnings.push(message),
    });
    await bundle.write({ dir: join(folder, 'out'), format: 'es', ...options });
    await bundle.close();
    assert.deepEqual(warnings, []);
    assert.deepEqual(await resultIn(folder, 'index.html'), LOST);
  });
}

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
      import { type BallComplex, createTriangulator, delaunay2dSync, delaunay3d, delaunay3dSync, GdelError, generate, load3d, type Mesh3, type Stats } from 'gdel-wasm';
      import { delaunay3d as inlined } from 'gdel-wasm/inline';
      import Delaunator from 'gdel-wasm/delaunator';
      const mesh: Mesh3 = await delaunay3d(new Float32Array(3), { outputs: ['hull'], onProgress: ({ fraction }) => fraction.toFixed() });
      const bytes: Uint8Array = await mesh.toVTU();
      new Blob([await mesh.toGLB(), mesh.tetrahedra, mesh.points]);
      postMessage(mesh.points, '*', [mesh.points.buffer, (await generate('ball', 3)).buffer]);
      await delaunay3d([0, 0, 0]);
      await delaunay3d(new Int16Array(3), { onProgress: () => {} });
      const balls: BallComplex = await mesh.ballComplex({ alpha: 1, radii: [1], signal: new AbortController().signal });
      const componentOf: Int32Array = balls.componentOf;
      // @ts-expect-error: alpha is a number here
      await mesh.ballComplex({ alpha: 'auto' });
      await load3d();
      const triangles: Uint32Array = delaunay2dSync(new Uint8Array(2)).triangles;
      const sync: Mesh3 = delaunay3dSync([{ x: 1 }], { point: ({ x }) => [x, 0, 0] });
      // @ts-expect-error: options are an object
      await delaunay3d([], 'cpu');
      // @ts-expect-error: synchronous functions cannot be aborted
      delaunay3dSync([], { signal: new AbortController().signal });
      await delaunay3d([{ x: 1, y: 2, z: 3 }], { point: ({ x, y, z }) => [x, y, z] });
      await inlined([[1, 2, 3]] as const);
      const { gpu }: Stats = mesh.stats;
      const halfedges: Int32Array = Delaunator.from([[0, 0], [1, 0], [0, 1]]).halfedges;
      using triangulator = await createTriangulator({ backend: 'cpu' });
      await triangulator.delaunay3d(await generate('ball', 10, { seed: 3 }), { signal: new AbortController().signal });
      try { await delaunay3d([]); } catch (error) { if (error instanceof GdelError && error.code === 'ABORTED') console.log(gpu, bytes, componentOf, halfedges, triangles, sync); }
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
    'docs',
    'package.json',
  ]);
  const files = readdirSync(folder);
  const ofModules = ['3d', '2d', 'edit', 'tools', 'derived', 'surface', 'transport'].flatMap(
    (module) => [
      `gdel-${module}.wasm`,
      `core-${module}.js`,
      `core-${module}.cjs`,
      `worker-${module}.js`,
      `inline-${module}.js`,
      `inline-worker-${module}.js`,
    ],
  );
  for (const file of [
    ...ofModules,
    'index.js',
    'index.cjs',
    'inline.js',
    'delaunator.js',
    'delaunator.cjs',
    'index.d.ts',
    'index.d.cts',
    'inline.d.ts',
    'delaunator.d.ts',
    'delaunator.d.cts',
  ]) {
    assert.ok(files.includes(file), file);
  }
  assert.ok(createRequire(import.meta.url).resolve('gdel-wasm/package.json'));
});
