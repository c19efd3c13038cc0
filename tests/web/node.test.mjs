// The installed package in Node: the CPU backend in a worker thread, bad input, cancellation,
// files.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { NodeIO } from '@gltf-transform/core';
import Delaunator from 'delaunator';
import { abortOf } from './abort.mjs';
import { e57 } from './e57.mjs';
import { fingerprint } from './fingerprints.mjs';
import { importFrom, pinned, project, root } from './package.mjs';

const folder = project();
const {
  createTriangulator,
  delaunay2d,
  delaunay3d,
  generate,
  generate2d,
  GdelError,
  Mesh2,
  Mesh3,
  readPoints,
  verify,
  verify2d,
} = await importFrom(folder);

const TETRAHEDRON = [
  [0, 0, 0],
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];

/** The promise is rejected with a GdelError of this code, whose message says this. */
async function rejects(promise, code, message) {
  await assert.rejects(promise, (error) => {
    assert.ok(error instanceof GdelError, String(error));
    assert.equal(error.code, code, error.message);
    if (message) assert.match(error.message, message);
    return true;
  });
}

test('the meshes are the native ones', async () => {
  for (const { kind, count, seed, tetrahedra, fingerprint: expected } of pinned) {
    const points = await generate(kind, count, { seed });
    const mesh = await delaunay3d(points);
    assert.equal(mesh.tetrahedra.length / 4, tetrahedra, kind);
    assert.equal(fingerprint(mesh.tetrahedra), expected, kind);
    const report = await verify(points, mesh);
    assert.ok(report.passed, JSON.stringify(report));
    assert.equal(report.counts.tetrahedra, tetrahedra);
    assert.equal(report.checks.length, 15);
  }
});

test('the verifier finds what is wrong', async () => {
  const mesh = await delaunay3d(TETRAHEDRON);
  const turned = { tetrahedra: mesh.tetrahedra.slice().reverse().fill(mesh.tetrahedra[1], 0, 1) };
  assert.equal((await verify(TETRAHEDRON, turned)).passed, false);
  const swapped = Uint32Array.of(...[1, 0, 2, 3].map((k) => mesh.tetrahedra[k]));
  const report = await verify(TETRAHEDRON, { tetrahedra: swapped });
  assert.deepEqual(
    report.checks.filter(({ outcome }) => outcome === 'failed').map(({ name }) => name),
    ['orientation'],
  );
  await rejects(verify(TETRAHEDRON, {}), 'BAD_INPUT');
});

test('every form of points gives the same mesh', async () => {
  const expected = (await delaunay3d(TETRAHEDRON)).tetrahedra;
  assert.equal(expected.length, 4);
  const flat = TETRAHEDRON.flat();
  const objects = TETRAHEDRON.map(([x, y, z]) => ({ x, y, z }));
  const forms = [
    [Float32Array.from(flat)],
    [Float64Array.from(flat)],
    // A view of a part of a buffer.
    [Float32Array.from([7, ...flat, 7]).subarray(1, 13)],
    [TETRAHEDRON.map((row) => Float32Array.from(row))],
    [TETRAHEDRON.map((row) => [...row, 'more', 'columns'])],
    [objects, { point: ({ x, y, z }) => [x, y, z] }],
    [Float32Array.of(0, 1, 2, 3), { point: (i) => TETRAHEDRON[i] }],
  ];
  for (const [points, options] of forms)
    assert.deepEqual((await delaunay3d(points, options)).tetrahedra, expected);
});

