// With the caller's device, the calling thread makes the calls on it and computes nothing: in Node by
// the npm package `webgpu` (Dawn) on Chromium's software driver, and on a device that only takes notes.

import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { setFlagsFromString } from 'node:v8';
import { runInNewContext } from 'node:vm';
import { build } from 'esbuild';
import { fingerprint } from './fingerprints.mjs';
import { canonical } from './moving.mjs';
import { dist, importFrom, project, root } from './package.mjs';

const swiftshader = '/usr/lib/chromium/vk_swiftshader_icd.json';
if (!process.env.VK_DRIVER_FILES && existsSync(swiftshader))
  process.env.VK_DRIVER_FILES = swiftshader;
const { create } = await import('webgpu');
/** Kept, since Dawn's devices do not outlive their instance. */
const gpu = create([]);

// Whatever computes in this thread is an instance of WebAssembly.
let instances = 0;
WebAssembly.Instance = class extends WebAssembly.Instance {
  constructor(...args) {
    super(...args);
    instances++;
  }
};

const folder = project();
const gdel = await importFrom(folder);
const { createTriangulator, delaunay2d, delaunay3d, generate, generate2d } = gdel;

async function openDevice() {
  const adapter = await gpu.requestAdapter();
  const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
  return adapter.requestDevice({ requiredLimits: { maxBufferSize, maxStorageBufferBindingSize } });
}

test('with the caller’s device, nothing is computed in the calling thread', {
  timeout: 600_000,
}, async () => {
  const device = await openDevice();
  const errors = [];
  device.addEventListener('uncapturederror', ({ error }) => errors.push(error.message));
  const triangulator = await createTriangulator({ device, backend: 'gpu' });
  const { thread, whyThread } = triangulator.info;
  assert.deepEqual([thread, whyThread], ['worker', null]);

  // Of these, Phase 1 leaves much to splaying.
  const sphere = await generate('sphere', 5000, { seed: 5 });
  sphere.copyWithin(3 * 4999, 0, 3);
  const expected = await delaunay3d(sphere, { backend: 'cpu' });
  const mesh = await triangulator.delaunay3d(sphere);
  assert.equal(fingerprint(mesh.tetrahedra), fingerprint(expected.tetrahedra));
  assert.deepEqual(mesh.duplicateOf, expected.duplicateOf);
  const { backend, fallback, splay } = mesh.stats;
  assert.deepEqual([backend, fallback, mesh.stats.thread], ['gpu', null, 'worker']);
  assert.ok(splay.built > 0);
  const points = await generate('uniform', 1000, { seed: 5 });

  // The fallback, in both dimensions.
  const flat = points.map((x, i) => (i % 3 === 2 ? 1 : x));
  const coplanar = await triangulator.delaunay3d(flat, { resident: true });
  assert.deepEqual([coplanar.dimension, coplanar.stats.thread], [2, 'worker']);
  assert.match(coplanar.stats.fallback, /coplanar/);
  const plane = await generate2d('uniform', 1500, { seed: 5 });
  const triangles = await triangulator.delaunay2d(plane);
  assert.deepEqual([triangles.stats.backend, triangles.stats.thread], ['gpu', 'worker']);
  const { triangles: expected2d } = await delaunay2d(plane, { backend: 'cpu' });
  assert.equal(canonical(triangles.triangles, 3), canonical(expected2d, 3));
  const line = await triangulator.delaunay2d(plane.map((x, i) => (i % 2 ? 0 : x)));
  assert.equal(line.dimension, 1);
  const few = await triangulator.delaunay3d(points, { backend: 'cpu' });
  assert.deepEqual([few.stats.backend, few.stats.thread], ['cpu', 'worker']);

  // A mesh on the device, its update, and its arrays.
  const resident = await triangulator.delaunay3d(points, { resident: true });
  const moved = points.map((x, i) => (i % 97 ? x : x * 1.001));
  await resident.update(moved);
  const { tetrahedra } = await delaunay3d(moved, { backend: 'cpu' });
  assert.equal(fingerprint(await resident.read('tetrahedra')), fingerprint(tetrahedra));
  // The caller's own scope was not closed in place of one of the worker's.
  device.pushErrorScope('validation');
  const run = triangulator.delaunay3d(points);
  device.createBuffer({ size: 4, usage: 0xffffff });
  assert.notEqual(await device.popErrorScope(), null);
  await run;
  assert.equal(instances, 0);

  const here = await createTriangulator({ device, backend: 'gpu', worker: false });
  assert.equal(here.info.thread, 'caller');
  const same = await here.delaunay3d(points);
  const before = await run;
  assert.equal(fingerprint(same.tetrahedra), fingerprint(before.tetrahedra));
  assert.deepEqual(Object.keys(same.stats), Object.keys(mesh.stats));
  assert.equal(instances, 1);
  instances = 0;
  assert.deepEqual(errors, []);
  here.dispose();
  triangulator.dispose();
  // It is not closed with its triangulators.
  assert.equal((await resident.read('hull')).length % 3, 0);
});

