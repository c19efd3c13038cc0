// The package as users get it: packed, and installed into an empty project.

import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { parse } from './fingerprints.mjs';

export const root = dirname(dirname(dirname(fileURLToPath(import.meta.url))));

/** The meshes that the native engine gives, too. */
export const pinned = parse(readFileSync(join(root, 'tests/data/fingerprints.txt'), 'utf8'));

/** An empty folder that goes when the tests are done. */
export function scratch() {
  const folder = mkdtempSync(join(tmpdir(), 'gdel-wasm-'));
  process.on('exit', () => rmSync(folder, { recursive: true, force: true, maxRetries: 5 }));
  return folder;
}

const quietly = { stdio: ['ignore', 'pipe', 'inherit'], timeout: 120_000 };

/** Packs web/ and returns the tarball's path. */
export function pack() {
  const folder = scratch();
  const output = execFileSync('npm', ['pack', '--json', '--pack-destination', folder], { cwd: join(root, 'web'), ...quietly });
  return join(folder, JSON.parse(output)[0].filename);
}

/** A project with the packed package in its node_modules. */
export function project(files = {}) {
  const folder = scratch();
  writeFileSync(join(folder, 'package.json'), JSON.stringify({ private: true, type: 'module' }));
  for (const [name, content] of Object.entries(files)) writeFileSync(join(folder, name), content);
  execFileSync('npm', ['install', '--offline', '--no-audit', '--no-fund', pack()], { cwd: folder, ...quietly });
  return folder;
}

/** Where the installed package has its files. */
export const dist = (folder) => join(folder, 'node_modules/gdel-wasm/dist');

/** Imports the installed package, as Node does. */
export const importFrom = (folder, file = 'node.js') => import(pathToFileURL(join(dist(folder), file)));

/** The least of three measurements: on a busy machine a program may be interrupted for longer than what is measured takes. */
export async function leastOfThree(measure) {
  const found = [await measure(), await measure(), await measure()];
  return Math.min(...found);
}
