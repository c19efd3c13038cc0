// Builds the package into web/dist: WebAssembly by wasm-pack, JavaScript by esbuild and terser,
// declarations by tsc.

import { execFileSync } from 'node:child_process';
import {
  cpSync,
  existsSync,
  mkdirSync,
  readdirSync,
  readFileSync,
  renameSync,
  rmSync,
  statSync,
  writeFileSync,
} from 'node:fs';
import { homedir } from 'node:os';
import { delimiter, dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import * as esbuild from 'esbuild';
import { minify } from 'terser';

const web = dirname(fileURLToPath(import.meta.url));
const root = dirname(web);
const dist = join(web, 'dist');
const pkg = (name) => join(web, 'pkg', name);

/** The wasm modules, each a feature of the crate in `wasm`, and their names in those of files. */
const MODULES = {
  d3: '3d',
  d2: '2d',
  edit: 'edit',
  tools: 'tools',
  derived: 'derived',
  surface: 'surface',
  transport: 'transport',
};

/**
 * The modules whose work is done by generic functions, which are compiled with the bindings. For speed they take half to
 * two thirds of the time, and are 10 to 20 % larger.
 */
const FOR_SPEED = ['derived', 'surface', 'transport'];

/** The entries beside the main one, most of which have the interfaces of other packages. */
const INTERFACES = [
  'cdt2d',
  'constrainautor',
  'd3-voronoi-map',
  'd3-voronoi-treemap',
  'd3-weighted-voronoi',
  'earcut',
  'tin',
  'treemap',
];

const say = (text) => console.log(`build: ${text}`);
// wasm-bindgen is there; wasm-opt is that of the npm package binaryen, since Debian's is too old
// for what rustc emits.
const PATH = [
  join(process.env.XDG_CACHE_HOME ?? join(homedir(), '.cache'), 'gdel-tools/bin'),
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
const env = { ...process.env, PATH };
const run = (command, args, more) =>
  execFileSync(command, args, {
    cwd: root,
    stdio: ['ignore', 'inherit', 'inherit'],
    env: { ...env, ...more },
  });

/** WebAssembly and JavaScript of different versions do not fit, since this names what is imported. */
const { version } = JSON.parse(readFileSync(join(web, 'package.json'), 'utf8'));
const OUT_NAME = `gdel_${version.replaceAll(/\W/g, '_')}`;

function buildWasm() {
  for (const name of Object.keys(MODULES)) {
    say(`${name}: wasm-pack`);
    rmSync(pkg(name), { recursive: true, force: true });
    const packing = ['--profile', 'wasm', '--target', 'web', '--no-pack'];
    const to = ['--out-dir', pkg(name), '--out-name', OUT_NAME];
    const args = ['build', '--mode', 'no-install', ...packing, ...to, join(web, 'wasm')];
    const cargo = ['--locked', '--features', name];
    if (FOR_SPEED.includes(name))
      cargo.push('--config', 'profile.wasm.package.gdel-web.opt-level=2');
    run('wasm-pack', ['--log-level', 'warn', ...args, '--', ...cargo], { CARGO_ENCODED_RUSTFLAGS });
    for (const file of ['.js', '.d.ts', '_bg.wasm'])
      renameSync(join(pkg(name), OUT_NAME + file), join(pkg(name), `gdel${file}`));
  }
}

/**
 * What wasm-bindgen's JavaScript needs beside a global object: the classes by which wgpu tells errors apart,
 * which are not globals everywhere, and what jsdom does not have, but Node below it does.
 */
const NEEDED = [
  ...['GPUValidationError', 'GPUOutOfMemoryError'].map(
    (name) =>
      `const ${name} = { [Symbol.hasInstance]: (e) => e?.constructor?.name === '${name}' };`,
  ),
  "const { TextDecoder, TextEncoder } = globalThis.TextDecoder ? globalThis : globalThis.process.getBuiltinModule('node:util');",
];

/**
 * Resolves `glue:d3` to a function that holds what wasm-bindgen has written for that module, and returns its
 * exports: each call has a state of its own. wasm-bindgen looks for the global object under both names.
 */
const glue = {
  name: 'glue',
  setup(build) {
    build.onResolve({ filter: /^glue:/ }, ({ path }) => ({ path, namespace: 'glue' }));
    build.onLoad({ filter: /.*/, namespace: 'glue' }, async ({ path }) => {
      const { outputFiles } = await esbuild.build({
        // Without the default, which fetches the module.
        stdin: { contents: "export * from './gdel.js';", resolveDir: pkg(path.slice(5)) },
        bundle: true,
        write: false,
        format: 'iife',
        globalName: 'glue',
        target: 'es2022',
      });
      const body = [...NEEDED, outputFiles[0].text, 'return glue;'].join('\n');
      return { contents: `export default (globalThis, self = globalThis) => {\n${body}\n};` };
    });
  },
};

/** Leaves the modules that hold copies files of their own, which are loaded when they are needed. */
const copies = {
  name: 'copies',
  setup(build) {
    build.onResolve({ filter: /^(base64|text):/ }, ({ path }) => {
      const [kind, name] = path.split(':');
      const copy = kind === 'text' ? 'inline-worker' : 'inline';
      return { path: `./${copy}-${MODULES[name]}.js`, external: true };
    });
  },
};

/** The modules with copies: compressed and in base64, or the text of a bundled worker. */
function writeCopies() {
  const copy = (file, content) =>
    writeFileSync(join(dist, file), `export default ${JSON.stringify(content)};\n`);
  for (const name of Object.values(MODULES)) {
    const wasm = readFileSync(join(dist, `gdel-${name}.wasm`));
    copy(`inline-${name}.js`, gzipSync(wasm, { level: 9 }).toString('base64'));
    copy(`inline-worker-${name}.js`, readFileSync(join(dist, `worker-${name}.js`), 'utf8'));
  }
}

async function bundle(entry, outfile, { plugins = [], define = {}, ...options } = {}) {
  const target = 'es2022';
  const { outputFiles } = await esbuild.build({
    entryPoints: [join(web, 'src', entry)],
    outfile: join(dist, outfile),
    write: false,
    bundle: true,
    format: 'esm',
    target,
    legalComments: 'none',
    plugins: [glue, copies, ...plugins],
    define: { VERSION: JSON.stringify(version), ...define },
    ...options,
  });
  // Minified as a script, whose names at the top level stay: those of functions and classes are
  // visible in consoles, debuggers and stack traces. The exports come on a line of their own, where
  // tools that recognise ES modules by patterns find them.
  const [{ text }] = outputFiles;
  const [exports] = /^export \{[^{}]*\};$/m.exec(text) ?? [''];
  const script = text.replace(exports, '');
  // The names that esbuild chooses take 3 % more, gzipped; terser does not shorten those of private members.
  const shorter = await esbuild.transform(script, { minify: true, target, legalComments: 'none' });
  const { code } = await minify(shorter.code, { ecma: 2022, compress: { passes: 2 } });
  writeFileSync(join(dist, outfile), `${code}\n${exports.replace(/\s+/g, ' ')}\n`);
}

/** An entry, whose assets are those of `src/assets*.ts`. */
const withAssets = (name, ...others) => ({
  alias: { '#assets': join(web, `src/${name}.ts`) },
  plugins: others,
});

/** Leaves the tasks of each module a file of their own, for the calling thread. */
const taskCode = (extension) => ({
  name: 'task-code',
  setup(build) {
    build.onResolve({ filter: /^\.\/core-\w+\.js$/ }, ({ path, kind }) =>
      kind === 'dynamic-import'
        ? { path: path.replace(/js$/, extension), external: true }
        : undefined,
    );
  },
});

/** Builds an entry that imports the main one. */
async function buildInterface(name) {
  for (const [extension, format] of Object.entries({ js: 'esm', cjs: 'cjs' })) {
    const path = `./index.${extension}`;
    const mainEntry = {
      name: 'main-entry',
      setup: (build) =>
        build.onResolve({ filter: /^\.\/index\.js$/ }, () => ({ path, external: true })),
    };
    await esbuild.build({
      entryPoints: [join(web, 'src', `${name}.ts`)],
      outfile: join(dist, `${name}.${extension}`),
      bundle: true,
      minify: true,
      keepNames: true,
      format,
      target: 'es2022',
      plugins: [mainEntry],
    });
  }
}

/** For `require`: dynamic imports become calls of it, and the URL of the file is known. */
const COMMON_JS = {
  format: 'cjs',
  supported: { 'dynamic-import': false },
  define: { 'import.meta.url': 'FILE_URL' },
  banner: { js: "const FILE_URL = require('node:url').pathToFileURL(__filename).href;" },
};

async function buildJs() {
  rmSync(dist, { recursive: true, force: true });
  mkdirSync(dist);
  say('JavaScript: esbuild');
  for (const [module, name] of Object.entries(MODULES)) {
    cpSync(join(pkg(module), 'gdel_bg.wasm'), join(dist, `gdel-${name}.wasm`));
    const core = `core-${name}`;
    await bundle('worker.ts', `worker-${name}.js`, {
      alias: { '#core': join(web, `src/${core}.ts`) },
      define: { IN_WORKER: 'true' },
    });
    const define = { IN_WORKER: 'false' };
    await bundle(`${core}.ts`, `${core}.js`, { define });
    await bundle(`${core}.ts`, `${core}.cjs`, { define, format: 'cjs' });
  }
  writeCopies();
  await bundle('index.ts', 'index.js', withAssets('assets', taskCode('js')));
  await bundle('index.ts', 'inline.js', withAssets('assets-inline', taskCode('js')));
  const require = { ...withAssets('assets-cjs', taskCode('cjs')), ...COMMON_JS };
  await bundle('index.ts', 'index.cjs', require);
  // The class is that of the main entry, so that both can be imported side by side.
  const names = 'Delaunator, Delaunator as default, GdelError';
  writeFileSync(join(dist, 'delaunator.js'), `export { ${names} } from './index.js';\n`);
  writeFileSync(join(dist, 'delaunator.cjs'), DELAUNATOR_CJS);
  for (const name of INTERFACES) await buildInterface(name);
  say('declarations: tsc');
  run(process.execPath, [join(root, 'node_modules/typescript/bin/tsc'), '--project', web]);
  // The builds have one interface.
  cpSync(join(dist, 'index.d.ts'), join(dist, 'inline.d.ts'));
  for (const file of readdirSync(dist).filter((name) => name.endsWith('.d.ts'))) {
    const text = readFileSync(join(dist, file), 'utf8').replace(/(from '\.\/\w+)\.js'/g, "$1.cjs'");
    writeFileSync(join(dist, file.replace(/ts$/, 'cts')), text);
  }
  for (const file of ['LICENSE-MIT', 'LICENSE-APACHE']) cpSync(join(root, file), join(web, file));
  for (const name of ['answers.md', 'answers'])
    cpSync(join(root, 'docs', name), join(web, 'docs', name), { recursive: true });
}

/** As compilers to CommonJS expect a module with a default export. */
const DELAUNATOR_CJS = `'use strict';
const { Delaunator, GdelError } = require('./index.cjs');
Object.defineProperty(exports, '__esModule', { value: true });
exports.default = exports.Delaunator = Delaunator;
exports.GdelError = GdelError;
`;

function reportSizes() {
  const kilobytes = (file) =>
    (gzipSync(readFileSync(join(dist, file)), { level: 9 }).length / 1e3).toFixed(1);
  for (const file of readdirSync(dist).filter((name) => /\.(wasm|js|cjs)$/.test(name))) {
    say(`${file}: ${statSync(join(dist, file)).size} bytes, ${kilobytes(file)} kB gzipped`);
  }
}

if (!process.argv.includes('--js') || !Object.keys(MODULES).every((name) => existsSync(pkg(name))))
  buildWasm();
await buildJs();
reportSizes();