test('aborts, and the loss of the caller’s device', { timeout: 600_000 }, async () => {
  const device = await openDevice();
  const triangulator = await createTriangulator({ device, backend: 'gpu' });
  const points = await generate('uniform', 1000, { seed: 6 });
  const mesh = await triangulator.delaunay3d(points, { resident: true });
  for (const phase of ['lattice', 'phase 1', 'splay', 'finish']) {
    const controller = new AbortController();
    const { signal } = controller;
    const onProgress = (report) => report.phase === phase && controller.abort();
    const run = triangulator.delaunay3d(points, { signal, onProgress });
    // Reports are rare, so that there may be none of a short phase.
    await run.then(
      () => {},
      ({ code }) => assert.equal(code, 'ABORTED'),
    );
  }
  await assert.rejects(triangulator.delaunay3d(points, { signal: AbortSignal.timeout(1) }), {
    name: 'TimeoutError',
  });
  // The mesh outlasts the worker that may have been ended.
  const moved = points.map((x) => x * 1.5);
  await mesh.update(moved);
  const { tetrahedra } = await delaunay3d(moved, { backend: 'cpu' });
  assert.equal(fingerprint(await mesh.read('tetrahedra')), fingerprint(tetrahedra));
  assert.equal(typeof mesh.stats.update.flips, 'number');

  const reports = [];
  const run = triangulator.delaunay3d(points, {
    onProgress(report) {
      if (reports.push(report) === 1) device.destroy();
    },
  });
  await assert.rejects(run, ({ code }) => ['DEVICE_LOST', 'GPU'].includes(code));
  await assert.rejects(mesh.read('hull'), ({ code }) => ['DEVICE_LOST', 'GPU'].includes(code));
  triangulator.dispose();
  await assert.rejects(triangulator.delaunay3d(points), { code: 'DISPOSED' });
  assert.equal(instances, 0);
});

test('what the worker has dropped is garbage here, too', { timeout: 600_000 }, async () => {
  setFlagsFromString('--expose-gc');
  const collectGarbage = runInNewContext('gc');
  const device = await openDevice();
  const create = device.createBuffer.bind(device);
  const created = [];
  const createBuffer = (descriptor) => {
    const buffer = create(descriptor);
    created.push(new WeakRef(buffer));
    return buffer;
  };
  Object.defineProperty(device, 'createBuffer', { value: createBuffer });
  const triangulator = await createTriangulator({ device, backend: 'gpu' });
  const points = await generate('uniform', 1000, { seed: 7 });
  // Each number of points has buffers of its own. The worker does not collect its garbage meanwhile.
  for (let count = 300; count < 310; count++)
    await triangulator.delaunay3d(points.slice(0, 3 * count));
  // What a promise has just been fulfilled with is alive until the next turn.
  await new Promise((resolve) => setImmediate(resolve));
  collectGarbage();
  const alive = created.filter((reference) => reference.deref()).length;
  assert.ok(alive < created.length / 2, `${alive} of ${created.length} buffers`);
  triangulator.dispose();
});

