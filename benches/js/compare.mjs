// Times the packed package's CPU engine, the native engine and the npm package qhull-wasm side by side, and prints ratios.
//
//   npm run build && cargo build --release && node benches/js/compare.mjs [--points 100000] [--runs 3] [--native GDEL] [--without qhull,native]
//
// All sides take the same uniform points, in turn, on one core. The native binary's time is that which it states; reading
// its file is left out.

import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { loadQhull } from 'qhull-wasm';
import { createEngine, generate } from '../../web/dist/node.js';

const root = join(dirname(fileURLToPath(import.meta.url)), '../..');
const { values } = parseArgs({
  options: {
    points: { type: 'string', default: '100000' },
    runs: { type: 'string', default: '3' },
    native: { type: 'string', default: join(root, 'target/release/gdel') },
    without: { type: 'string', default: '' },
  },
});
const [points, runs] = [+values.points, +values.runs];
const folder = mkdtempSync(join(tmpdir(), 'gdel-bench-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));

const input = await generate('uniform', points, { seed: 1 });
const file = join(folder, 'points.f64');
writeFileSync(file, new Uint8Array(input.buffer));

const engine = await createEngine({ engine: 'cpu' });
const qhull = await loadQhull();

/** Each gives [seconds, tetrahedra]. */
const sides = {
  async 'gdel-wasm'() {
    const copy = input.slice();
    const started = performance.now();
    const { tetrahedra, stats } = await engine.delaunay3d(copy, { transfer: true });
    sides.wasmBytes = stats.wasmBytes;
    return [(performance.now() - started) / 1e3, tetrahedra.length / 4];
  },
  async native() {
    const args = ['triangulate', file, '--engine', 'cpu', '--stats', 'json'];
    const output = execFileSync(values.native, args, { encoding: 'utf8' });
    const { seconds, tetrahedra } = JSON.parse(output);
    return [seconds.total, tetrahedra];
  },
  async qhull() {
    const started = performance.now();
    const { facets } = qhull.delaunay(input, 3);
    return [(performance.now() - started) / 1e3, facets.length];
  },
};
Object.defineProperty(sides, 'wasmBytes', { enumerable: false, writable: true, value: 0 });

const names = Object.keys(sides).filter((name) => !values.without.split(',').includes(name));
const seconds = Object.fromEntries(names.map((name) => [name, []]));
const counts = {};
for (let run = 0; run < runs; run++) {
  for (const name of names) {
    const [time, count] = await sides[name]();
    seconds[name].push(time);
    counts[name] = count;
  }
}
engine.dispose();

const median = (times) => times.slice().sort((a, b) => a - b)[times.length >> 1];
const ours = median(seconds['gdel-wasm']);
console.log(`${points} uniform points, medians of ${runs}, ${process.version}, WebAssembly memory ${(sides.wasmBytes / 1e6).toFixed(0)} MB`);
for (const name of names) {
  const time = median(seconds[name]);
  const ratios = seconds[name].map((other, run) => seconds['gdel-wasm'][run] / other);
  const range = `${Math.min(...ratios).toFixed(2)}–${Math.max(...ratios).toFixed(2)}`;
  console.log(`${name.padEnd(10)} ${time.toFixed(3)} s, ${counts[name]} tetrahedra, gdel-wasm / it ${(ours / time).toFixed(2)} (${range})`);
}
