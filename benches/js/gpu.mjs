// Times the package's GPU backend in Node through the npm package `webgpu` (Dawn): a line of JSON per row.
//
//   node benches/js/gpu.mjs [--package FOLDER] [--webgpu FOLDER] [--points 100000,1000000]
//     [--kind uniform] [--single] [--runs 9] [--outputs neighbors,hull,duplicateOf] [--reuse]
//     [--resident [--moved 0.002,0.01]] [--here]
//
// --outputs '' leaves the tetrahedra alone. With --reuse, each mesh takes the memory of the one before. With
// --resident, the mesh stays on a device that the script opens; with --here, the calling thread does all of the
// work. With --moved, resident meshes follow their points: displacements are normally distributed, and given as
// shares of the mean spacing of the points.
//
// To run it on another machine, carry benches/js, web/dist and node_modules/webgpu there; of the latter,
// `index.js`, `package.json` and the `.dawn.node` of its platform in `dist` are enough. On Linux it takes
// libvulkan1 and the driver.

import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { load, openDevice, openGpu, phases, print, root, timed, times } from './common.mjs';

const { values } = parseArgs({
  options: {
    package: { type: 'string', default: join(root, 'web/dist') },
    webgpu: { type: 'string', default: join(root, 'node_modules/webgpu') },
    points: { type: 'string', default: '100000,1000000' },
    kind: { type: 'string', default: 'uniform' },
    single: { type: 'boolean', default: false },
    runs: { type: 'string', default: '9' },
    outputs: { type: 'string', default: 'neighbors,hull,duplicateOf' },
    resident: { type: 'boolean', default: false },
    moved: { type: 'string', default: '' },
    here: { type: 'boolean', default: false },
    reuse: { type: 'boolean', default: false },
  },
});
const { resident, kind, here } = values;
const list = (text) => text.split(',').filter(Boolean);
const runs = Number(values.runs);
// The second run of a process waits for kernels that are compiled behind the first, and a device that was
// idle raises its clock during the first second of work.
const WARM_UP_MILLISECONDS = 3000;

const { createTriangulator, generate } = await load(values.package, 'index.js');
const [openMilliseconds, triangulator] = await timed(async () => {
  const gpu = await openGpu(values.webgpu);
  const own = resident ? { device: await openDevice(gpu), worker: !here } : { gpu };
  return createTriangulator({ ...own, backend: 'gpu' });
});
const outputs = list(values.outputs);
const kept = resident ? { resident } : { outputs };
const arrays = outputs.length === 3 ? 'all arrays' : ['tetrahedra', ...outputs].join(', ');
const result = resident ? 'resident' : arrays;

/** Runs something for a while, then times `runs` runs of it. */
async function measure(run) {
  const warm = performance.now() + WARM_UP_MILLISECONDS;
  do await run();
  while (performance.now() < warm);
  const all = [];
  while (all.length < runs) all.push(await run());
  return all;
}

/** When the first mesh of the process was there. */
let firstMilliseconds;

async function triangulate(count) {
  const doubles = await generate(kind, count, { seed: 1 });
  const points = values.single ? new Float32Array(doubles) : doubles;
  let mesh;
  const all = await measure(async () => {
    const copy = points.slice();
    const options = { backend: 'gpu', transfer: true, ...kept };
    if (values.reuse) options.reuse = mesh;
    const [milliseconds, made] = await timed(() => triangulator.delaunay3d(copy, options));
    firstMilliseconds ??= performance.now();
    if (resident) made.destroy();
    mesh = made;
    return milliseconds;
  });
  const { gpu, splay, fallback, adapter, thread, wasmBytes } = mesh.stats;
  print({
    input: kind,
    points: count,
    precision: values.single ? 'f32' : 'f64',
    result,
    reuse: values.reuse,
    thread,
    simplices: mesh.tetrahedronCount ?? mesh.tetrahedra.length / 4,
    ...times('ms', all),
    phases_ms: phases(mesh.stats),
    open_ms: openMilliseconds,
    first_mesh_ms: firstMilliseconds,
    fallback,
    gpu: {
      failed_vertices: gpu?.failedVertices,
      dispatches: gpu?.dispatches,
      submits: gpu?.submits,
      readbacks: gpu?.readbacks,
      bytes_read: gpu?.bytesRead,
      bytes: gpu?.bytes,
    },
    splay: { built: splay?.built },
    wasm_bytes: wasmBytes,
    adapter: adapter?.description,
  });
}

/** Returns normally distributed numbers, two at a time. */
function gaussians() {
  const radius = Math.sqrt(-2 * Math.log(1 - Math.random()));
  const angle = 2 * Math.PI * Math.random();
  return [radius * Math.cos(angle), radius * Math.sin(angle)];
}

async function follow(count, share) {
  const points = await generate('uniform', count, { seed: 1 });
  const displacement = share * count ** (-1 / 3);
  const mesh = await triangulator.delaunay3d(points.slice(), { resident });
  const restarts = [];
  const displace = () => {
    for (let i = 0; i < points.length; i += 2) {
      const [x, y] = gaussians();
      points[i] += displacement * x;
      points[i + 1] += displacement * y;
    }
  };
  const updates = await measure(async () => {
    displace();
    const [milliseconds] = await timed(() => mesh.update(points));
    restarts.push(mesh.stats.update.restarted);
    return milliseconds;
  });
  const scratch = await measure(async () => {
    displace();
    const [milliseconds, made] = await timed(() => triangulator.delaunay3d(points, { resident }));
    made.destroy();
    return milliseconds;
  });
  mesh.destroy();
  print({
    input: 'uniform',
    points: count,
    precision: 'f64',
    share,
    thread: mesh.stats.thread,
    restarted: restarts.slice(-runs).filter(Boolean).length,
    ...times('ms', updates),
    ...times('scratch_ms', scratch),
    adapter: mesh.stats.adapter?.description,
  });
}

for (const count of list(values.points).map(Number)) {
  if (!values.moved) await triangulate(count);
  for (const share of list(values.moved).map(Number)) await follow(count, share);
}
triangulator.dispose();
// Dawn keeps Node alive.
process.exit();