const { serveDevice } = await import(pathToFileURL(join(dist(folder), 'core.js')));

/** A device that takes notes of what is done with it. */
function notedDevice({ milliseconds = 0 } = {}) {
  const notes = [];
  const device = {
    notes,
    depth: 0,
    features: [],
    limits: { maxBufferSize: 8, other: {} },
    lost: new Promise(() => {}),
    queue: {
      writeBuffer: ({ size }, at, data) => notes.push(['write', size, at, data]),
    },
    work(what) {
      const end = performance.now() + milliseconds;
      while (performance.now() < end);
      notes.push(what);
    },
    fail() {
      throw new TypeError('no such thing');
    },
    createBuffer: ({ size }) => ({
      size,
      destroy: () => notes.push(['destroy', size]),
      unmap: () => notes.push(['unmap', size]),
      mapAsync: async () => {},
      getMappedRange: (at, length) => new Uint8Array(length).fill(at).buffer,
    }),
    pushErrorScope() {
      device.depth++;
    },
    async popErrorScope() {
      assert.ok(--device.depth >= 0);
      return device.errors?.shift() ?? null;
    },
  };
  const messages = [];
  const failures = [];
  const served = serveDevice(
    device,
    (message) => messages.push(message),
    (error) => failures.push(error),
  );
  return { device, notes, messages, failures, served };
}

const answersOf = (messages) => messages.filter(({ type }) => type === 'answer');

test('calls are made in order and in slices, between which no scope is open', async () => {
  const { device, notes, messages, served } = notedDevice({ milliseconds: 3 });
  assert.deepEqual(messages[0].info.limits, { maxBufferSize: 8 });
  const calls = Array.from({ length: 5 }, (_, i) => [0, 'work', [i], 10 + i]);
  device.errors = [{ message: 'first', constructor: { name: 'GPUValidationError' } }];
  const taken = served.take([
    [0, 'pushErrorScope', ['validation'], 2],
    [0, 'pushErrorScope', ['internal'], 3],
    ...calls.slice(0, 3),
  ]);
  const seen = [];
  let timer = setImmediate(function look() {
    assert.equal(device.depth, 0);
    seen.push(notes.length);
    timer = setImmediate(look);
  });
  void served.take([...calls.slice(3), [0, 'popErrorScope', [], 20]]);
  await taken;
  // The other scope is open, as far as the worker knows.
  assert.equal(device.depth, 0);
  await served.take([[0, 'popErrorScope', [], 21]]);
  clearImmediate(timer);
  assert.deepEqual(notes, [0, 1, 2, 3, 4]);
  // Other events were handled in between.
  assert.ok(seen.some((count) => count > 0 && count < 5));
  await new Promise((resolve) => setImmediate(resolve));
  const answers = answersOf(messages);
  // What a scope caught before a pause is not lost: that of the inner one.
  const { value } = answers.find(({ id }) => id === 20);
  assert.deepEqual(value, { message: 'first', constructor: { name: 'GPUValidationError' } });
  assert.equal(answers.find(({ id }) => id === 21).value, null);
});