test('coplanar, collinear, equal and no points have their dimension', async () => {
  const plane = [
    [0, 0, 0],
    [1, 0, 0],
    [0, 1, 0],
    [1, 1, 0],
    [0.5, 0.5, 0],
  ];
  const cases = [
    [plane, 2],
    [plane.map(([x]) => [x, x, x]), 1],
    [
      [
        [1, 2, 3],
        [1, 2, 3],
      ],
      0,
    ],
    [[], 0],
  ];
  for (const [points, dimension] of cases) {
    const mesh = await delaunay3d(points);
    assert.equal(mesh.dimension, dimension);
    assert.equal(mesh.tetrahedra.length, 0);
  }
  assert.deepEqual(
    (
      await delaunay3d([
        [1, 2, 3],
        [1, 2, 3],
      ])
    ).duplicateOf,
    Int32Array.of(-1, 0),
  );
});

test('in 2D, the triangles are those of delaunator', async () => {
  const points = (await generate('uniform', 3000)).subarray(0, 2 * 4000);
  const mesh = await delaunay2d(points);
  const theirs = new Delaunator(points);
  const canonical = (triangles) => {
    const rows = [];
    for (let t = 0; t < triangles.length; t += 3) {
      const [a, b, c] = triangles.subarray(t, t + 3);
      rows.push(a < b && a < c ? [a, b, c] : b < c ? [b, c, a] : [c, a, b]);
    }
    return rows.map((row) => row.join(' ')).sort();
  };
  assert.deepEqual(canonical(mesh.triangles), canonical(theirs.triangles));
  for (const [e, twin] of mesh.halfedges.entries())
    if (twin >= 0) assert.equal(mesh.halfedges[twin], e);
  assert.deepEqual([...mesh.hull].sort(), [...theirs.hull].sort());
  assert.equal(mesh.dimension, 2);
  assert.equal(mesh.coords.length, points.length);
  assert.equal(
    (
      await delaunay2d([
        [0, 0],
        [1, 1],
        [2, 2],
      ])
    ).dimension,
    1,
  );
  await rejects(delaunay2d(new Float32Array(3)), 'BAD_INPUT', /multiple of 2/);
  await rejects(delaunay2d([[0, Infinity]]), 'NOT_FINITE', /point 0: the y/);
});

test('in 2D, hard input is proven, and what is wrong is found', async () => {
  for (const kind of [
    'uniform',
    'gaussian',
    'disk',
    'circle',
    'thin-circle',
    'grid',
    'two-lines',
    'clusters',
  ]) {
    const points = await generate2d(kind, 2000, { seed: 7 });
    assert.equal(points.length, 4000);
    const mesh = await delaunay2d(points);
    assert.ok(mesh instanceof Mesh2);
    const report = await verify2d(points, mesh);
    assert.deepEqual(
      report.checks.filter(({ passed }) => !passed),
      [],
      kind,
    );
    assert.equal(report.counts.triangles, mesh.triangles.length / 3);
    assert.equal(report.counts.hullEdges, mesh.hull.length);
  }
  const square = Float64Array.of(0, 0, 3, 0, 3, 2, 0, 2.5);
  const { triangles } = await delaunay2d(square);
  assert.equal((await verify2d(square, { triangles })).counts.edges, 5);
  const turned = triangles.slice();
  [turned[0], turned[1]] = [turned[1], turned[0]];
  const { passed, checks } = await verify2d(square, { triangles: turned });
  assert.equal(passed, false);
  assert.equal(checks.find(({ name }) => name === 'orientation').outcome, 'failed');
  await rejects(verify2d(square, {}), 'BAD_INPUT');
  await rejects(generate2d('sphere', 10), 'BAD_INPUT', /thin-circle/);
  await rejects(generate2d('disk', -1), 'BAD_INPUT');
});

test('2D meshes as files', async () => {
  const mesh = await delaunay2d([
    [0, 0],
    [3, 0],
    [3, 2],
    [0, 2.5],
  ]);
  const text = (bytes) => Buffer.from(bytes).toString('latin1');
  assert.match(text(await mesh.toVTU()), /NumberOfPoints="4" NumberOfCells="2"/);
  assert.match(text(await mesh.toPLY()), /^ply.*element face 2/s);
  assert.equal(text(await mesh.toOBJ()).match(/^f /gm).length, 2);
  assert.equal(new DataView((await mesh.toSTL()).buffer).getUint32(80, true), 2);
  assert.match(text(await mesh.toNPZ()), /^PK.*triangles\.npy.*halfedges\.npy/s);
  const { node, ele, neigh } = await mesh.toTriangle();
  assert.match(text(node), /^4 2 0 0/);
  assert.match(text(ele), /^2 3 0/);
  assert.match(text(neigh), /^2 3/);
});

