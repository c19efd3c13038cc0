// The package's form: what publint and "are the types wrong?" say, and its sizes.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readdirSync, readFileSync } from 'node:fs';
import { homedir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { publint } from 'publint';
import { formatMessage } from 'publint/utils';
import { project, root, tarball } from './package.mjs';

const kilobytes = (file) =>
  gzipSync(readFileSync(join(root, 'web/dist', file)), { level: 9 }).length / 1e3;

test('publint has nothing to say', async () => {
  const pkg = JSON.parse(readFileSync(join(root, 'web/package.json')));
  const { messages } = await publint({ pkgDir: join(root, 'web'), strict: true });
  assert.deepEqual(
    messages.map((message) => formatMessage(message, pkg, { color: false })),
    [],
  );
});

test('the types are not wrong', () => {
  execFileSync(
    process.execPath,
    [
      join(root, 'node_modules/@arethetypeswrong/cli/dist/index.js'),
      tarball(),
      '--profile',
      'node16',
    ],
    {
      stdio: 'inherit',
    },
  );
});

test('the package has its licences and its documents, and says where it comes from', () => {
  const installed = join(project(), 'node_modules/gdel-wasm');
  const read = (name) => readFileSync(join(installed, name), 'utf8');
  for (const name of ['LICENSE-MIT', 'LICENSE-APACHE'])
    assert.equal(read(name), readFileSync(join(root, name), 'utf8'));
  for (const [, path] of read('README.md').matchAll(/\]\((?!https?:)([^)#]+)/g)) read(path);
  const { repository } = JSON.parse(read('package.json'));
  assert.equal(repository.directory, 'web');
});

test('no file says where it was built', () => {
  const folders = [root, process.env.CARGO_HOME ?? join(homedir(), '.cargo')];
  for (const file of readdirSync(join(root, 'web/dist'))) {
    const content = readFileSync(join(root, 'web/dist', file), 'latin1');
    for (const folder of folders)
      assert.ok(!content.includes(`${folder}/`), `${file} names ${folder}`);
  }
});

test('functions and classes keep their names, which stack traces show', async () => {
  const exports = Object.entries(await import(join(root, 'web/dist/index.js')));
  assert.ok(exports.length > 0);
  for (const [name, value] of exports) assert.equal(value.name, name);
});

test('the 3D module is below 340 kB and the JavaScript with which it runs below 34.4 kB, gzipped', () => {
  const wasm = kilobytes('gdel-3d.wasm');
  const js = kilobytes('index.js') + kilobytes('worker-3d.js');
  console.log(`gdel-3d.wasm ${wasm.toFixed(1)} kB, index.js and worker-3d.js ${js.toFixed(1)} kB`);
  assert.ok(wasm < 340);
  assert.ok(js < 34.4);
});
