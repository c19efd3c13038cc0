// The kernels that cut a mesh on the GPU, in Node by the npm package `webgpu` (Dawn) on Chromium's
// software driver: they find the triangles that the worker finds.

import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { createTriangulator, generate, readPoints } from 'gdel-wasm';
import { createServer } from 'vite';

const swiftshader = '/usr/lib/chromium/vk_swiftshader_icd.json';
if (!process.env.VK_DRIVER_FILES && existsSync(swiftshader))
  process.env.VK_DRIVER_FILES = swiftshader;
const { create } = await import('webgpu');

/** Kept, since Dawn's devices do not outlive their instance. */
const gpu = create([]);

let vite;
/** What the modules of the page export, together. */
let page;
let triangulator;
before(async () => {
  vite = await createServer({
    root: fileURLToPath(new URL('../', import.meta.url)),
    appType: 'custom',
    logLevel: 'error',
    optimizeDeps: { noDiscovery: true },
    server: { middlewareMode: true, hmr: false, ws: false, watch: null },
  });
  page = Object.assign(
    {},
    ...(await Promise.all(
      [
        'cutting',
        'geometry/cut',
        'geometry/filter',
        'geometry/mesh',
        'geometry/plane',
        'geometry/surface',
        'model/model3d',
        'view/cut',
      ].map((name) => vite.ssrLoadModule(`/src/${name}.ts`)),
    )),
  );
  triangulator = await createTriangulator({ backend: 'cpu' });
});
after(async () => {
  triangulator.dispose();
  await vite.close();
});

/** Returns a device, and collects what it complains about. */
async function openDevice(requiredLimits) {
  const device = await (await gpu.requestAdapter()).requestDevice({ requiredLimits });
  device.complaints = [];
  device.addEventListener('uncapturederror', ({ error }) => device.complaints.push(error.message));
  return device;
}

async function read(device, buffer) {
  const staging = device.createBuffer({ size: buffer.size, usage: 9 });
  const encoder = device.createCommandEncoder();
  encoder.copyBufferToBuffer(buffer, 0, staging, 0, buffer.size);
  device.queue.submit([encoder.finish()]);
  await staging.mapAsync(1);
  const numbers = new Uint32Array(staging.getMappedRange().slice());
  staging.destroy();
  return numbers;
}

const NOTHING_ABOUT = { noReturn: 0, up: { axis: 'y', sure: true }, colors: null, heights: null };

/** The mesh of some points as the page's worker has it, with colours of their own. */
async function modelOf(points) {
  const rgb = Uint8Array.from(points, (_, i) => (37 * i) % 256);
  return page.Model3d.make(triangulator, points, {}, { ...NOTHING_ABOUT, colors: { rgb } });
}

const REQUEST = {
  filter: { kind: 'all', alpha: null },
  plane: { normal: [1, 0, 0], keep: null },
  color: 'quality',
  skin: true,
  pieces: false,
  round: null,
  voronoi: false,
};

/** Each triangle of a surface as one text: corners, value, skin and owner. */
function trianglesOf({ positions, values, skin, owners }) {
  return [...owners.keys()].map((i) =>
    [
      positions.subarray(9 * i, 9 * i + 9),
      values.subarray(3 * i, 3 * i + 3),
      skin.subarray(12 * i, 12 * i + 12),
      owners[i],
    ].join(' '),
  );
}

/** The facets that the GPU lists. */
async function listedBy(device, cut) {
  const [vertices, ...others] = await read(device, cut.draw);
  assert.deepEqual(others, [1, 0, 0]);
  assert.equal(vertices % 3, 0);
  return (await read(device, cut.facets)).slice(0, vertices / 3);
}

/** Reads what the GPU has of corners, and returns what makes triangles of the facets that it lists. */
async function readerOf(device, cut) {
  const parts = {};
  for (const name of ['tetrahedra', 'positions', 'values', 'colors'])
    parts[name] = await read(device, cut.parts[name]);
  const positions = new Float32Array(parts.positions.buffer);
  const values = new Float32Array(parts.values.buffer);
  const colors = new Uint8Array(parts.colors.buffer);
  return async () =>
    Array.from(await listedBy(device, cut), (listed) => {
      const facet = (listed & ~page.OUTSIDE) >>> 0;
      const [t, k] = [facet >> 2, facet & 3];
      const corners = [0, 1, 2].map((j) => parts.tetrahedra[4 * t + page.FACETS[3 * k + j]]);
      const skin = (v) => (facet === listed ? [0, 0, 0, 0] : colors.subarray(4 * v, 4 * v + 4));
      return [
        corners.flatMap((v) => [...positions.subarray(3 * v, 3 * v + 3)]),
        corners.map(() => values[t]),
        corners.flatMap((v) => [...skin(v)]),
        t,
      ].join(' ');
    });
}

/**
 * Expects the GPU to find the triangles of the worker, with their colours, wherever the plane is.
 * Returns how many there were in all.
 */
