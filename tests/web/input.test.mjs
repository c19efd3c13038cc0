// What may be passed, and what everything else is: a typed error that says what is wrong.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import vm from 'node:vm';
import { importFrom, project } from './package.mjs';

const main = await importFrom(project());
const {
  createTriangulator,
  Delaunator,
  delaunay2d,
  delaunay2dSync,
  delaunay3d,
  delaunay3dSync,
  GdelError,
  generate,
  generate2d,
  load2d,
  load3d,
  readPoints,
  verify,
  verify2d,
} = main;
await Promise.all([load2d(), load3d()]);

const TETRAHEDRON = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1];
const SQUARE = [0, 0, 3, 0, 3, 2, 0, 2];

/** The call fails with a GdelError of this code, whose message says this. */
async function fails(call, code, message) {
  const error = await (async () => call())().then(
    () => assert.fail('there was no error'),
    (error) => error,
  );
  assert.ok(error instanceof GdelError, String(error));
  assert.equal(error.code, code, error.message);
  if (message) assert.match(error.message, message);
  return error;
}

test('flat arrays and integers are points', async () => {
  const expected = (await delaunay3d(Float64Array.from(TETRAHEDRON))).tetrahedra;
  assert.equal(expected.length, 4);
  const forms = [
    TETRAHEDRON,
    [
      Int8Array,
      Uint8Array,
      Uint8ClampedArray,
      Int16Array,
      Uint16Array,
      Int32Array,
      Uint32Array,
    ].map((Class) => Class.from(TETRAHEDRON)),
    Uint16Array.from([9, ...TETRAHEDRON]).subarray(1),
    { length: 12, ...TETRAHEDRON },
  ].flatMap((form) => (Array.isArray(form) && typeof form[0] !== 'number' ? form : [form]));
  for (const points of forms) {
    for (const mesh of [await delaunay3d(points), delaunay3dSync(points)]) {
      assert.deepEqual(mesh.tetrahedra, expected);
      assert.deepEqual([...mesh.points], TETRAHEDRON);
    }
  }
  assert.equal((await delaunay2d(SQUARE)).triangles.length, 6);
  assert.equal((await delaunay2d(Int16Array.from(SQUARE))).triangles.length, 6);
  assert.ok((await delaunay2d(Int16Array.from(SQUARE))).coords instanceof Float32Array);
  assert.ok((await delaunay2d(Int32Array.from(SQUARE))).coords instanceof Float64Array);
  assert.equal((await verify2d(SQUARE, await delaunay2d(SQUARE))).passed, true);
});

test('integers keep their value', async () => {
  for (const [Class, x] of [
    [Uint32Array, 2 ** 32 - 1],
    [Int32Array, -(2 ** 31)],
    [Uint16Array, 2 ** 16 - 1],
    [Int16Array, -(2 ** 15)],
  ])
    assert.deepEqual([...(await delaunay2d(Class.of(x, 0))).coords], [x, 0]);
});

test('flat numbers that are not numbers or not whole points are errors', async () => {
  await fails(() => delaunay3d([0, 1, 2, 3]), 'BAD_INPUT', /multiple of 3/);
  const error = await fails(
    () => delaunay3d([0, 1, 2, 3, '4', 5]),
    'BAD_INPUT',
    /coordinate 4.*"4"/,
  );
  assert.equal(error.index, 1);
  await fails(() => delaunay3d([0, 1, 2, [3, 4, 5]]), 'BAD_INPUT');
  await fails(() => delaunay3d([0, 1, NaN]), 'NOT_FINITE', /point 0: the z/);
  await fails(() => delaunay3d(new BigInt64Array(3)), 'BAD_INPUT', /BigInt64Array/);
  await fails(() => delaunay3d(new DataView(new ArrayBuffer(24))), 'BAD_INPUT', /DataView/);
});

test('arrays of another realm are as good as our own', async () => {
  const realm = vm.createContext({ TETRAHEDRON, SQUARE });
  const there = (code) => vm.runInContext(code, realm);
  assert.ok(!(there('Float32Array.from(TETRAHEDRON)') instanceof Float32Array));
  const expected = (await delaunay3d(TETRAHEDRON)).tetrahedra;
  for (const code of [
    'Float32Array.from(TETRAHEDRON)',
    'Float64Array.from(TETRAHEDRON)',
    'Int8Array.from(TETRAHEDRON)',
    '[...TETRAHEDRON]',
    '[[0, 0, 0], new Float32Array([1, 0, 0]), [0, 1, 0], [0, 0, 1]]',
  ]) {
    for (const mesh of [
      await delaunay3d(there(code)),
      delaunay3dSync(there(code)),
      await delaunay3d(there(code), there('({ transfer: true })')),
    ])
      assert.deepEqual(mesh.tetrahedra, expected, code);
  }
  const coords = there('Float64Array.from(SQUARE)');
  assert.equal(new Delaunator(coords).coords, coords);
  assert.equal(new Delaunator(coords).triangles.length, 6);
  assert.equal(
    (await verify(there('TETRAHEDRON'), there(`({ tetrahedra: new Uint32Array([${expected}]) })`)))
      .passed,
    true,
  );
  assert.equal(
    (await readPoints(there('new Uint8Array([49, 32, 50, 32, 51, 10])'), { format: 'xyz' })).points
      .length,
    3,
  );
  assert.equal(
    (await readPoints(there('new Uint8Array([49, 32, 50, 32, 51, 10]).buffer'), { format: 'xyz' }))
      .points.length,
    3,
  );
  const given = there('Float64Array.from(TETRAHEDRON)');
  await delaunay3d(given, { transfer: true });
  assert.equal(given.length, 0);
  // The worker is a place of its own already; this is the calling thread.
  const caller = await createTriangulator({ worker: false });
  const mesh = await caller.delaunay3d(there('Float64Array.from(TETRAHEDRON)'));
  assert.ok(mesh.points instanceof Float64Array);
  caller.dispose();
});