test('objects are named by numbers', async () => {
  const { notes, messages, served } = notedDevice();
  const bytes = new Uint8Array(8).fill(3);
  await served.take([
    [0, 'createBuffer', [{ size: 4 }], 2],
    [0, 'createBuffer', [{ size: 5 }], 3],
    [0, 'createBuffer', [{ size: 6 }], 4],
    [1, 'writeBuffer', [{ remote: 2 }, 16, bytes], 5],
    [0, 'work', [{ entries: [{ buffer: { remote: 3 } }] }], 6],
    [2, 'mapAsync', [1, 7, 3_000_000], 7],
    [4, 'free', [], 8],
  ]);
  assert.deepEqual(notes[0], ['write', 4, 16, bytes]);
  assert.equal(notes[1].entries[0].buffer.size, 5);
  while (answersOf(messages).length === 0) await new Promise(setImmediate);
  assert.deepEqual(new Uint8Array(answersOf(messages)[0].value), new Uint8Array(3_000_000).fill(7));

  // What a result names outlasts the worker.
  assert.equal(served.handOver([{ remote: 3 }])[0].size, 5);
  served.end();
  assert.deepEqual(notes.slice(2), [['destroy', 4]]);
  await served.take([[0, 'work', ['late'], 9]]);
  assert.equal(notes.length, 3);
});

test('a dispatch is three calls, and waits for its pipeline', async () => {
  const { device, notes, messages, failures, served } = notedDevice();
  device.beginComputePass = () => ({
    setPipeline: ({ size }) => notes.push(['pipeline', size]),
    setBindGroup: (group, { size }) => notes.push(['bindings', group, size]),
    dispatchWorkgroups: (count) => notes.push(['dispatch', count]),
  });
  const compiling = [];
  device.createComputePipelineAsync = ({ size }) =>
    new Promise((resolve, reject) => compiling.push({ make: () => resolve({ size }), reject }));
  const taken = served.take([
    [0, 'pushErrorScope', ['validation'], 2],
    [0, 'createComputePipeline', [{ size: 4 }], 3],
    [0, 'createComputePipeline', [{ size: 6 }], 4],
    [0, 'popErrorScope', [], 5],
    [0, 'createBuffer', [{ size: 5 }], 6],
    [0, 'beginComputePass', [], 7],
    [7, 3, 6, 70],
    [7, 4, 6, 71],
    [0, 'work', ['after'], 8],
  ]);
  while (compiling.length < 2) await new Promise(setImmediate);
  for (let turn = 0; turn < 9; turn++) await new Promise(setImmediate);
  assert.deepEqual([device.depth, notes.length, compiling.length], [0, 0, 2]);
  compiling[0].make();
  while (notes.length === 0) await new Promise(setImmediate);
  const first = [
    ['pipeline', 4],
    ['bindings', 0, 5],
    ['dispatch', 70],
  ];
  assert.deepEqual(notes, first);
  // A scope knows when its pipelines are compiled, and has their errors. The calls go on.
  assert.deepEqual(answersOf(messages), []);
  compiling[1].reject(new Error('too large'));
  await taken;
  assert.deepEqual([notes, failures], [[...first, 'after'], []]);
  while (answersOf(messages).length === 0) await new Promise(setImmediate);
  const { value } = answersOf(messages)[0];
  assert.deepEqual(value, { message: 'too large', constructor: { name: 'GPUValidationError' } });
});

test('a worker that is ended in a pause makes no more calls, and closes no scope of others', async () => {
  const { device, notes, failures, served } = notedDevice();
  let make;
  device.createComputePipelineAsync = () => new Promise((resolve) => (make = resolve));
  let isMade = false;
  const { createBuffer } = device;
  device.createBuffer = (descriptor) => {
    isMade = true;
    return createBuffer(descriptor);
  };
  const taken = served.take([
    [0, 'createComputePipeline', [{}], 2],
    [0, 'pushErrorScope', ['validation'], 3],
    [0, 'createBuffer', [{ size: 4 }], 4],
    [4, 2, 4, 70],
    [0, 'work', [1], 5],
  ]);
  while (!isMade) await new Promise(setImmediate);
  served.end();
  make({});
  await taken;
  assert.deepEqual([notes, failures, device.depth], [[['destroy', 4]], [], 0]);
});

