// Times the packed package's CPU backend, the native library, and the npm package qhull-wasm, in 2D
// delaunator, side by side, and prints ratios.
//
//   npm run build && cargo build --release --features cli
//   node benches/js/compare.mjs [--dim 2] [--points 100000] [--runs 3] \
//     [--native GDEL] [--without qhull,native]
//
// All sides take the same uniform points, in turn, on one core. The native binary's time is that
// which it states; reading its file is left out.

import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import Delaunator from 'delaunator';
import { loadQhull } from 'qhull-wasm';
import { createTriangulator, generate, Delaunator as Ours } from '../../web/dist/index.js';

const root = join(dirname(fileURLToPath(import.meta.url)), '../..');
const { values } = parseArgs({
  options: {
    dim: { type: 'string', default: '3' },
    points: { type: 'string', default: '100000' },
    runs: { type: 'string', default: '3' },
    native: { type: 'string', default: join(root, 'target/release/gdel') },
    without: { type: 'string', default: '' },
  },
});
const [dimension, points, runs] = [+values.dim, +values.points, +values.runs];
const folder = mkdtempSync(join(tmpdir(), 'gdel-bench-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));

// Coordinates of the cube, uniform and independent, serve 2D as well.
const input = (await generate('uniform', Math.ceil((dimension * points) / 3), { seed: 1 })).slice(
  0,
  dimension * points,
);
const file = join(folder, 'points.f64');
writeFileSync(file, new Uint8Array(input.buffer));

const triangulator = await createTriangulator({ backend: 'cpu' });
await Ours.load();
const qhull = await loadQhull();
let wasmBytes = 0;

/** The seconds that a triangulation takes here, and the number of simplices that it says. */
function timed(triangulate) {
  const started = performance.now();
  const count = triangulate();
  return [(performance.now() - started) / 1e3, count];
}

/** Each gives [seconds, simplices]. */
const sides = {
  async 'gdel-wasm'() {
    const copy = input.slice();
    const started = performance.now();
    const mesh = await (dimension === 2 ? triangulator.delaunay2d : triangulator.delaunay3d).call(
      triangulator,
      copy,
      { transfer: true },
    );
    wasmBytes = mesh.stats.wasmBytes;
    return [
      (performance.now() - started) / 1e3,
      (mesh.triangles ?? mesh.tetrahedra).length / (dimension + 1),
    ];
  },
  ...(dimension === 2
    ? {
        'its class': () => timed(() => new Ours(input).triangles.length / 3),
        delaunator: () => timed(() => new Delaunator(input).triangles.length / 3),
      }
    : {
        native() {
          const args = ['triangulate', file, '--backend', 'cpu', '--stats', 'json'];
          const { seconds, tetrahedra } = JSON.parse(
            execFileSync(values.native, args, { encoding: 'utf8' }),
          );
          return [seconds.total, tetrahedra];
        },
        qhull: () => timed(() => qhull.delaunay(input, 3).facets.length),
      }),
};

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
triangulator.dispose();

const median = (times) => times.slice().sort((a, b) => a - b)[times.length >> 1];
const ours = median(seconds['gdel-wasm']);
console.log(
  `${points} uniform points, medians of ${runs}, ${process.version}, WebAssembly memory ${(wasmBytes / 1e6).toFixed(0)} MB`,
);
for (const name of names) {
  const time = median(seconds[name]);
  const ratios = seconds[name].map((other, run) => seconds['gdel-wasm'][run] / other);
  const range = `${Math.min(...ratios).toFixed(2)}–${Math.max(...ratios).toFixed(2)}`;
  console.log(
    `${name.padEnd(10)} ${time.toFixed(3)} s, ${counts[name]} ${dimension === 2 ? 'triangles' : 'tetrahedra'}, gdel-wasm / it ${(ours / time).toFixed(2)} (${range})`,
  );
}