test('detached arrays are named', async () => {
  const detached = (array) => {
    structuredClone(array, { transfer: [array.buffer] });
    return array;
  };
  await fails(() => delaunay3d(detached(new Float64Array(6))), 'BAD_INPUT', /detached/);
  await fails(() => delaunay3d(detached(new Int32Array(6))), 'BAD_INPUT', /detached/);
  await fails(() => delaunay3dSync(detached(new Float64Array(6))), 'BAD_INPUT', /detached/);
  await fails(() => new Delaunator(detached(new Float64Array(6))), 'BAD_INPUT', /detached/);
  await fails(
    () => verify(detached(new Float64Array(6)), { tetrahedra: new Uint32Array(4) }),
    'BAD_INPUT',
    /detached/,
  );
  await fails(
    () => verify(TETRAHEDRON, { tetrahedra: detached(new Uint32Array(4)) }),
    'BAD_INPUT',
    /tetrahedra.*detached/,
  );
  await fails(
    () => readPoints(detached(new Uint8Array(4)), { format: 'xyz' }),
    'BAD_INPUT',
    /detached/,
  );
  const mesh = await delaunay3d(TETRAHEDRON);
  detached(mesh.hull);
  await fails(() => mesh.toPLY(), 'BAD_INPUT', /hull.*detached/);
  detached(mesh.points);
  await fails(() => mesh.toVTU(), 'BAD_INPUT', /points.*detached/);
});

test('options that are none are typed errors', async () => {
  const mesh = await delaunay3d(TETRAHEDRON);
  const triangulator = await createTriangulator({ backend: 'cpu' });
  const calls = [
    (options) => delaunay3d(TETRAHEDRON, options),
    (options) => delaunay2d(SQUARE, options),
    (options) => delaunay3dSync(TETRAHEDRON, options),
    (options) => delaunay2dSync(SQUARE, options),
    (options) => triangulator.delaunay3d(TETRAHEDRON, options),
    (options) => triangulator.delaunay2d(SQUARE, options),
    (options) => createTriangulator(options),
    (options) => generate('ball', 3, options),
    (options) => generate2d('disk', 3, options),
    (options) => readPoints(new Uint8Array(4), options),
    (options) => verify(TETRAHEDRON, mesh, options),
    (options) => verify2d(SQUARE, { triangles: new Uint32Array(3) }, options),
    (options) => mesh.toVTU(options),
  ];
  for (const [i, call] of calls.entries()) {
    for (const options of [null, 'cpu', 7, true, ['cpu'], () => {}])
      await fails(() => call(options), 'BAD_INPUT', /options must be an object/, `call ${i}`);
  }
  triangulator.dispose();
});

test('each option is checked', async () => {
  const bad = (options, message) =>
    fails(() => delaunay3d(TETRAHEDRON, options), 'BAD_INPUT', message);
  for (const signal of [{}, null, 'now', new EventTarget()])
    await bad({ signal }, /signal must be an AbortSignal/);
  await bad({ onProgress: 'log' }, /onProgress must be a function/);
  await bad({ onProgress: null }, /onProgress must be a function/);
  await bad({ backend: 'tpu' }, /backend must be one of auto, gpu, cpu, not "tpu"/);
  await bad({ backend: null }, /backend/);
  await bad({ transfer: 'yes' }, /transfer must be true or false/);
  await bad({ point: {} }, /point must be a function/);
  await bad({ outputs: 'hull' }, /outputs must be an array/);
  await bad({ outputs: ['faces'] }, /neighbors, hull, duplicateOf, trace, not "faces"/);
  for (const gpu of [{}, 'webgpu', null])
    await fails(() => createTriangulator({ gpu }), 'BAD_INPUT', /gpu must be a GPU object/);
  await fails(() => createTriangulator({ worker: 'no' }), 'BAD_INPUT', /worker/);
  await fails(() => createTriangulator({ selfTest: 'no' }), 'BAD_INPUT', /selfTest/);
  await fails(() => createTriangulator({ backend: 'tpu' }), 'BAD_INPUT', /backend/);
  for (const option of ['signal', 'onProgress', 'backend', 'transfer'])
    await fails(
      () => delaunay3dSync(TETRAHEDRON, { [option]: true }),
      'BAD_INPUT',
      new RegExp(`do not have the option ${option}`),
    );
});