async function expectTheSame(device, model, cutting, keeps) {
  let all = 0;
  for (const request of CHANGES) {
    await model.prepare({ ...REQUEST, ...request });
    const drawing = model.draw({ ...REQUEST, ...request, onGpu: true });
    assert.equal(drawing.surface, null);
    if (cutting.ready) assert.ok(await cutting.follow(drawing.cut));
    else assert.ok(await cutting.begin(device, () => drawing.cut));
    const trianglesOnGpu = await readerOf(device, cutting.ready);
    for (const keep of keeps) {
      const plane = { ...REQUEST.plane, ...request.plane, keep };
      const expected = model.draw({ ...REQUEST, ...request, plane });
      assert.equal(cutting.levelOf(plane), expected.level);
      cutting.ready.at(expected.level, expected.cut.skin);
      const triangles = trianglesOf(expected.surface);
      assert.deepEqual((await trianglesOnGpu()).sort(), triangles.sort());
      all += triangles.length;
    }
  }
  assert.deepEqual(device.complaints, []);
  return all;
}

const CHANGES = [
  {},
  { color: 'volume' },
  { filter: { kind: 'carve', alpha: null } },
  { filter: { kind: 'alpha', alpha: null }, color: 'circumradius' },
  { filter: { kind: 'alpha', alpha: null }, skin: false },
  { filter: { kind: 'carve', alpha: null }, plane: { normal: [0.6, 0, 0.8] } },
];

test('the bunny, whole, carved and filtered', async () => {
  const file = readFileSync(new URL('../../tests/data/bunny.ply', import.meta.url));
  const { points } = await readPoints(new Blob([file]), { name: 'bunny.ply' });
  const model = await modelOf(points);
  const device = await openDevice();
  const cutting = new page.Cutting(model);
  assert.ok((await expectTheSame(device, model, cutting, [0.37, 1])) > 10_000);
  device.destroy();
});

test('points of a ball, some of them twice', async () => {
  const points = await generate('ball', 600);
  const model = await modelOf([...points, ...points.slice(0, 90)]);
  const device = await openDevice();
  const cutting = new page.Cutting(model);
  assert.ok((await expectTheSame(device, model, cutting, [0, 0.1, 0.37, null, 0.8, 1])) > 5000);
  // The mesh is no longer asked for: nothing of it stays.
  const { draw } = cutting.ready;
  cutting.forget();
  assert.equal(cutting.ready, null);
  assert.equal(cutting.levelOf(REQUEST.plane), null);
  assert.equal((await read(device, draw)).length, 4);
  cutting.free();
  await read(device, draw);
  assert.match(device.complaints.join(), /destroyed/);
  device.destroy();
});

test('planes exactly as high as tetrahedra of a grid', async () => {
  const model = await modelOf(await generate('grid', 700));
  const device = await openDevice();
  const cutting = new page.Cutting(model);
  const { cut: of } = model.draw(REQUEST);
  assert.ok(await cutting.begin(device, () => of));
  const { tetrahedra, neighbors } = model.mesh;
  const mesh = { positions: model.positions, tetrahedra, neighbors };
  const heights = page.heightsAlong(REQUEST.plane.normal, mesh);
  const kept = page.keep(null, neighbors);
  const different = new Set(heights.height);
  assert.ok(different.size > 10);
  for (const height of [...different].slice(0, 10)) {
    // The numbers beside it are none of single precision.
    for (const level of [height, height - 1e-12, height + 1e-12]) {
      const { facets } = page.boundaryOf(mesh, kept, heights, level);
      cutting.ready.at(level, false);
      assert.deepEqual((await listedBy(device, cutting.ready)).sort(), facets.sort());
    }
  }
  assert.deepEqual(device.complaints, []);
  device.destroy();
});

test('the order of heights is that of the floats', () => {
  const floats = [-Infinity, -3e38, -1, -1e-45, 0, 1e-45, 1, 3e38, Infinity];
  const ordered = page.inOrder(Float32Array.from(floats));
  assert.deepEqual(ordered, ordered.toSorted());
  assert.equal(new Set(ordered).size, floats.length);
  assert.deepEqual(page.inOrder(Float32Array.of(-0)), page.inOrder(Float32Array.of(0)));
  for (const level of [...floats, -1e-50, 1e-50, 1 + 1e-12, 1 - 1e-12, -1 - 1e-12]) {
    const bound = page.levelInOrder(level);
    floats.forEach((height, i) => {
      // As single precision has it.
      assert.equal(ordered[i] <= bound, Math.fround(height) <= level, `${height} and ${level}`);
    });
  }
});

test('more workgroups than there may be in a row', async () => {
  const model = await modelOf(await generate('uniform', 300));
  const device = await openDevice();
  const { maxBufferSize, maxStorageBufferBindingSize, maxStorageBuffersPerShaderStage } =
    device.limits;
  const limits = {
    maxBufferSize,
    maxStorageBufferBindingSize,
    maxStorageBuffersPerShaderStage,
    maxComputeWorkgroupsPerDimension: 3,
  };
  Object.defineProperty(device, 'limits', { value: limits });
  const drawing = model.draw(REQUEST);
  assert.ok(drawing.total > 3 * 256);
  const cutting = new page.Cutting(model);
  assert.ok(await cutting.begin(device, () => drawing.cut));
  cutting.ready.at(drawing.level, true);
  const triangles = await (await readerOf(device, cutting.ready))();
  assert.deepEqual(triangles.sort(), trianglesOf(drawing.surface).sort());
  assert.deepEqual(device.complaints, []);
  device.destroy();
});