test('bad input is a typed error that says what and where', async () => {
  const detached = new Float64Array(6);
  structuredClone(detached, { transfer: [detached.buffer] });
  const cases = [
    [undefined, 'BAD_INPUT', /undefined/],
    [null, 'BAD_INPUT'],
    [7, 'BAD_INPUT'],
    ['points', 'BAD_INPUT'],
    [{}, 'BAD_INPUT'],
    [new BigInt64Array(3), 'BAD_INPUT', /BigInt64Array/],
    [new DataView(new ArrayBuffer(8)), 'BAD_INPUT'],
    [new Float32Array(4), 'BAD_INPUT', /multiple of 3/],
    [detached, 'BAD_INPUT', /detached/],
    [
      [
        [0, 0, 0],
        [0, 0],
      ],
      'BAD_INPUT',
      /point 1/,
    ],
    [[[0, 0, 0], null], 'BAD_INPUT', /point 1/],
    [
      [
        [0, 0, 0],
        [0, 0, '1'],
      ],
      'BAD_INPUT',
      /point 1: coordinate 2/,
    ],
    [
      [
        [0, 0, 0],
        [0, 0, undefined],
      ],
      'BAD_INPUT',
      /point 1/,
    ],
    [[0, 0, 0, 0], 'BAD_INPUT', /multiple of 3/],
    [
      [
        [0, 0, 0],
        [0, NaN, 0],
      ],
      'NOT_FINITE',
      /point 1: the y coordinate is NaN/,
    ],
    [Float32Array.of(0, 0, 0, 0, 0, -Infinity), 'NOT_FINITE', /point 1: the z/],
    [{ length: 2 ** 32 }, 'TOO_MANY_POINTS'],
    [{ length: 2 ** 52 }, 'TOO_MANY_POINTS'],
    [{ length: -1 }, 'BAD_INPUT'],
    [{ length: 1.5 }, 'BAD_INPUT'],
  ];
  for (const [points, code, message] of cases) await rejects(delaunay3d(points), code, message);
  await assert.rejects(
    delaunay3d([
      [0, 0, 0],
      [0, NaN, 0],
    ]),
    { index: 1 },
  );
  await rejects(delaunay3d(TETRAHEDRON, { backend: 'tpu' }), 'BAD_INPUT', /tpu/);
  await rejects(delaunay3d(TETRAHEDRON, { outputs: ['faces'] }), 'BAD_INPUT', /faces/);
  await rejects(delaunay3d(TETRAHEDRON, { outputs: 'hull' }), 'BAD_INPUT', /hull/);
  await rejects(delaunay3d(TETRAHEDRON, { point: 'x' }), 'BAD_INPUT');
  await rejects(delaunay3d(TETRAHEDRON, { backend: 'gpu' }), 'NO_ADAPTER');
  await rejects(createTriangulator({ backend: 'gpu' }), 'NO_ADAPTER');
  await rejects(generate('cube', 10), 'BAD_INPUT', /uniform/);
  for (const count of [-1, 1.5, NaN, 2 ** 32, '7'])
    await rejects(generate('uniform', count), 'BAD_INPUT');
  // After all that, the shared triangulator works.
  assert.equal((await delaunay3d(TETRAHEDRON)).tetrahedra.length, 4);
});

test('an error in an accessor is the caller’s own', async () => {
  const point = () => {
    throw new RangeError('mine');
  };
  await assert.rejects(delaunay3d([1], { point }), { name: 'RangeError', message: 'mine' });
});

