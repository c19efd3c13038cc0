// Builds the package into web/dist: WebAssembly by wasm-pack, JavaScript by esbuild and terser,
// declarations by tsc.

import { execFileSync } from 'node:child_process';
import {
  cpSync,
  existsSync,
  mkdirSync,
  readdirSync,
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
import { minify } from 'terser';
import { gluePlugin, importNames } from './glue.mjs';
import { renameImports } from './imports.mjs';

const web = dirname(fileURLToPath(import.meta.url));
const root = dirname(web);
const dist = join(web, 'dist');
const pkg = (name) => join(web, 'pkg', name);

/** The wasm modules, each a feature of the crate in `wasm`, and their files in the package. */
const MODULES = {
  d3: 'gdel-3d.wasm',
  d2: 'gdel-2d.wasm',
  edit: 'gdel-edit.wasm',
  tools: 'gdel-tools.wasm',
  derived: 'gdel-derived.wasm',
};

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
const env = { ...process.env, PATH };
const run = (command, args, more) =>
  execFileSync(command, args, {
    cwd: root,
    stdio: ['ignore', 'inherit', 'inherit'],
    env: { ...env, ...more },
  });

function buildWasm() {
  for (const name of Object.keys(MODULES)) {
    say(`${name}: wasm-pack`);
    const packing = ['--profile', 'wasm', '--target', 'web', '--no-pack', '--no-typescript'];
    const to = ['--out-dir', pkg(name), '--out-name', 'gdel'];
    const args = ['build', '--mode', 'no-install', ...packing, ...to, join(web, 'wasm')];
    const cargo = ['--locked', '--features', name];
    run('wasm-pack', ['--log-level', 'warn', ...args, '--', ...cargo], { CARGO_ENCODED_RUSTFLAGS });
  }
}

const glueFiles = Object.fromEntries(
  Object.keys(MODULES).map((name) => [name, join(pkg(name), 'gdel.js')]),
);
const glue = gluePlugin(glueFiles);

/** The module that holds a copy of a wasm module, or of the worker. */
const COPIES = {
  d3: 'inline-3d',
  d2: 'inline-2d',
  edit: 'inline-edit',
  tools: 'inline-tools',
  derived: 'inline-derived',
  worker: 'inline-worker',
};

/** Leaves the modules that hold copies files of their own, which are loaded when they are needed. */
const copies = {
  name: 'copies',
  setup(build) {
    build.onResolve({ filter: /^(base64|text):/ }, ({ path }) => ({
      path: `./${COPIES[path.slice(path.indexOf(':') + 1)]}.js`,
      external: true,
    }));
  },
};

/** The modules with copies: compressed and in base64, or the text of the bundled worker. */
function writeCopies() {
  for (const [name, copy] of Object.entries(COPIES)) {
    const content =
      name === 'worker'
        ? readFileSync(join(dist, 'worker.js'), 'utf8')
        : gzipSync(readFileSync(join(dist, MODULES[name])), { level: 9 }).toString('base64');
    writeFileSync(join(dist, `${copy}.js`), `export default ${JSON.stringify(content)};\n`);
  }
}

async function bundle(entry, outfile, { plugins = [], ...options } = {}) {
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

/** Leaves the worker's tasks a file of their own, for the calling thread. */
const taskCode = (file) => ({
  name: 'task-code',
  setup(build) {
    build.onResolve({ filter: /^\.\/core\.js$/ }, ({ kind }) =>
      kind === 'dynamic-import' ? { path: `./${file}`, external: true } : undefined,
    );
  },
});

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
  const imports = importNames(glueFiles);
  for (const [name, file] of Object.entries(MODULES)) {
    const module = readFileSync(join(pkg(name), 'gdel_bg.wasm'));
    writeFileSync(join(dist, file), renameImports(module, imports));
  }
  say('JavaScript: esbuild');
  await bundle('worker.ts', 'worker.js');
  writeCopies();
  await bundle('core.ts', 'core.js');
  await bundle('core.ts', 'core.cjs', { format: 'cjs' });
  await bundle('index.ts', 'index.js', withAssets('assets', taskCode('core.js')));
  await bundle('index.ts', 'inline.js', withAssets('assets-inline', taskCode('core.js')));
  const require = { ...withAssets('assets-cjs', taskCode('core.cjs')), ...COMMON_JS };
  await bundle('index.ts', 'index.cjs', require);
  // The class is that of the main entry, so that both can be imported side by side.
  const names = 'Delaunator, Delaunator as default, GdelError';
  writeFileSync(join(dist, 'delaunator.js'), `export { ${names} } from './index.js';\n`);
  writeFileSync(join(dist, 'delaunator.cjs'), DELAUNATOR_CJS);
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
