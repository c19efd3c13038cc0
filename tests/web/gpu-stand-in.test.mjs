// What stands for a device where wgpu uses it: on a device that only takes notes, and in Node by the npm
// package `webgpu` (Dawn) on Chromium's software driver.

import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { build } from 'esbuild';
import { fingerprint } from './fingerprints.mjs';
import { importFrom, project, root } from './package.mjs';

const swiftshader = '/usr/lib/chromium/vk_swiftshader_icd.json';
if (!process.env.VK_DRIVER_FILES && existsSync(swiftshader))
  process.env.VK_DRIVER_FILES = swiftshader;
const { create } = await import('webgpu');
/** Kept, since Dawn's devices do not outlive their instance. */
const gpu = create([]);

const built = await build({
  entryPoints: [join(root, 'web/src/gpu-stand-in.ts')],
  bundle: true,
  write: false,
  format: 'esm',
});
const { GpuStandIn } = await import(
  `data:text/javascript;base64,${Buffer.from(built.outputFiles[0].contents).toString('base64')}`
);

const turn = () => new Promise(setImmediate);

/** Returns what stands for a device, and what its passes do with a pipeline. */
async function standFor(device) {
  const standIn = new GpuStandIn(
    { requestAdapter: async () => ({ requestDevice: async () => device }) },
    true,
  );
  const like = await (await standIn.requestAdapter()).requestDevice();
  const setPipeline = (pipeline) =>
    like.createCommandEncoder().beginComputePass().setPipeline(pipeline);
  return { standIn, like, setPipeline };
}

/** A device that takes notes. Its buffers are mapped, and its pipelines compiled, when the test says so. */
function notedDevice() {
  const notes = [];
  const settling = [];
  let buffers = 0;
  const later = () => new Promise((resolve, reject) => settling.push({ resolve, reject }));
  const device = {
    scopes: [],
    errors: [],
    queue: {
      writeBuffer: (to, at, bytes, start, size) =>
        notes.push(['write', to, at, bytes[start], size]),
      submit: (commands) => notes.push(['submit', ...commands]),
    },
    createCommandEncoder() {
      const copies = [];
      return {
        beginComputePass: () => ({
          setPipeline: ({ label }) => notes.push(['pipeline', label]),
        }),
        copyBufferToBuffer: ({ name }, ...copy) => copies.push([name, ...copy]),
        finish: () => copies,
      };
    },
    createBuffer({ size, usage }) {
      const name = `staging ${buffers++}`;
      const memory = new ArrayBuffer(size);
      notes.push(['create', name, size, usage, device.scopes.join()]);
      return {
        name,
        size,
        memory,
        mapAsync: later,
        getMappedRange: () => memory,
        unmap: () => notes.push(['unmap', name, new Uint8Array(memory)[0]]),
        destroy: () => notes.push(['destroy', name]),
      };
    },
    pushErrorScope: (filter) => device.scopes.push(filter),
    async popErrorScope() {
      device.scopes.pop();
      return device.errors.shift() ?? null;
    },
    createComputePipeline: ({ label }) => {
      notes.push(['compile', label]);
      return { label };
    },
    createComputePipelineAsync: async ({ label }) => {
      notes.push(['compile aside', label]);
      await later();
      return { label };
    },
  };
  return { device, settling, taken: () => notes.splice(0) };
}

/** Does something where there are no modules of Node, as in a browser. */
function elsewhere(work) {
  const { getBuiltinModule } = process;
  process.getBuiltinModule = undefined;
  try {
    return work();
  } finally {
    process.getBuiltinModule = getBuiltinModule;
  }
}