test('outputs selects what is copied', async () => {
  const mesh = await delaunay3d(TETRAHEDRON, { outputs: ['hull'] });
  assert.equal(mesh.hull.length, 12);
  assert.equal(mesh.neighbors.length, 0);
  assert.equal(mesh.duplicateOf.length, 0);
  await rejects(mesh.toTetGen(), 'BAD_INPUT', /neighbors/);
  assert.ok((await mesh.toPLY()).length > 0);
});

test('the input is copied, or given away and given back', async () => {
  const points = Float64Array.from(TETRAHEDRON.flat());
  const copied = delaunay3d(points);
  points.fill(0);
  assert.deepEqual([...(await copied).points], TETRAHEDRON.flat());
  const given = Float64Array.from(TETRAHEDRON.flat());
  const transferred = delaunay3d(given, { transfer: true });
  assert.equal(given.length, 0);
  assert.deepEqual([...(await transferred).points], TETRAHEDRON.flat());
});

test('several runs at once take their turns', async () => {
  const inputs = [10, 500, 50, 1000].map((n) => generate('ball', n));
  const meshes = await Promise.all(inputs.map(async (points) => delaunay3d(await points)));
  for (const [i, mesh] of meshes.entries())
    assert.equal(mesh.points.length, (await inputs[i]).length);
});

test('progress rises from 0 to 1', async () => {
  const fractions = [];
  const points = await generate('uniform', 100_000);
  await delaunay3d(points, {
    onProgress: ({ phase, fraction }) => fractions.push(fraction) && assert.ok(phase),
  });
  assert.ok(fractions.length > 3);
  assert.deepEqual(
    fractions,
    fractions.slice().sort((a, b) => a - b),
  );
  assert.equal(fractions.at(-1), 1);
});

test('an abort takes effect at once, and the triangulator keeps working', async () => {
  const triangulator = await createTriangulator({ backend: 'cpu' });
  const points = await generate('uniform', 200_000);
  await rejects(triangulator.delaunay3d(points, { signal: AbortSignal.abort() }), 'ABORTED');
  const aborted = await abortOf((options) => triangulator.delaunay3d(points, options), 'insert');
  assert.deepEqual(aborted, { code: 'ABORTED', atOnce: true });
  const small = await triangulator.delaunay3d(TETRAHEDRON);
  assert.equal(small.tetrahedra.length, 4);
  const own = new Error('my reason');
  await assert.rejects(triangulator.delaunay3d(points, { signal: AbortSignal.abort(own) }), own);
  triangulator.dispose();
  await rejects(triangulator.delaunay3d(TETRAHEDRON), 'DISPOSED');
});

test('a disposed triangulator fails its runs and lets the others work', async () => {
  const triangulator = await createTriangulator({ backend: 'cpu' });
  assert.deepEqual(
    { ...triangulator.info },
    {
      backend: 'cpu',
      fallback: null,
      adapter: null,
      thread: 'worker',
      whyThread: null,
      whyInlined: null,
    },
  );
  const run = triangulator.delaunay3d(await generate('uniform', 300_000), {
    onProgress: () => triangulator.dispose(),
  });
  await rejects(run, 'DISPOSED');
  assert.equal((await delaunay3d(TETRAHEDRON)).tetrahedra.length, 4);
});

test('without a worker, runs take place in the calling thread', async () => {
  const triangulator = await createTriangulator({ worker: false });
  assert.equal(triangulator.info.thread, 'caller');
  const controller = new AbortController();
  const points = await generate('uniform', 200_000);
  let reports = 0;
  const onProgress = () => ++reports === 2 && controller.abort();
  await rejects(
    triangulator.delaunay3d(points, { signal: controller.signal, onProgress }),
    'ABORTED',
  );
  const mesh = await triangulator.delaunay3d(TETRAHEDRON);
  assert.equal(mesh.stats.thread, 'caller');
  assert.match(mesh.stats.whyThread, /option worker/);
  triangulator.dispose();
});