test('a GPU object that fails is the reason why there is no adapter', async () => {
  for (const requestAdapter of [
    () => 5,
    () => {
      throw new Error('mine');
    },
    async () => {
      throw new Error('mine');
    },
    async () => ({}),
    async () => null,
  ]) {
    await fails(
      () => createTriangulator({ gpu: { requestAdapter }, backend: 'gpu' }),
      'NO_ADAPTER',
      /WebGPU/,
    );
    const triangulator = await createTriangulator({ gpu: { requestAdapter } });
    assert.equal(triangulator.info.backend, 'cpu');
    assert.match(triangulator.info.fallback, /WebGPU/);
    triangulator.dispose();
  }
});

test('other arguments are checked', async () => {
  for (const mesh of [null, undefined, 7, 'mesh']) {
    await fails(() => verify(TETRAHEDRON, mesh), 'BAD_INPUT', /mesh must be an object/);
    await fails(() => verify2d(SQUARE, mesh), 'BAD_INPUT', /mesh must be an object/);
  }
  const { tetrahedra } = await delaunay3d(TETRAHEDRON);
  for (const [name, value] of [
    ['tetrahedra', [0, 1, 2, 3]],
    ['tetrahedra', null],
    ['neighbors', 'none'],
    ['neighbors', new Uint32Array(4)],
    ['hull', [0, 1, 2]],
    ['duplicateOf', null],
    ['dimension', 4],
    ['dimension', '3'],
  ])
    await fails(
      () => verify(TETRAHEDRON, { tetrahedra, [name]: value }),
      'BAD_INPUT',
      new RegExp(name),
    );
  for (const points of [null, undefined, 7, 'points', {}]) {
    await fails(() => delaunay3d(points), 'BAD_INPUT');
    await fails(() => delaunay3dSync(points), 'BAD_INPUT');
    await fails(() => verify(points, { tetrahedra }), 'BAD_INPUT');
    await fails(() => Delaunator.from(points), 'BAD_INPUT');
  }
  for (const coords of [null, undefined, 7, {}])
    await fails(() => new Delaunator(coords), 'BAD_INPUT');
  for (const kind of [Symbol('ball'), () => {}, null, {}])
    await fails(() => generate(kind, 3), 'BAD_INPUT', /distribution/);
  for (const seed of [-1, 1.5, '1', 1n])
    await fails(() => generate('ball', 3, { seed }), 'BAD_INPUT', /seed/);
  for (const data of [null, undefined, {}, '1 2 3', new Float32Array(3)])
    await fails(() => readPoints(data, { format: 'xyz' }), 'BAD_INPUT', /file must be/);
  await fails(
    () => readPoints(new Uint8Array(3), { format: 5 }),
    'BAD_INPUT',
    /format must be a string/,
  );
});

test('points that are given away come back with the error', async () => {
  const given = Float64Array.of(0, 0, 0, 0, NaN, 0);
  const error = await fails(() => delaunay3d(given, { transfer: true }), 'NOT_FINITE');
  assert.equal(given.length, 0);
  assert.deepEqual([...error.points], [0, 0, 0, 0, NaN, 0]);
  assert.ok(!Object.keys(error).includes('points'));
  const copied = await fails(() => delaunay3d(Float64Array.of(0, 0, NaN)), 'NOT_FINITE');
  assert.equal(copied.points, undefined);

  const inCaller = await createTriangulator({ worker: false });
  const here = await fails(
    () => inCaller.delaunay2d(Float32Array.of(0, Infinity), { transfer: true }),
    'NOT_FINITE',
  );
  assert.deepEqual([...here.points], [0, Infinity]);
  inCaller.dispose();
  const late = await fails(
    () => inCaller.delaunay3d(Float64Array.from(TETRAHEDRON), { transfer: true }),
    'DISPOSED',
  );
  assert.deepEqual([...late.points], TETRAHEDRON);

  // What is wrong at first sight is not taken.
  const odd = new Float64Array(4);
  await fails(() => delaunay3d(odd, { transfer: true }), 'BAD_INPUT');
  assert.equal(odd.length, 4);
});

test('memory that cannot be transferred is a typed error or is copied', async (t) => {
  const shared = new Float64Array(new SharedArrayBuffer(96));
  shared.set(TETRAHEDRON);
  assert.equal((await delaunay3d(shared, { transfer: true })).tetrahedra.length, 4);
  // As for the memory of WebAssembly, in browsers.
  t.mock.method(globalThis, 'structuredClone', () => {
    throw new DOMException('no', 'DataCloneError');
  });
  const points = Float64Array.from(TETRAHEDRON);
  await fails(() => delaunay3d(points, { transfer: true }), 'BAD_INPUT', /cannot be transferred/);
});