test('pipelines are compiled aside, unless one is needed before the next or the end of the scope', async () => {
  const { device, settling, taken } = notedDevice();
  const { like, setPipeline } = await standFor(device);
  const [a, b] = ['a', 'b'].map((label) => like.createComputePipeline({ label }));
  assert.deepEqual(taken(), [['compile aside', 'a']]);
  setPipeline(b);
  setPipeline(b);
  const c = like.createComputePipeline({ label: 'c' });
  assert.deepEqual(taken(), [
    ['compile', 'b'],
    ['pipeline', 'b'],
    ['pipeline', 'b'],
  ]);
  let answer;
  const scope = elsewhere(() => like.popErrorScope());
  const answered = scope.then((error) => (answer = error));
  await turn();
  assert.deepEqual([taken(), answer], [[['compile aside', 'c']], undefined]);
  settling.shift().resolve();
  await turn();
  assert.equal(answer, undefined);
  settling.shift().resolve();
  await answered;
  assert.equal(answer, null);
  setPipeline(a);
  setPipeline(c);
  assert.deepEqual(taken(), [
    ['pipeline', 'a'],
    ['pipeline', 'c'],
  ]);
  // The next scope knows nothing of them.
  assert.equal(await like.popErrorScope(), null);
  assert.deepEqual(taken(), []);
});

test('in Node, this thread compiles every third pipeline, before the scope ends', async () => {
  const { device, settling, taken } = notedDevice();
  device.popErrorScope = async () => {
    device.scopes.push('popped');
    return null;
  };
  const { createComputePipeline } = device;
  device.createComputePipeline = (descriptor) => {
    assert.deepEqual(device.scopes, []);
    return createComputePipeline(descriptor);
  };
  const { like, setPipeline } = await standFor(device);
  const labels = [...'abcdefg'];
  const pipelines = labels.map((label) => like.createComputePipeline({ label }));
  const aside = (label) => ['compile aside', label];
  assert.deepEqual(taken(), [...'acdf'].map(aside));
  const answered = like.popErrorScope();
  assert.deepEqual(taken(), [['compile', 'b'], ['compile', 'e'], aside('g')]);
  await turn();
  for (const { resolve } of settling.splice(0)) resolve();
  assert.equal(await answered, null);
  for (const pipeline of pipelines) setPipeline(pipeline);
  assert.deepEqual(
    taken(),
    labels.map((label) => ['pipeline', label]),
  );
});

test('who needs a pipeline while it is compiled aside does not wait', async () => {
  const { device, settling, taken } = notedDevice();
  const { like, setPipeline } = await standFor(device);
  const pipeline = like.createComputePipeline({ label: 'a' });
  const answered = like.popErrorScope();
  setPipeline(pipeline);
  assert.deepEqual(taken(), [
    ['compile aside', 'a'],
    ['compile', 'a'],
    ['pipeline', 'a'],
  ]);
  settling.shift().resolve();
  assert.equal(await answered, null);
});

test('a scope has the errors of its pipelines, as wgpu tells them apart', async () => {
  const { device, settling } = notedDevice();
  const { like } = await standFor(device);
  like.createComputePipeline({ label: 'a' });
  const answered = like.popErrorScope();
  settling.shift().reject(new Error('too large'));
  const error = { message: 'too large', constructor: { name: 'GPUValidationError' } };
  assert.deepEqual(await answered, error);
  like.createComputePipeline({ label: 'a' });
  device.errors = [{ message: 'lost' }];
  const other = like.popErrorScope();
  settling.shift().resolve();
  assert.deepEqual(await other, { message: 'lost' });
});