test('50 runs need no more memory than a few', async () => {
  const triangulator = await createTriangulator({ backend: 'cpu' });
  const points = await generate('uniform', 20_000);
  const bytes = [];
  for (let i = 0; i < 50; i++) bytes.push((await triangulator.delaunay3d(points)).stats.wasmBytes);
  assert.equal(bytes.at(-1), bytes[2]);
  triangulator.dispose();
});

test('one million points fit into 700 MB', async () => {
  const triangulator = await createTriangulator({ backend: 'cpu' });
  const { stats, tetrahedra } = await triangulator.delaunay3d(
    await generate('uniform', 1_000_000),
    {
      transfer: true,
    },
  );
  assert.ok(tetrahedra.length > 4 * 6_700_000);
  assert.ok(stats.wasmBytes < 700e6, `${stats.wasmBytes}`);
  triangulator.dispose();
});

test('files are read, and what is broken is said', async () => {
  const file = (name) => readFileSync(join(root, 'tests/data', name));
  const bunny = await readPoints(file('bunny.ply'), { name: 'bunny.ply' });
  assert.ok(bunny.points instanceof Float32Array);
  assert.equal(bunny.points.length, 3 * 35947);
  assert.equal(bunny.noReturn, 0);
  const named = new File([file('bunny.ply')], 'b.PLY');
  assert.deepEqual((await readPoints(named)).points, bunny.points);
  const text = new TextEncoder();
  assert.deepEqual(
    (await readPoints(text.encode('1 2 3\n4 5 6\n'), { format: 'xyz' })).points,
    Float64Array.of(1, 2, 3, 4, 5, 6),
  );
  // Points in the plane.
  const flat = text.encode('name,y,x\nA,2,1\nB,4,3\n');
  const plane = await readPoints(flat, { format: 'csv', dimension: 2 });
  assert.deepEqual(plane.points, Float64Array.of(1, 2, 3, 4));
  await rejects(readPoints(flat, { format: 'csv' }), 'BAD_FILE', /z/);
  const above = await readPoints(named, { dimension: 2 });
  assert.equal(above.points.length, 2 * 35947);
  assert.deepEqual(above.points.slice(0, 2), bunny.points.slice(0, 2));
  await rejects(readPoints(flat, { format: 'csv', dimension: 4 }), 'BAD_INPUT', /2 or 3/);
  await rejects(readPoints(text.encode('1 2 3\n4 5 ?\n'), { format: 'xyz' }), 'BAD_FILE', /line 2/);
  await rejects(readPoints(text.encode('1 2 3'), { format: 'doc' }), 'UNKNOWN_FORMAT', /doc/);
  await rejects(readPoints(text.encode('1 2 3')), 'UNKNOWN_FORMAT');
  await rejects(readPoints('1 2 3', { format: 'xyz' }), 'BAD_INPUT');
  await rejects(readPoints(new Uint8Array(1000), { format: 'las' }), 'BAD_FILE');
  await rejects(readPoints(new Blob([]), { format: 'ply' }), 'BAD_FILE', /empty/);
  assert.equal((await readPoints(text.encode('1 2 3'), { format: 'xyz' })).points.length, 3);
});

