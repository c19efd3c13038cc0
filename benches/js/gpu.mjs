// Times the packed package's GPU backend in Node through the npm package `webgpu` (Dawn), and
// prints JSON.
//
//   node benches/js/gpu.mjs [--package FOLDER] [--webgpu FOLDER] \
//     [--points 100000,1000000] [--kind uniform] [--runs 5] [--native GDEL]
//     [--outputs neighbors,hull,duplicateOf] [--resident [--here]] [--reuse]
//
// With --resident, the mesh stays on a device that the script opens; with --here, the calling thread
// computes as well, instead of a worker that sends it the calls. --outputs '' leaves the
// tetrahedra alone. With --reuse, each mesh takes the memory of the one before.
//
// To run it on another machine, carry this file, web/dist and node_modules/webgpu there; of the
// latter, `index.js`, `package.json` and the `.dawn.node` of its platform in `dist` are enough.
// --package and --webgpu say where they lie. On Linux it takes libvulkan1 and the driver. With
// --native, a `gdel` binary triangulates the same points in turn.

import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';

const root = join(dirname(fileURLToPath(import.meta.url)), '../..');
const { values } = parseArgs({
  options: {
    package: { type: 'string', default: join(root, 'web/dist') },
    webgpu: { type: 'string', default: join(root, 'node_modules/webgpu') },
    points: { type: 'string', default: '100000,1000000' },
    kind: { type: 'string', default: 'uniform' },
    runs: { type: 'string', default: '5' },
    native: { type: 'string' },
    outputs: { type: 'string', default: 'neighbors,hull,duplicateOf' },
    resident: { type: 'boolean', default: false },
    here: { type: 'boolean', default: false },
    reuse: { type: 'boolean', default: false },
  },
});
const load = (folder, file) => import(pathToFileURL(join(resolve(folder), file)));
const { createTriangulator, generate } = await load(values.package, 'index.js');
const { create } = await load(values.webgpu, 'index.js');

const folder = mkdtempSync(join(tmpdir(), 'gdel-bench-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
// The second run of a process waits for kernels that are compiled behind the first, and a device that was
// idle raises its clock during the first second of work.
const WARM_UP_MILLISECONDS = 3000;

const median = (numbers) => numbers.slice().sort((a, b) => a - b)[numbers.length >> 1];

/** Returns a device with the largest buffers that the adapter has. */
async function deviceOf(gpu) {
  const adapter = await gpu.requestAdapter({ powerPreference: 'high-performance' });
  const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
  return adapter.requestDevice({ requiredLimits: { maxBufferSize, maxStorageBufferBindingSize } });
}

const opened = performance.now();
const gpu = create([]);
// When it is garbage, its devices are lost.
globalThis.gpu = gpu;
const { resident } = values;
const triangulator = await createTriangulator({
  ...(resident ? { device: await deviceOf(gpu), worker: !values.here } : { gpu }),
  backend: 'gpu',
});
const outputs = values.outputs.split(',').filter(Boolean);
const kept = resident ? { resident } : { outputs };
const openMilliseconds = performance.now() - opened;
const runs = +values.runs;

for (const count of values.points.split(',').map(Number)) {
  const points = await generate(values.kind, count, { seed: 1 });
  let native = null;
  if (values.native) {
    const file = join(folder, 'points.f64');
    writeFileSync(file, new Uint8Array(points.buffer));
    const args = [
      'triangulate',
      file,
      '--backend',
      'gpu',
      '--stats',
      'json',
      '--repeat',
      String(runs + 1),
    ];
    const lines = execFileSync(values.native, args, { encoding: 'utf8' }).trim().split('\n');
    // The first run opens the device.
    native = median(lines.slice(1).map((line) => 1e3 * JSON.parse(line).seconds.total));
  }
  let mesh;
  const run = async () => {
    const copy = points.slice();
    const reuse = values.reuse ? mesh : undefined;
    const started = performance.now();
    mesh = await triangulator.delaunay3d(copy, { backend: 'gpu', transfer: true, reuse, ...kept });
    const milliseconds = performance.now() - started;
    if (resident) mesh.destroy();
    return milliseconds;
  };
  const warm = performance.now() + WARM_UP_MILLISECONDS;
  do await run();
  while (performance.now() < warm);
  const times = [];
  while (times.length < runs) times.push(await run());
  const { gpu: device, splay, phases, fallback, adapter, wasmBytes } = mesh.stats;
  const milliseconds = median(times);
  console.log(
    JSON.stringify({
      kind: values.kind,
      points: count,
      tetrahedra: mesh.tetrahedronCount ?? mesh.tetrahedra.length / 4,
      outputs: resident ? 'resident' : outputs,
      reuse: values.reuse,
      milliseconds,
      all: times,
      nativeMilliseconds: native,
      ratio: native && milliseconds / native,
      phases,
      fallback,
      submits: device?.submits,
      dispatches: device?.dispatches,
      readbacks: device?.readbacks,
      bytesRead: device?.bytesRead,
      failedVertices: device?.failedVertices,
      splayed: splay?.built,
      gpuBytes: device?.bytes,
      wasmBytes,
      openMilliseconds,
      adapter,
    }),
  );
}
triangulator.dispose();
