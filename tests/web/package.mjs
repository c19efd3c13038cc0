// The package as users get it: packed, and installed into an empty project.

import { execFileSync } from 'node:child_process';
import {
  cpSync,
  mkdirSync,
  mkdtempSync,
  readdirSync,
  readFileSync,
  rmSync,
  writeFileSync,
} from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { parse } from './fingerprints.mjs';

export const root = dirname(dirname(dirname(fileURLToPath(import.meta.url))));

/** The meshes that the native library gives, too. */
export const pinned = parse(readFileSync(join(root, 'tests/data/fingerprints.txt'), 'utf8'));

const folders = [];
process.once('exit', () => {
  for (const folder of folders) rmSync(folder, { recursive: true, force: true, maxRetries: 5 });
});

/** An empty folder that goes when the tests are done. */
export function scratch() {
  const folder = mkdtempSync(join(tmpdir(), 'gdel-wasm-'));
  folders.push(folder);
  return folder;
}

const quietly = { stdio: ['ignore', 'pipe', 'inherit'] };

/** Packs web/ into a folder, and installs the package into an empty project beside it. */
export function packInto(folder) {
  const project = join(folder, 'project');
  mkdirSync(project);
  execFileSync('npm', ['pack', '--silent', '--pack-destination', folder], {
    cwd: join(root, 'web'),
    ...quietly,
  });
  writeFileSync(join(project, 'package.json'), JSON.stringify({ private: true, type: 'module' }));
  execFileSync(
    'npm',
    ['install', '--silent', '--offline', '--no-audit', '--no-fund', tarballIn(folder)],
    { cwd: project, ...quietly },
  );
}

const tarballIn = (folder) =>
  join(
    folder,
    readdirSync(folder).find((name) => name.endsWith('.tgz')),
  );

/** Where {@link packInto} worked: scripts/test-js.mjs does it once for all files. */
let packed = process.env.GDEL_PACKED;

function packedOnce() {
  if (!packed) packInto((packed = scratch()));
  return packed;
}

/** The package as it would be published. */
export const tarball = () => tarballIn(packedOnce());

/** A project of its own with the package in its node_modules. */
export function project(files = {}) {
  const folder = scratch();
  cpSync(join(packedOnce(), 'project'), folder, { recursive: true });
  for (const [name, content] of Object.entries(files)) writeFileSync(join(folder, name), content);
  return folder;
}

/** Where the installed package has its files. */
export const dist = (folder) => join(folder, 'node_modules/gdel-wasm/dist');

/** Imports the installed package, as Node does. */
export const importFrom = (folder, file = 'index.js') =>
  import(pathToFileURL(join(dist(folder), file)));