test('what is mapped comes after the errors of the scopes before', async () => {
  const { device, messages, served } = notedDevice();
  let tell;
  device.popErrorScope = () => {
    device.depth--;
    return new Promise((resolve) => (tell ??= resolve));
  };
  await served.take([
    [0, 'createBuffer', [{ size: 4 }], 2],
    [0, 'pushErrorScope', ['validation'], 3],
    [0, 'popErrorScope', [], 4],
    [2, 'mapAsync', [1, 0, 4], 5],
  ]);
  for (let turn = 0; turn < 9; turn++) await new Promise(setImmediate);
  assert.deepEqual(answersOf(messages), []);
  tell({ message: 'lost', constructor: { name: 'GPUInternalError' } });
  while (answersOf(messages).length < 2) await new Promise(setImmediate);
  assert.deepEqual(
    answersOf(messages).map(({ id }) => id),
    [4, 5],
  );
});

test('copies of mapped buffers use the memory that the worker gives back, until its task ends', async () => {
  const { notes, messages, served } = notedDevice();
  await served.take([[0, 'createBuffer', [{ size: 4 }], 2]]);
  const map = async (at, size) => {
    messages.length = 0;
    await served.take([[2, 'mapAsync', [1, at, size], 3]]);
    while (messages.length === 0) await new Promise(setImmediate);
    const [{ value }] = answersOf(messages);
    assert.deepEqual(new Uint8Array(value), new Uint8Array(size).fill(at));
    return value;
  };
  const size = 2 ** 20;
  const first = await map(5, size);
  await served.take([[2, 'unmap', [first], 0]]);
  assert.deepEqual(notes, [['unmap', 4]]);
  assert.notEqual(await map(6, size + 4), first);
  assert.equal(await map(7, size), first);
  // It has one user at a time.
  assert.notEqual(await map(8, size), first);
  await served.take([
    [2, 'unmap', [first], 0],
    [9, 'free', [], 0],
  ]);
  assert.notEqual(await map(9, size), first);
});

/** Returns the GPU object that wgpu gets in a worker, its device, and what it posts. */
async function remoteDevice() {
  const entry = join(root, 'web/src/remote.ts');
  const built = await build({ entryPoints: [entry], bundle: true, write: false, format: 'esm' });
  const url = `data:text/javascript;base64,${Buffer.from(built.outputFiles[0].contents).toString('base64')}`;
  const { remoteGpu } = await import(url);
  const posted = [];
  const info = { features: new Set(), limits: {}, adapterInfo: undefined };
  const remote = remoteGpu(info, (message, transfer) => posted.push({ ...message, transfer }));
  const device = await (await remote.gpu.requestAdapter()).requestDevice();
  const calls = () => posted.splice(0).flatMap((message) => message.calls);
  return { remote, device, posted, calls };
}

test('the worker sends a dispatch as one call, and what is large in pieces', async () => {
  const { device, posted, calls } = await remoteDevice();
  const [pipeline, bindings] = [{ remote: 70 }, { remote: 71 }];
  const encoder = device.createCommandEncoder({ label: 'gdel' });
  const pass = encoder.beginComputePass();
  pass.setPipeline(pipeline);
  pass.setBindGroup(0, bindings);
  pass.dispatchWorkgroups(5, 1, 1);
  pass.dispatchWorkgroups(6, 1, 1);
  device.queue.submit([encoder.finish()]);
  const sent = calls();
  assert.deepEqual(sent.slice(2, 4), [
    [pass.remote, 70, 71, 5],
    [pass.remote, 70, 71, 6],
  ]);
  assert.deepEqual(
    sent.map(([, method]) => method).filter((method) => typeof method === 'string'),
    ['createCommandEncoder', 'beginComputePass', 'finish', 'submit'],
  );

  const piece = 2 ** 20;
  const bytes = new Uint8Array(2.5 * piece).map((_, i) => i >> 20);
  device.queue.writeBuffer({ remote: 9 }, 16, bytes);
  await undefined;
  // Each piece is written while the next one is copied.
  assert.deepEqual(
    posted.map(({ transfer }) => transfer.length),
    [1, 1, 1],
  );
  const written = calls().map(([object, method, [, at, data]]) => [
    object,
    method,
    at,
    data.length,
  ]);
  assert.deepEqual(written, [
    [1, 'writeBuffer', 16, piece],
    [1, 'writeBuffer', 16 + piece, piece],
    [1, 'writeBuffer', 16 + 2 * piece, piece / 2],
  ]);
  assert.equal(bytes.length, 2.5 * piece);

  // What is small goes with the calls that follow.
  const before = posted.length;
  device.queue.writeBuffer({ remote: 9 }, 0, bytes.subarray(0, piece / 2));
  assert.equal(posted.length, before + 1);
  device.queue.writeBuffer({ remote: 9 }, 0, bytes.subarray(0, 64));
  assert.equal(posted.length, before + 1);
  await undefined;
  assert.equal(posted.length, before + 2);
});

