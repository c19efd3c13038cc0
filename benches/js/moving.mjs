// Follows points that move, as `examples/moving.rs` does in Rust: prints one JSON object per
// dimension and displacement, with the medians in milliseconds.
//
//   node benches/js/moving.mjs [--package FOLDER] [--webgpu FOLDER] [--points 30000] [--steps 9]
//     [--backend gpu] [--dimensions 3,2] [--here]
//
// With the backend `gpu`, the meshes stay on a device that the script opens through the npm package
// `webgpu` (Dawn); with `cpu`, they are arrays, which a worker updates. With --here, the thread that has
// the device computes, too, as a page's worker does that opens a device of its own; otherwise another
// worker sends it the calls. Displacements are normally distributed, and given as shares of the mean
// spacing of the points. benches/js/gpu.mjs says what another machine needs.

import { dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { canonical, move, randomFrom } from '../../tests/web/moving.mjs';

const DISPLACEMENTS = [0, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1];

const root = join(dirname(fileURLToPath(import.meta.url)), '../..');
const { values } = parseArgs({
  options: {
    package: { type: 'string', default: join(root, 'web/dist') },
    webgpu: { type: 'string', default: join(root, 'node_modules/webgpu') },
    points: { type: 'string', default: '30000' },
    steps: { type: 'string', default: '9' },
    backend: { type: 'string', default: 'gpu' },
    dimensions: { type: 'string', default: '3,2' },
    here: { type: 'boolean', default: false },
  },
});
const load = (folder, file) => import(pathToFileURL(join(resolve(folder), file)));
const { createTriangulator } = await load(values.package, 'index.js');
const { backend } = values;
const resident = backend === 'gpu';
const count = Number(values.points);
const steps = Number(values.steps);
const median = (numbers) => numbers.slice().sort((a, b) => a - b)[numbers.length >> 1];

/** Returns a device with the largest buffers that the adapter has. */
async function openDevice() {
  const { create } = await load(values.webgpu, 'index.js');
  // When it is garbage, its devices are lost.
  globalThis.gpu = create([]);
  const adapter = await globalThis.gpu.requestAdapter({ powerPreference: 'high-performance' });
  const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
  return adapter.requestDevice({ requiredLimits: { maxBufferSize, maxStorageBufferBindingSize } });
}

/** Returns the milliseconds that something takes, and its result. */
async function timed(work) {
  const began = performance.now();
  const result = await work();
  return [performance.now() - began, result];
}

const device = resident ? await openDevice() : undefined;
const triangulator = await createTriangulator({ device, backend, worker: !values.here });

for (const dimension of values.dimensions.split(',').map(Number)) {
  const name = dimension === 3 ? 'tetrahedra' : 'triangles';
  const triangulate = (points) => triangulator[`delaunay${dimension}d`](points, { resident });
  const simplicesOf = async (mesh) =>
    canonical(resident ? await mesh.read(name) : mesh[name], dimension + 1);
  const random = randomFrom(1);
  const start = Float64Array.from({ length: dimension * count }, random);
  // What only the first runs compile.
  for (let run = 0; run < 2; run++) {
    const mesh = await triangulate(start);
    await mesh.update(start);
    if (resident) mesh.destroy();
  }
  for (const displacement of DISPLACEMENTS) {
    let points = start;
    const mesh = await triangulate(points);
    let scratch;
    const [updates, scratches] = [[], []];
    for (let step = 0; step < steps; step++) {
      points = move(points, dimension, displacement, random);
      const moved = points;
      const [update] = await timed(() => mesh.update(moved));
      updates.push(update);
      if (resident) scratch?.destroy();
      const [milliseconds, made] = await timed(() => triangulate(moved));
      scratches.push(milliseconds);
      scratch = made;
    }
    // To compare them takes longer than all steps, in which a GPU would get slow.
    const same = (await simplicesOf(mesh)) === (await simplicesOf(scratch));
    const { inverted, notLocallyDelaunay, flips, stars, restarted } = mesh.stats.update;
    const phases = mesh.stats.phases.map((phase) => [phase.name, +phase.milliseconds.toFixed(3)]);
    console.log(
      JSON.stringify({
        dimension,
        points: count,
        backend,
        displacement,
        update: +median(updates).toFixed(3),
        scratch: +median(scratches).toFixed(3),
        inverted,
        notLocallyDelaunay,
        flips,
        stars,
        restarted,
        same,
        phases: Object.fromEntries(phases),
      }),
    );
    if (resident) for (const old of [mesh, scratch]) old.destroy();
  }
}
triangulator.dispose();
