// Builds the package into web/dist: WebAssembly by wasm-pack, JavaScript by esbuild, declarations
// by tsc.

import { execFileSync } from 'node:child_process';
import {
  cpSync,
  existsSync,
  mkdirSync,
  readFileSync,
  rmSync,
  statSync,
  writeFileSync,
} from 'node:fs';
import { homedir } from 'node:os';
import { delimiter, dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import * as esbuild from 'esbuild';

const web = dirname(fileURLToPath(import.meta.url));
const root = dirname(web);
const dist = join(web, 'dist');
const pkg = (name) => join(web, 'pkg', name);

/** The wasm modules, each a feature of the crate in `wasm`, and their files in the package. */
const MODULES = { d3: 'gdel-3d.wasm', d2: 'gdel-2d.wasm', tools: 'gdel-tools.wasm' };

const say = (text) => console.log(`build: ${text}`);
// wasm-bindgen is there; wasm-opt is that of the npm package binaryen, since Debian's is too old
// for what rustc emits.
const PATH = [
  join(root, '.cache/tools/bin'),
  join(root, 'node_modules/.bin'),
  process.env.PATH,
].join(delimiter);
// Panic messages name source files, which should not depend on the folders of this machine.
const sources = { gdel: root, cargo: process.env.CARGO_HOME ?? join(homedir(), '.cargo') };
const remapped = Object.entries(sources).map(
  ([name, folder]) => `--remap-path-prefix=${folder}=${name}`,
);
const given =
  process.env.CARGO_ENCODED_RUSTFLAGS?.split('\x1f') ?? process.env.RUSTFLAGS?.split(/\s+/) ?? [];
const CARGO_ENCODED_RUSTFLAGS = [...given, ...remapped].filter(Boolean).join('\x1f');
const env = { ...process.env, PATH, CARGO_ENCODED_RUSTFLAGS };
const run = (command, args) =>
  execFileSync(command, args, { cwd: root, stdio: ['ignore', 'inherit', 'inherit'], env });

function buildWasm() {
  for (const name of Object.keys(MODULES)) {
    say(`${name}: wasm-pack`);
    const packing = ['--profile', 'wasm', '--target', 'web', '--no-pack', '--no-typescript'];
    const to = ['--out-dir', pkg(name), '--out-name', 'gdel'];
    const args = ['build', '--mode', 'no-install', ...packing, ...to, join(web, 'wasm')];
    const cargo = ['--locked', '--features', name];
    run('wasm-pack', ['--log-level', 'warn', ...args, '--', ...cargo]);
  }
}

/**
 * Turns wasm-bindgen's glue, which keeps its instance in module variables, into a function. Each
 * call of it has an instance of its own, and sees the global object that it is passed.
 */
const glue = {
  name: 'glue',
  setup(build) {
    build.onResolve({ filter: /^glue:/ }, ({ path }) => ({
      path: path.slice('glue:'.length),
      namespace: 'glue',
    }));
    build.onLoad({ filter: /.*/, namespace: 'glue' }, async ({ path }) => {
      const { outputFiles } = await esbuild.build({
        entryPoints: [join(pkg(path), 'gdel.js')],
        bundle: true,
        write: false,
        format: 'cjs',
        target: 'es2022',
        minify: true,
        // Only the asynchronous initialisation uses it, and nobody calls that.
        define: { 'import.meta.url': '""' },
      });
      const [{ text }] = outputFiles;
      // wgpu distinguishes errors by these classes, which are not globals everywhere.
      const classes = ['GPUValidationError', 'GPUOutOfMemoryError'].map(
        (name) =>
          `const ${name} = { [Symbol.hasInstance]: (e) => e?.constructor?.name === '${name}' };`,
      );
      const contents = `export default function (globalThis) { const module = { exports: {} }; ${classes.join(' ')}\n${text}\nreturn module.exports; }`;
      return { contents, loader: 'js' };
    });
  },
};

/** Imports files as text: the compressed wasm modules in base64, and the bundled worker. */
const inlined = {
  name: 'inlined',
  setup(build) {
    build.onResolve({ filter: /^(base64|text):/ }, ({ path }) => ({ path, namespace: 'inlined' }));
    build.onLoad({ filter: /.*/, namespace: 'inlined' }, ({ path }) => {
      const name = path.slice(path.indexOf(':') + 1);
      if (name === 'worker')
        return { contents: readFileSync(join(dist, 'worker.js'), 'utf8'), loader: 'text' };
      const compressed = gzipSync(readFileSync(join(dist, MODULES[name])), { level: 9 });
      return { contents: compressed.toString('base64'), loader: 'text' };
    });
  },
};

async function bundle(entry, outfile, options = {}) {
  await esbuild.build({
    entryPoints: [join(web, 'src', entry)],
    outfile: join(dist, outfile),
    bundle: true,
    format: 'esm',
    target: 'es2022',
    legalComments: 'none',
    // Names stay: those of classes are visible in consoles and debuggers.
    minifySyntax: true,
    minifyWhitespace: true,
    plugins: [glue, inlined],
    // These stay files of their own.
    external: ['./worker.js', 'node:*'],
    ...options,
  });
  // On a line of its own, where tools that recognise ES modules by patterns find it.
  const file = join(dist, outfile);
  writeFileSync(file, readFileSync(file, 'utf8').replace(/export\{[^{}]*\};\s*$/, '\n$&'));
}

async function buildJs() {
  rmSync(dist, { recursive: true, force: true });
  mkdirSync(dist);
  for (const [name, file] of Object.entries(MODULES))
    cpSync(join(pkg(name), 'gdel_bg.wasm'), join(dist, file));
  say('JavaScript: esbuild');
  const runtime = (name) => ({ alias: { '#runtime': join(web, 'src', `runtime-${name}.ts`) } });
  await bundle('worker.ts', 'worker.js');
  await bundle('worker-node.ts', 'worker-node.js');
  await bundle('index.ts', 'index.js', runtime('web'));
  await bundle('index.ts', 'node.js', runtime('node'));
  await bundle('index.ts', 'inline.js', { ...runtime('inline'), external: [] });
  // The class is that of the main entry, so that both can be imported side by side.
  for (const [name, main] of [
    ['delaunator', 'index'],
    ['delaunator-node', 'node'],
  ]) {
    const entry = `export { Delaunator, Delaunator as default, GdelError } from './${main}.js';\n`;
    writeFileSync(join(dist, `${name}.js`), entry);
  }
  say('declarations: tsc');
  run(process.execPath, [join(root, 'node_modules/typescript/bin/tsc'), '--project', web]);
  // The three builds have one interface.
  cpSync(join(dist, 'index.d.ts'), join(dist, 'inline.d.ts'));
  for (const file of ['LICENSE-MIT', 'LICENSE-APACHE']) cpSync(join(root, file), join(web, file));
}

function reportSizes() {
  const kilobytes = (file) =>
    (gzipSync(readFileSync(join(dist, file)), { level: 9 }).length / 1e3).toFixed(1);
  for (const file of [...Object.values(MODULES), 'index.js', 'worker.js', 'node.js', 'inline.js']) {
    say(`${file}: ${statSync(join(dist, file)).size} bytes, ${kilobytes(file)} kB gzipped`);
  }
}

if (!process.argv.includes('--js') || !existsSync(pkg('tools'))) buildWasm();
await buildJs();
reportSizes();
