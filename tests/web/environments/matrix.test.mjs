// The package in frameworks, bundlers and runtimes that need an installation of their own: a small
// project for each, in the folders beside this file. `npm run test:matrix` runs it. What needs none is
// in tests/web/projects.test.mjs.

import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { cpSync, existsSync, readFileSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { launchChromium } from '../browsers.mjs';
import { root, scratch, tarball } from '../package.mjs';
import { serve } from '../server.mjs';

const here = join(root, 'tests/web/environments');
/** No machine needs nearly as long. */
const HANG = 600_000;

let browser;
before(async () => {
  browser = await launchChromium();
});
after(() => browser.close());

const env = {
  ...process.env,
  NEXT_TELEMETRY_DISABLED: '1',
  NO_COLOR: '1',
  CI: '1',
  // Flags of this process, and that it is a test, concern nobody else.
  NODE_OPTIONS: '',
  NODE_TEST_CONTEXT: '',
};

/** A copy of the project in a folder beside this file, with its packages and ours installed. */
function install(name, { page = false } = {}) {
  const folder = scratch();
  cpSync(join(here, name), folder, { recursive: true });
  cpSync(join(here, 'triangulated.mjs'), join(folder, 'triangulated.mjs'));
  if (page) {
    cpSync(join(here, 'page.mjs'), join(folder, 'page.mjs'));
    cpSync(join(here, 'page.html'), join(folder, 'index.html'));
  }
  const packages = ['install', '--silent', '--no-audit', '--no-fund', tarball()];
  execFileSync('npm', packages, { cwd: folder, env, stdio: ['ignore', 'ignore', 'inherit'] });
  return folder;
}

/** Runs a program of a project to its end, and returns what it prints. */
function run(folder, file, args = [], more = {}) {
  const [command, first] = file.endsWith('js') ? [process.execPath, [file]] : [file, []];
  try {
    return execFileSync(command, [...first, ...args], {
      cwd: folder,
      env: { ...env, ...more },
      encoding: 'utf8',
      timeout: HANG,
      stdio: ['ignore', 'pipe', 'pipe'],
    });
  } catch (error) {
    throw new Error(`${error.message}\n${error.stdout}`, { cause: error });
  }
}

async function freePort() {
  const server = createServer();
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const { port } = server.address();
  await new Promise((resolve) => server.close(resolve));
  return port;
}

/** Calls `use` with the address of a program that serves, and stops it and what it started. */
async function serving(folder, file, args, use) {
  const port = await freePort();
  const child = spawn(process.execPath, [file, ...args.map((arg) => arg.replace('PORT', port))], {
    cwd: folder,
    env: { ...env, PORT: port },
    stdio: ['ignore', 'pipe', 'pipe'],
    detached: true,
  });
  let said = '';
  for (const stream of [child.stdout, child.stderr]) stream.on('data', (text) => (said += text));
  let ended = false;
  child.on('exit', () => (ended = true));
  const url = `http://localhost:${port}/`;
  try {
    while (!(await fetch(url).catch(() => null))) {
      assert.ok(!ended, said);
      await new Promise((resolve) => setTimeout(resolve, 100));
    }
    return await use(url);
  } finally {
    if (!ended) process.kill(-child.pid, 'SIGKILL');
  }
}

/** What the page at `url` says in these elements. */
async function visit(url, ...ids) {
  const page = await browser.newPage();
  try {
    await page.goto(url, { timeout: HANG });
    const found = {};
    for (const id of ids) {
      const text = await page.waitForFunction(
        (id) => document.getElementById(id)?.textContent,
        id,
        { timeout: HANG },
      );
      found[id] = JSON.parse(await text.jsonValue());
    }
    return found;
  } finally {
    await page.close();
  }
}

/** Visits the page of a folder with files. */
async function visitFiles(folder) {
  const server = await serve({ '/site/': folder });
  try {
    return await visit(`${server.url}/site/index.html`, 'client');
  } finally {
    server.close();
  }
}

const RIGHT = { tetrahedra: 2, passed: true, same: true, thread: 'worker', code: 'NOT_FINITE' };

/** The result is right, from the files that it should be from; null if either will do. */
function check(found, { inlined }) {
  const { whyInlined, ...others } = found;
  assert.deepEqual(others, RIGHT);
  if (inlined !== null) assert.equal(whyInlined !== null, inlined, whyInlined);
}

test('Next.js, on the server and in the browser', async (t) => {
  const folder = install('next');
  const next = 'node_modules/next/dist/bin/next';
  const works = async (url) => {
    const { client, server } = await visit(url, 'client', 'server');
    check(client, { inlined: false });
    check(server, { inlined: null });
    check(await (await fetch(`${url}api/mesh`)).json(), { inlined: null });
  };
  for (const [name, flags] of [
    ['Turbopack', []],
    ['webpack', ['--webpack']],
  ]) {
    await t.test(`${name}, built`, async () => {
      run(folder, next, ['build', ...flags]);
      await serving(folder, next, ['start', '-p', 'PORT'], works);
    });
    await t.test(`${name}, in development`, async () => {
      await serving(folder, next, ['dev', '-p', 'PORT', ...flags], works);
    });
  }
});

test('SvelteKit, on the server and in the browser', async (t) => {
  const folder = install('sveltekit');
  const vite = 'node_modules/vite/bin/vite.js';
  await t.test('built', async () => {
    run(folder, vite, ['build']);
    await serving(folder, 'build/index.js', [], async (url) => {
      const { client, server } = await visit(url, 'client', 'server');
      check(client, { inlined: false });
      check(server, { inlined: null });
    });
  });
  await t.test('in development', async () => {
    await serving(folder, vite, ['dev', '--port', 'PORT'], async (url) => {
      const { client, server } = await visit(url, 'client', 'server');
      check(client, { inlined: true });
      check(server, { inlined: false });
    });
  });
});

test('Parcel', async (t) => {
  const folder = install('parcel', { page: true });
  const parcel = 'node_modules/parcel/lib/bin.js';
  await t.test('built', async () => {
    run(folder, parcel, ['build', 'index.html', '--public-url', './', '--no-cache']);
    check((await visitFiles(join(folder, 'dist'))).client, { inlined: false });
  });
  await t.test('in development', async () => {
    const flags = ['serve', 'index.html', '-p', 'PORT', '--no-hmr', '--no-cache'];
    await serving(folder, parcel, flags, async (url) => {
      check((await visit(url, 'client')).client, { inlined: false });
    });
  });
});

for (const version of [6, 7]) {
  test(`Vite ${version}`, async (t) => {
    const folder = install('vite', { page: true });
    const vite = `node_modules/vite-${version}/bin/vite.js`;
    await t.test('built', async () => {
      run(folder, vite, ['build', '--base', './']);
      check((await visitFiles(join(folder, 'dist'))).client, { inlined: false });
    });
    await t.test('in development', async () => {
      await serving(folder, vite, ['--port', 'PORT'], async (url) => {
        check((await visit(url, 'client')).client, { inlined: true });
      });
    });
  });
}

test('jest, as CommonJS and as ES modules, in Node and in jsdom', async (t) => {
  const folder = install('jest');
  const body = readFileSync(join(here, 'jest/body.txt'), 'utf8');
  for (const environment of ['node', 'jsdom']) {
    for (const [kind, head, more] of [
      ['cjs', "const gdel = require('gdel-wasm');", {}],
      ['mjs', "import * as gdel from 'gdel-wasm';", { NODE_OPTIONS: '--experimental-vm-modules' }],
    ]) {
      await t.test(`${environment}, ${kind}`, () => {
        const file = `${environment}.test.${kind}`;
        const docblock = `/** @jest-environment ${environment} */`;
        writeFileSync(join(folder, file), [docblock, head, body].join('\n'));
        run(folder, 'node_modules/jest/bin/jest.js', ['--testMatch', `**/${file}`], more);
      });
    }
  }
});

const SCRIPT = `triangulated().then((found) => console.log(JSON.stringify(found)));\n`;

test('runtimes: programs print the result and end', async (t) => {
  const folder = install('runtimes');
  writeFileSync(
    join(folder, 'main.mjs'),
    `import { triangulated } from './triangulated.mjs';\n${SCRIPT}`,
  );
  const code = readFileSync(join(here, 'triangulated.mjs'), 'utf8');
  const required = code
    .replace(/import (.*) from ('.*');/, 'const $1 = require($2);')
    .replaceAll('export ', '');
  writeFileSync(join(folder, 'main.cjs'), required + SCRIPT);
  writeFileSync(
    join(folder, 'inline.mjs'),
    code.replace('gdel-wasm', 'gdel-wasm/inline').replaceAll('export ', '') + SCRIPT,
  );
  const runtimes = ['node-20', 'node-22', 'node-24', 'node-26'].map((name) => [
    name,
    join(folder, 'node_modules', name, 'bin/node'),
  ]);
  runtimes.push(['bun', join(folder, 'node_modules/.bin/bun')]);
  for (const [name, command] of runtimes) {
    assert.ok(existsSync(command), `${name} is not installed`);
    for (const file of ['main.mjs', 'main.cjs', 'inline.mjs']) {
      await t.test(`${name}, ${file}`, () => {
        check(JSON.parse(run(folder, command, [file])), { inlined: file === 'inline.mjs' });
      });
    }
  }
  await t.test('bun build, for Bun and as a program of its own', () => {
    const bun = join(folder, 'node_modules/.bin/bun');
    run(folder, bun, ['build', 'main.mjs', '--outdir', 'out', '--target', 'bun']);
    check(JSON.parse(run(folder, bun, ['out/main.js'])), { inlined: true });
    run(folder, bun, ['build', 'main.mjs', '--compile', '--outfile', 'single']);
    check(JSON.parse(run(folder, join(folder, 'single'))), { inlined: true });
  });
});
