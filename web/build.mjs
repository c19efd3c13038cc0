// Builds the package into web/dist: wasm by cargo and wasm-bindgen, JavaScript by esbuild, declarations by tsc.

import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
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

/** The wasm modules: the feature of the crate, and the file in the package. */
const MODULES = {
  engine: { feature: 'wasm-engine', file: 'gdel.wasm' },
  plane: { feature: 'wasm-plane', file: 'gdel-plane.wasm' },
  tools: { feature: 'wasm-tools', file: 'gdel-tools.wasm' },
};

const say = (text) => console.log(`build: ${text}`);
// wasm-bindgen from there, and wasm-opt from the npm package binaryen: Debian's does not know what rustc emits.
const PATH = [
  join(root, '.cache/tools/bin'),
  join(root, 'node_modules/.bin'),
  process.env.PATH,
].join(delimiter);
// Messages of panics name source files, but not where they lie on this machine.
const sources = { gdel: root, cargo: process.env.CARGO_HOME ?? join(homedir(), '.cargo') };
const remapped = Object.entries(sources).map(
  ([name, folder]) => `--remap-path-prefix=${folder}=${name}`,
);
const given =
  process.env.CARGO_ENCODED_RUSTFLAGS?.split('\x1f') ?? process.env.RUSTFLAGS?.split(/\s+/) ?? [];
const CARGO_ENCODED_RUSTFLAGS = [...given, ...remapped].filter(Boolean).join('\x1f');
const env = { ...process.env, PATH, CARGO_ENCODED_RUSTFLAGS };
const options = { cwd: root, stdio: ['ignore', 'inherit', 'inherit'], env };

async function run(command, args) {
  const [status] = await once(spawn(command, args, options), 'exit');
  if (status !== 0) throw new Error(`${command} failed`);
}

async function buildWasm() {
  const metadata = execFileSync('cargo', ['metadata', '--no-deps', '--format-version=1'], {
    cwd: root,
    env,
  });
  const compiled = join(
    JSON.parse(metadata).target_directory,
    'wasm32-unknown-unknown/wasm/gdel.wasm',
  );
  const finishing = [];
  for (const [name, { feature }] of Object.entries(MODULES)) {
    say(`${name}: cargo`);
    await run('cargo', [
      'build',
      '--lib',
      '--locked',
      '--profile',
      'wasm',
      '--target',
      'wasm32-unknown-unknown',
      '--no-default-features',
      '--features',
      feature,
    ]);
    rmSync(pkg(name), { recursive: true, force: true });
    mkdirSync(pkg(name), { recursive: true });
    cpSync(compiled, join(pkg(name), 'gdel.wasm'));
    // On the processors that the compiler of the next module leaves free.
    finishing.push(finishWasm(name));
  }
  await Promise.all(finishing);
}

/** The JavaScript for a compiled module, and the module made smaller and faster. */
async function finishWasm(name) {
  const at = (file) => join(pkg(name), file);
  await run('wasm-bindgen', [
    at('gdel.wasm'),
    '--out-dir',
    pkg(name),
    '--out-name',
    'gdel',
    '--target',
    'web',
    '--no-typescript',
    '--omit-default-module-path',
  ]);
  await run('wasm-opt', [at('gdel_bg.wasm'), '-o', at('gdel_bg.wasm'), '-O3']);
}

/** The glue of wasm-bindgen keeps its instance in module variables. Here it becomes a function, of which each call has its
 * own, and which sees the global object that it is given. */
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
        // Used by the asynchronous initialisation only, which nobody calls.
        define: { 'import.meta.url': '""' },
      });
      const [{ text }] = outputFiles;
      // wgpu tells errors apart by these classes, which not every environment has as globals.
      const classes = ['GPUValidationError', 'GPUOutOfMemoryError'].map(
        (name) =>
          `const ${name} = { [Symbol.hasInstance]: (e) => e?.constructor?.name === '${name}' };`,
      );
      const contents = `export default function (globalThis) { const module = { exports: {} }; ${classes.join(' ')}\n${text}\nreturn module.exports; }`;
      return { contents, loader: 'js' };
    });
  },
};

/** Files as text: the wasm modules, compressed, in base64, and the bundled worker. */
const inlined = {
  name: 'inlined',
  setup(build) {
    build.onResolve({ filter: /^(base64|text):/ }, ({ path }) => ({ path, namespace: 'inlined' }));
    build.onLoad({ filter: /.*/, namespace: 'inlined' }, ({ path }) => {
      const name = path.slice(path.indexOf(':') + 1);
      if (name === 'worker')
        return { contents: readFileSync(join(dist, 'worker.js'), 'utf8'), loader: 'text' };
      const compressed = gzipSync(readFileSync(join(dist, MODULES[name].file)), { level: 9 });
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
    // Not the names: those of classes are seen in consoles and debuggers.
    minifySyntax: true,
    minifyWhitespace: true,
    plugins: [glue, inlined],
    // Files of the package that stay files of their own.
    external: ['./worker.js', 'node:*'],
    ...options,
  });
  // On a line of its own, where tools find it that tell ES modules by patterns.
  const file = join(dist, outfile);
  writeFileSync(file, readFileSync(file, 'utf8').replace(/export\{[^{}]*\};\s*$/, '\n$&'));
}

async function buildJs() {
  rmSync(dist, { recursive: true, force: true });
  mkdirSync(dist);
  for (const [name, { file }] of Object.entries(MODULES))
    cpSync(join(pkg(name), 'gdel_bg.wasm'), join(dist, file));
  say('JavaScript: esbuild');
  const runtime = (name) => ({ alias: { '#runtime': join(web, 'src', `runtime-${name}.ts`) } });
  await bundle('worker.ts', 'worker.js');
  await bundle('worker-node.ts', 'worker-node.js');
  await bundle('index.ts', 'index.js', runtime('web'));
  await bundle('index.ts', 'node.js', runtime('node'));
  await bundle('index.ts', 'inline.js', { ...runtime('inline'), external: [] });
  say('declarations: tsc');
  await run(process.execPath, [join(root, 'node_modules/typescript/bin/tsc'), '--project', web]);
  // The three builds have one interface.
  cpSync(join(dist, 'index.d.ts'), join(dist, 'inline.d.ts'));
  for (const file of ['LICENSE-MIT', 'LICENSE-APACHE']) cpSync(join(root, file), join(web, file));
}

function reportSizes() {
  const kilobytes = (file) =>
    (gzipSync(readFileSync(join(dist, file)), { level: 9 }).length / 1e3).toFixed(1);
  for (const file of [
    ...Object.values(MODULES).map(({ file }) => file),
    'index.js',
    'worker.js',
    'node.js',
    'inline.js',
  ]) {
    say(`${file}: ${statSync(join(dist, file)).size} bytes, ${kilobytes(file)} kB gzipped`);
  }
}

if (!process.argv.includes('--js') || !existsSync(pkg('tools'))) await buildWasm();
await buildJs();
reportSizes();