test('large arrays that come again are written through a buffer that stays', async () => {
  const { device, settling, taken } = notedDevice();
  const { standIn, like } = await standFor(device);
  const { queue } = like;
  const large = (value) => new Uint8Array(2 ** 17).fill(value);
  const run = (value) => {
    queue.writeBuffer('small', 0, new Uint8Array(16).fill(value));
    queue.writeBuffer('points', 8, large(value));
    queue.submit(['run']);
    return taken();
  };
  const plain = (value) => [
    ['write', 'small', 0, value, 16],
    ['write', 'points', 8, value, 2 ** 17],
    ['submit', 'run'],
  ];
  // A single run would gain nothing.
  assert.deepEqual(run(1), plain(1));
  const created = ['create', 'staging 0', 2 ** 17, 6, 'validation,out-of-memory'];
  assert.deepEqual(run(2), [...plain(2), created]);
  assert.deepEqual(device.scopes, []);
  // It is not mapped yet.
  assert.deepEqual(run(3), plain(3));
  settling.shift().resolve();
  await turn();
  const copied = ['submit', [['staging 0', 0, 'points', 8, 2 ** 17]]];
  assert.deepEqual(run(4), [
    ['write', 'small', 0, 4, 16],
    ['unmap', 'staging 0', 4],
    copied,
    ['submit', 'run'],
  ]);
  settling.shift().resolve();
  await turn();
  // What is written afterwards in another way comes afterwards, and what has no room goes another way.
  queue.writeBuffer('points', 8, large(5));
  queue.writeBuffer('points', 8, new Uint8Array(16).fill(6));
  queue.writeBuffer('more', 0, large(7));
  assert.deepEqual(taken(), [
    ['unmap', 'staging 0', 5],
    copied,
    ['write', 'points', 8, 6, 16],
    ['write', 'more', 0, 7, 2 ** 17],
  ]);
  // Next time there is room for all of it.
  queue.submit([]);
  assert.deepEqual(
    taken().map(([what, name, size]) => [what, name, size]),
    [
      ['submit', undefined, undefined],
      ['destroy', 'staging 0', undefined],
      ['create', 'staging 1', 2 ** 18],
    ],
  );
  // A small submission between large ones changes nothing.
  queue.writeBuffer('patch', 0, new Uint8Array(2 ** 16).fill(9));
  queue.submit([]);
  assert.deepEqual(taken(), [['write', 'patch', 0, 9, 2 ** 16], ['submit']]);
  // Without memory for it, all is written as before.
  for (const { reject } of settling.splice(0)) reject(new Error('destroyed, or no memory'));
  await turn();
  assert.deepEqual(run(8), plain(8));
  standIn.end();
  assert.deepEqual(taken(), [['destroy', 'staging 1']]);
});

for (const worker of [false, true])
  test(`points go through memory that stays, and no kernel is compiled when it is needed${worker ? ', in a worker' : ''}`, {
    timeout: 600_000,
  }, async () => {
    const { createTriangulator, delaunay3d, generate } = await importFrom(project());
    const adapter = await gpu.requestAdapter();
    const device = await adapter.requestDevice();
    const writes = [];
    const compiled = { now: [], aside: [] };
    // Each of Dawn's objects for the queue has its own properties.
    const queue = Object.getPrototypeOf(device.queue);
    const { writeBuffer } = queue;
    queue.writeBuffer = function (...call) {
      if (call[2].length >= 2 ** 16) writes.push(call[2].length);
      return writeBuffer.apply(this, call);
    };
    const { createComputePipeline, createComputePipelineAsync } = device;
    device.createComputePipeline = (descriptor) => {
      compiled.now.push(descriptor.label);
      return createComputePipeline.call(device, descriptor);
    };
    device.createComputePipelineAsync = (descriptor) => {
      compiled.aside.push(descriptor.label);
      return createComputePipelineAsync.call(device, descriptor);
    };
    try {
      const triangulator = await createTriangulator({ device, backend: 'gpu', worker });
      for (let seed = 1; seed <= 4; seed++) {
        const points = await generate('uniform', 3000, { seed });
        const mesh = await triangulator.delaunay3d(points);
        const expected = await delaunay3d(points, { backend: 'cpu' });
        assert.equal(fingerprint(mesh.tetrahedra), fingerprint(expected.tetrahedra));
        assert.deepEqual([mesh.stats.backend, mesh.stats.fallback], ['gpu', null]);
      }
      triangulator.dispose();
      assert.deepEqual(writes, [72_000, 72_000]);
      // The calling thread does not wait for a compilation, unless it is the one that triangulates: then
      // it compiles a third of the kernels. No kernel is compiled twice.
      const { now, aside } = compiled;
      const count = now.length + aside.length;
      assert.ok(count > 30, `${count} kernels`);
      const own = [...now, ...aside].filter((label) => label.startsWith('d3/'));
      assert.equal(new Set(own).size, own.length);
      assert.equal(now.length, worker ? 0 : Math.floor(count / 3));
    } finally {
      queue.writeBuffer = writeBuffer;
    }
  });