test('the worker gives the memory of large copies back', async () => {
  const { remote, device, posted, calls } = await remoteDevice();
  const buffer = device.createBuffer({ size: 4 });
  const unmapped = async (bytes) => {
    const mapping = buffer.mapAsync(1, 0, bytes.byteLength);
    const [, , , id] = calls().find(([, method]) => method === 'mapAsync');
    remote.answer({ id, value: bytes });
    await mapping;
    assert.equal(buffer.getMappedRange(0, bytes.byteLength), bytes);
    buffer.unmap();
    await undefined;
    const [{ transfer }] = posted;
    return [calls(), transfer];
  };
  const large = new ArrayBuffer(2 ** 20);
  assert.deepEqual(await unmapped(large), [[[buffer.remote, 'unmap', [large], 0]], [large]]);
  assert.deepEqual(await unmapped(new ArrayBuffer(4)), [[[buffer.remote, 'unmap', [], 0]], []]);
  // What has not been mapped can be unmapped.
  buffer.unmap();
  await undefined;
  assert.deepEqual(calls(), [[buffer.remote, 'unmap', [], 0]]);
});

test('nobody waits for the errors of a scope in which nothing is created, and none is lost', async () => {
  const { remote, device, calls } = await remoteDevice();
  const error = { message: 'out of memory', constructor: { name: 'GPUOutOfMemoryError' } };
  const scope = (work) => {
    device.pushErrorScope('validation');
    work();
    const popped = device.popErrorScope();
    const [id] = calls().flatMap(([, method, , id]) => (method === 'popErrorScope' ? [id] : []));
    return { popped, answer: (value) => remote.answer({ id, value }) };
  };
  const submit = () => device.queue.submit([]);
  const create = () => device.createBuffer({ size: 4 });

  const using = scope(submit);
  assert.equal(await using.popped, null);
  const creating = scope(create);
  const seen = [];
  void creating.popped.then((value) => seen.push(value));
  using.answer(error);
  await new Promise(setImmediate);
  assert.deepEqual(seen, []);
  // The next scope has the error of the one before.
  creating.answer(null);
  assert.equal(await creating.popped, error);
  const next = scope(create);
  next.answer(null);
  assert.equal(await next.popped, null);

  // So does what is mapped.
  const late = scope(submit);
  assert.equal(await late.popped, null);
  const mapping = create().mapAsync(1, 0, 4);
  const [, , , id] = calls().find(([, method]) => method === 'mapAsync');
  late.answer(error);
  remote.answer({ id, value: new ArrayBuffer(4) });
  await assert.rejects(mapping, error);
  const last = scope(submit);
  assert.equal(await last.popped, null);
});

test('a call that throws ends the worker', async () => {
  const { device, notes, failures, served } = notedDevice();
  await served.take([
    [0, 'pushErrorScope', ['validation'], 2],
    [0, 'fail', [], 3],
    [0, 'work', [1], 4],
  ]);
  assert.match(failures[0].message, /no such thing/);
  assert.deepEqual([failures.length, notes.length, device.depth], [1, 0, 0]);
});