test('of too many facets, as many as there is room for', async () => {
  const model = await modelOf(await generate('uniform', 2000));
  const { cut: of, surface } = model.draw({ ...REQUEST, plane: { normal: [1, 0, 0], keep: 1 } });
  const all = new Set(surface.owners);
  const device = await openDevice();
  const most = 100;
  assert.ok(surface.owners.length > most);
  const cut = await page.Cut.create(device, { ...of, most });
  for (const [part, buffer] of Object.entries(cut.parts))
    cut.write(part, buffer, 0, model.cutPart(part, of.parts[part], 0, of[page.CUT_PARTS[part].of]));
  cut.replace({});
  cut.at(Infinity, false);
  const facets = await listedBy(device, cut);
  assert.equal(new Set(facets).size, most);
  for (const facet of facets) assert.ok(all.has(facet >> 2));
  assert.deepEqual(device.complaints, []);
  device.destroy();
});

test('no tetrahedra, and no room', async () => {
  const model = await modelOf([0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0]);
  const device = await openDevice();
  const cutting = new page.Cutting(model);
  const { cut: of } = model.draw(REQUEST);
  assert.ok(await cutting.begin(device, () => of));
  cutting.ready.at(0, true);
  assert.equal((await listedBy(device, cutting.ready)).length, 0);
  cutting.forget();
  const tetrahedra = device.limits.maxStorageBufferBindingSize / 16 + 1;
  const large = { ...of, tetrahedra };
  assert.equal(await cutting.begin(device, () => large), false);
  assert.equal(cutting.ready, null);
  assert.deepEqual(device.complaints, []);
  device.destroy();
});

test('a worker that does not answer is no error', async () => {
  const model = await modelOf(await generate('uniform', 100));
  const device = await openDevice();
  let asked = 0;
  const cutting = new page.Cutting({
    cutPart: () => {
      asked++;
      throw new Error('gone');
    },
  });
  const { cut: of } = model.draw(REQUEST);
  for (let i = 0; i < 2; i++) assert.equal(await cutting.begin(device, () => of), false);
  assert.deepEqual([asked, cutting.ready], [1, null]);
  device.destroy();
});

test('tetrahedra that take the place of those on the way have room', async () => {
  const [few, many] = [
    await modelOf(await generate('uniform', 100)),
    await modelOf(await generate('uniform', 300)),
  ];
  const device = await openDevice();
  let model = few;
  let asked = 0;
  const drawn = new Map([few, many].map((each) => [each, each.draw(REQUEST)]));
  const cutting = new page.Cutting({
    cutPart: (...about) => {
      // The visitor goes on from the solid of a surface to all tetrahedra.
      if (asked++ === 2) model = many;
      return model.cutPart(...about);
    },
  });
  assert.ok(await cutting.begin(device, () => drawn.get(model).cut));
  const { surface, level } = drawn.get(many);
  cutting.ready.at(level, true);
  assert.deepEqual(
    (await (await readerOf(device, cutting.ready))()).sort(),
    trianglesOf(surface).sort(),
  );
  assert.deepEqual(device.complaints, []);
  device.destroy();
});

test('what changes on the way to the GPU is taken over', async () => {
  const model = await modelOf(await generate('uniform', 300));
  const other = await modelOf(await generate('uniform', 200));
  const device = await openDevice();
  const carved = { ...REQUEST, filter: { kind: 'carve', alpha: null } };
  let drawing = model.draw(REQUEST);
  let asked = 0;
  const cutting = new page.Cutting({
    cutPart: (...about) => {
      // The visitor carves while the mesh is on its way.
      if (asked++ === 3) drawing = model.draw(carved);
      return model.cutPart(...about);
    },
  });
  assert.ok(await cutting.begin(device, () => drawing.cut));
  const { surface, cut, level } = model.draw(carved);
  cutting.ready.at(level, true);
  assert.deepEqual(
    (await (await readerOf(device, cutting.ready))()).sort(),
    trianglesOf(surface).sort(),
  );
  // Another mesh is not this one, and leaves it as it was.
  assert.equal(await cutting.follow(other.draw(REQUEST).cut), false);
  model.draw(REQUEST);
  assert.equal(await cutting.follow({ ...cut, parts: { ...cut.parts, values: 'others' } }), false);
  assert.ok(cutting.ready);
  cutting.ready.at(level, true);
  assert.deepEqual(
    (await (await readerOf(device, cutting.ready))()).sort(),
    trianglesOf(surface).sort(),
  );
  assert.deepEqual(device.complaints, []);
  device.destroy();
});
