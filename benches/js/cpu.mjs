// Times the package's CPU backend, our native program with one thread, and the npm packages qhull-wasm and, in
// 2D, delaunator, side by side: a line of JSON per side.
//
//   npm run build && cargo build --release -p gdel-bench
//   node benches/js/cpu.mjs [--dim 2] [--points 100000] [--kind uniform] [--runs 3]
//     [--sides gdel-wasm,native,qhull-wasm]
//
// All sides take the same points, in turn.

import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { load, median, native, print, root, timed, times } from './common.mjs';

const { values } = parseArgs({
  options: {
    package: { type: 'string', default: join(root, 'web/dist') },
    native: { type: 'string', default: join(root, 'target/release/gdel-bench') },
    dim: { type: 'string', default: '3' },
    points: { type: 'string', default: '100000' },
    kind: { type: 'string', default: 'uniform' },
    runs: { type: 'string', default: '3' },
    sides: { type: 'string' },
  },
});
const [dimension, points, runs] = [+values.dim, +values.points, +values.runs];
const gdel = await load(values.package, 'index.js');
const generate = dimension === 2 ? gdel.generate2d : gdel.generate;
const input = await generate(values.kind, points, { seed: 1 });
const triangulator = await gdel.createTriangulator({ backend: 'cpu' });
let wasmBytes = 0;

/** Each returns the milliseconds of a run, and the number of simplices. */
const SIDES = {
  async 'gdel-wasm'() {
    const copy = input.slice();
    const [milliseconds, mesh] = await timed(() =>
      triangulator[`delaunay${dimension}d`](copy, { transfer: true }),
    );
    wasmBytes = mesh.stats.wasmBytes;
    return [milliseconds, (mesh.triangles ?? mesh.tetrahedra).length / (dimension + 1)];
  },
  native() {
    const options = ['--backend=cpu', '--threads=1', '--runs=1', '--warm-up=0'];
    const source = [values.kind, `--dim=${dimension}`, `--points=${points}`];
    const [row] = native(values.native, ['run', ...source, ...options]);
    return [row.ms, row.simplices];
  },
};
if (dimension === 2) {
  const { default: Theirs } = await import('delaunator');
  await gdel.Delaunator.load();
  SIDES['its class Delaunator'] = () =>
    timed(() => new gdel.Delaunator(input).triangles.length / 3);
  SIDES.delaunator = () => timed(() => new Theirs(input).triangles.length / 3);
} else {
  const { loadQhull } = await import('qhull-wasm');
  const qhull = await loadQhull();
  SIDES['qhull-wasm'] = () => timed(() => qhull.delaunay(input, 3).facets.length);
}

const names = values.sides?.split(',') ?? Object.keys(SIDES);
const found = Object.fromEntries(names.map((name) => [name, []]));
const counts = {};
for (let run = 0; run < runs; run++) {
  for (const name of names) {
    const [milliseconds, count] = await SIDES[name]();
    found[name].push(milliseconds);
    counts[name] = count;
  }
}
triangulator.dispose();
const ours = median(found['gdel-wasm'] ?? found[names[0]]);
for (const name of names) {
  print({
    input: values.kind,
    dimension,
    points,
    precision: 'f64',
    side: name,
    simplices: counts[name],
    ...times('ms', found[name]),
    ratio: Math.round((1e3 * ours) / median(found[name])) / 1e3,
    wasm_bytes: name === 'gdel-wasm' ? wasmBytes : undefined,
  });
}
