// How the package finds its files, and what it says where they are missing.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { dist, importFrom, project } from './package.mjs';

const SCRIPT = (source) => `
  import { delaunay2dSync, delaunay3d, generate, load2d } from '${source}';
  const { stats } = await delaunay3d([[0, 0, 0]]).catch(({ code, message }) => ({ stats: { code, message } }));
  const { thread, whyThread, whyInlined, code, message } = stats;
  await load2d();
  const sync = delaunay2dSync([[0, 0]]).stats.whyInlined;
  const points = await generate('ball', 3);
  console.log(JSON.stringify({ thread, whyThread, whyInlined, code, message, sync, points: points.length }));
`;

/** What the script says in a project whose package was changed. */
function run(change, source = 'gdel-wasm') {
  const folder = project({ 'main.mjs': SCRIPT(source) });
  change(dist(folder));
  const args = [...process.execArgv, 'main.mjs'];
  return JSON.parse(execFileSync(process.execPath, args, { cwd: folder, encoding: 'utf8' }));
}

const EXPECTED = { thread: 'worker', whyThread: null, whyInlined: null, sync: null, points: 9 };

test('where all files are, no copy is loaded', () => {
  const withoutCopies = (folder) => {
    for (const name of ['3d', '2d', 'edit', 'tools', 'derived', 'surface', 'transport'])
      for (const copy of ['inline', 'inline-worker']) rmSync(join(folder, `${copy}-${name}.js`));
  };
  assert.deepEqual(run(withoutCopies), EXPECTED);
});

test('a wasm file that is missing is replaced by its copy, and the statistics say so', () => {
  const found = run((folder) => rmSync(join(folder, 'gdel-3d.wasm')));
  assert.match(found.whyInlined, /gdel-3d\.wasm/);
  assert.deepEqual({ ...found, whyInlined: null }, EXPECTED);
});

test('a page of HTML in place of a wasm file is told apart', () => {
  const found = run((folder) => writeFileSync(join(folder, 'gdel-3d.wasm'), '<!doctype html>'));
  assert.match(found.whyInlined, /magic/);
  assert.deepEqual({ ...found, whyInlined: null }, EXPECTED);
});

/** Wasm files that do not fit. */
const OTHER_VERSIONS = {
  'without exports': () => Uint8Array.of(0, 0x61, 0x73, 0x6d, 1, 0, 0, 0),
  'with other imports': (file) => {
    // The name of the module from which all is imported says which version they are.
    const [{ module }] = WebAssembly.Module.imports(new WebAssembly.Module(file));
    const other = [...module].reverse().join('');
    assert.notEqual(other, module);
    return Buffer.from(file.toString('latin1').replaceAll(module, other), 'latin1');
  },
};

for (const [what, other] of Object.entries(OTHER_VERSIONS))
  test(`a wasm file of another version, ${what}, is an error that says so, everywhere`, async () => {
    const folder = project();
    const file = join(dist(folder), 'gdel-3d.wasm');
    writeFileSync(file, other(readFileSync(file)));
    const { createTriangulator, delaunay3d, GdelError, load3d } = await importFrom(folder);
    for (const call of [
      () => delaunay3d([0, 0, 0]),
      () => load3d(),
      () => createTriangulator({ worker: false, backend: 'cpu' }),
      () => createTriangulator(),
    ]) {
      await assert.rejects(call, (error) => {
        assert.ok(error instanceof GdelError, String(error));
        assert.equal(error.code, 'LOAD_FAILED');
        assert.match(error.message, /one version/);
        return true;
      });
    }
  });

test('code that is missing is an error that says what to do', async () => {
  const folder = project();
  for (const module of ['3d', '2d']) rmSync(join(dist(folder), `core-${module}.js`));
  const { createTriangulator, delaunay3d, GdelError, load2d } = await importFrom(folder);
  for (const call of [() => load2d(), () => createTriangulator({ worker: false })]) {
    await assert.rejects(call, (error) => {
      assert.ok(error instanceof GdelError, String(error));
      assert.equal(error.code, 'LOAD_FAILED');
      assert.match(error.message, /core-[23]d\.js.*Deploy/s);
      return true;
    });
  }
  assert.equal((await delaunay3d([0, 0, 0])).dimension, 0);
});

test('a worker that is missing is replaced by its copy, and the statistics say so', () => {
  const found = run((folder) => rmSync(join(folder, 'worker-3d.js')));
  assert.match(found.whyInlined, /worker-3d\.js/);
  assert.deepEqual({ ...found, whyInlined: null }, EXPECTED);
});

test('gdel-wasm/inline needs no files', () => {
  const found = run((folder) => {
    for (const module of ['3d', '2d', 'edit', 'tools', 'derived', 'surface', 'transport']) {
      rmSync(join(folder, `gdel-${module}.wasm`));
      rmSync(join(folder, `worker-${module}.js`));
    }
  }, 'gdel-wasm/inline');
  const why = 'gdel-wasm/inline was imported';
  assert.deepEqual(found, { ...EXPECTED, whyInlined: why, sync: why });
});

test('where file and copy are missing, the error names both and the remedy', () => {
  const found = run((folder) => {
    rmSync(join(folder, 'gdel-3d.wasm'));
    rmSync(join(folder, 'inline-3d.js'));
  });
  assert.equal(found.code, 'LOAD_FAILED');
  assert.match(
    found.message,
    /gdel-3d\.wasm.*inline-3d\.js.*Deploy the \.wasm files and the chunks/s,
  );
});