test('points bring their colours along, or what can stand for them', async () => {
  const text = new TextEncoder();
  const read = (rows) => readPoints(text.encode(rows), { format: 'xyz' });
  const colored = await read('0 0 0 255 0 51\n1 2 3 0 102 255\n');
  assert.deepEqual(colored.colors, Uint8Array.of(255, 0, 51, 0, 102, 255));
  assert.equal(colored.colorSource, 'rgb');
  const bright = await read('0 0 0 0.5\n1 2 3 0.7\n');
  assert.deepEqual(bright.colors, Uint8Array.of(0, 0, 0, 255, 255, 255));
  assert.equal(bright.colorSource, 'intensity');
  const turned = await read('0 0 0 0 0 1\n1 2 3 0 1 0\n');
  assert.equal(turned.colorSource, 'normals');
  assert.deepEqual(turned.normals, Float32Array.of(0, 0, 1, 0, 1, 0));
  assert.deepEqual([turned.sensors, colored.normals], [null, null]);
  const plain = await read('0 0 0\n1 2 3\n');
  assert.equal(plain.colors, null);
  assert.equal(plain.colorSource, null);
});

test('scans of E57 are read, and what is broken is said', async () => {
  const count = 1000;
  const points = Array.from({ length: count }, (_, i) => [i, -i / 4, i * i]);
  const states = points.map((_, i) => (i % 10 === 9 ? 2 : 0));
  const file = e57(points, states);
  const scan = await readPoints(new File([file], 'scan.E57'));
  const returned = points.filter((_, i) => states[i] === 0);
  assert.deepEqual(scan.points, Float32Array.from(returned.flat()));
  assert.equal(scan.noReturn, count / 10);
  const damaged = Uint8Array.from(file);
  damaged[2000] ^= 1;
  await rejects(readPoints(damaged, { format: 'e57' }), 'BAD_FILE', /point 0: .*checksum/);
  const cut = file.subarray(0, 2048);
  await rejects(readPoints(cut, { format: 'e57' }), 'BAD_FILE', /truncated/);
});

test('meshes and hulls are written', async () => {
  const points = Float32Array.from([...TETRAHEDRON.flat(), 1, 1, 1]);
  const mesh = await delaunay3d(points);
  assert.ok(mesh instanceof Mesh3);
  const text = (bytes) => new TextDecoder('latin1').decode(bytes);
  assert.match(text(await mesh.toVTU()), /NumberOfPoints="5" NumberOfCells="2"/);
  assert.match(text(await mesh.toPLY()), /element face 6/);
  assert.equal(text(await mesh.toOBJ()).match(/^f /gm).length, 6);
  assert.equal((await mesh.toSTL()).length, 84 + 50 * 6);
  assert.match(text(await mesh.toNPZ()), /^PK.*tetrahedra\.npy/s);
  const { node, ele, neigh } = await mesh.toTetGen();
  for (const [file, first] of [
    [node, /^5 3/],
    [ele, /^2 4/],
    [neigh, /^2 4/],
  ])
    assert.match(text(file).replace(/^#.*\n/gm, ''), first);
  // What is written can be read, GLB by a reader of others.
  const [facets] = (await new NodeIO().readBinary(await mesh.toGLB()))
    .getRoot()
    .listMeshes()[0]
    .listPrimitives();
  assert.equal(facets.getIndices().getCount(), 3 * 6);
  const corners = facets.getAttribute('POSITION');
  const read = Array.from({ length: corners.getCount() }, (_, i) =>
    corners.getElement(i, []).join(),
  );
  assert.deepEqual(read.sort(), [...TETRAHEDRON, [1, 1, 1]].map((p) => p.join()).sort());
  assert.deepEqual((await readPoints(await mesh.toPLY(), { format: 'ply' })).points, points);
});

test('importing touches nothing, and the process ends by itself', () => {
  writeFileSync(
    join(folder, 'main.mjs'),
    `const before = Object.getOwnPropertyNames(globalThis).length;
     const { delaunay3d } = await import('gdel-wasm');
     if (Object.getOwnPropertyNames(globalThis).length !== before) throw new Error('globals');
     console.log((await delaunay3d(${JSON.stringify(TETRAHEDRON)})).tetrahedra.length);`,
  );
  const output = execFileSync(process.execPath, [...process.execArgv, 'main.mjs'], {
    cwd: folder,
    encoding: 'utf8',
  });
  assert.equal(output, '4\n');
});
