// Closed surfaces through the points of meshes, in the installed package.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { abortOf } from './abort.mjs';
import { hashOf } from './fingerprints.mjs';
import { importFrom, project, root } from './package.mjs';

const { delaunay2d, delaunay3d, GdelError, generate, generate2d, readPoints, Surface3 } =
  await importFrom(project());

/** The corners of a cube and of a smaller one inside it. */
const corners = (low, high) =>
  [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [0, 1, 2].map((axis) => ((i >> axis) & 1 ? high : low)));

/** Points on the faces of a box, on a grid. */
function box(side) {
  const points = [];
  for (let x = 0; x <= side; x++)
    for (let y = 0; y <= side; y++)
      for (let z = 0; z <= side; z++)
        if ([x, y, z].some((i) => i === 0 || i === side)) points.push([x, y, z]);
  return points;
}

/** Every edge is there once in each direction. */
function assertClosed({ triangles }) {
  const edges = new Set();
  for (let t = 0; t < triangles.length; t += 3)
    for (let k = 0; k < 3; k++) edges.add(`${triangles[t + k]} ${triangles[t + ((k + 1) % 3)]}`);
  assert.equal(edges.size, triangles.length);
  for (const edge of edges) assert.ok(edges.has(edge.split(' ').reverse().join(' ')));
}

test('surfaces are those of the native library, bit for bit', async () => {
  const pinned = readFileSync(join(root, 'tests/data/surfaces.txt'), 'utf8').trim().split('\n');
  for (const line of pinned.slice(1)) {
    const [dimension, kind, count, seed, smooth, facets, fingerprint] = line.split(' ');
    const [make, triangulate] =
      dimension === '3' ? [generate, delaunay3d] : [generate2d, delaunay2d];
    const points = await make(kind, Number(count), { seed: Number(seed) });
    const surface = await (await triangulate(points)).surface({
      smooth: smooth === 'auto' ? smooth : Number(smooth),
    });
    const { triangles, edges, sources, vertices } = surface;
    const found = triangles ?? edges;
    assert.equal(found.length / Number(dimension), Number(facets), line);
    assert.equal(hashOf([found, sources, vertices]), fingerprint, line);
  }
});

test('the surface of a box', async () => {
  const mesh = await delaunay3d(box(4));
  const surface = await mesh.surface({ solid: true });
  assert.ok(surface instanceof Surface3);
  assertClosed(surface);
  const { triangles, vertices, sources, sides, solid, volume, ...numbers } = surface;
  assert.ok(Math.abs(volume - 64) < 1e-9);
  assert.ok(triangles instanceof Uint32Array && sources instanceof Int32Array);
  assert.ok(sides instanceof Uint8Array && sides.every((side) => side === 1));
  assert.equal(triangles.length, 3 * 6 * 16 * 2);
  assert.deepEqual(vertices, mesh.points);
  assert.deepEqual([...sources], [...sides.keys()]);
  assert.ok(solid instanceof Uint32Array && solid.length % 4 === 0);
  assert.deepEqual(numbers, {
    ...{ area: 96, components: 1, genus: 0, closed: true },
    ...{
      boundaries: 0,
      evidence: 'hull',
      noise: 0,
      isolated: 0,
      droppedPieces: 0,
      filledCavities: 0,
      moved: null,
    },
  });
  assert.equal((await mesh.surface()).solid, null);
});

test('vertices have the precision of the points', async () => {
  const points = new Float32Array(box(3).flat());
  const { vertices } = await (await delaunay3d(points)).surface();
  assert.deepEqual(vertices, points);
});

test('what lies inside and outside, and what is dropped', async () => {
  const sphere = await generate('sphere', 2000, { seed: 1 });
  const mesh = await delaunay3d(Float64Array.of(...sphere, 0, 0, 0, 9, 9, 9));
  const surface = await mesh.surface();
  assert.deepEqual([...surface.sides.subarray(2000)], [0, 0]);
  assert.equal(surface.isolated, 2);
  const all = await mesh.surface({ dropIsolated: false, smooth: 0 });
  assert.equal(all.isolated, 0);
  assert.equal(all.sides[2000], 2);
  // A small sphere beside a large one is a speck, unless all pieces count.
  const two = sphere.map((x) => x / 8);
  for (let i = 0; i < two.length; i += 3) two[i] += 3;
  const pair = await delaunay3d(Float64Array.of(...sphere, ...two));
  const one = await pair.surface({ dropIsolated: false });
  assert.deepEqual([one.components, one.droppedPieces], [1, 1]);
  const both = await pair.surface({ dropIsolated: false, minPart: 0 });
  assert.deepEqual([both.components, both.droppedPieces], [2, 0]);
});

test('smoothed points are returned', async () => {
  const mesh = await delaunay3d(await generate('sphere', 1000, { seed: 2 }));
  const surface = await mesh.surface({ smooth: 1 });
  assertClosed(surface);
  assert.equal(surface.moved.length, 3000);
  assert.notDeepEqual(surface.moved, mesh.points);
  for (const [v, point] of [...surface.sources].entries())
    assert.deepEqual(
      surface.vertices.slice(3 * v, 3 * v + 3),
      surface.moved.slice(3 * point, 3 * point + 3),
    );
});

/** Ground with two hills: x, y and z. */
const ground = Array.from({ length: 900 }, (_, i) => {
  const [x, y] = [i % 30, Math.floor(i / 30)];
  return [x + ((7 * i) % 11) / 40, y + ((5 * i) % 13) / 50, 3 * Math.sin(x / 5) * Math.cos(y / 6)];
});

/** The share of the area that faces up. */
function faceUp({ triangles, vertices }) {
  let [up, all] = [0, 0];
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * triangles[t + k]);
    const [u, v] = [b, c].map((p) => [0, 1].map((k) => vertices[p + k] - vertices[a + k]));
    const area = u[0] * v[1] - u[1] * v[0];
    up += Math.max(0, area);
    all += Math.abs(area);
  }
  return up / all;
}

test('open surfaces, and what is known about their sides', async () => {
  const mesh = await delaunay3d(ground);
  const closed = await mesh.surface();
  assert.deepEqual([closed.closed, closed.boundaries], [true, 0]);
  const sensors = [[15, 15, 100], ...ground.map(([x, y]) => [x, y, 50])];
  const evidences = {
    below: { up: [0, 0, 1] },
    normals: { normals: Float32Array.from(ground.flatMap(() => [0, 0, 2])) },
    sensors: { sensors: Float64Array.from(sensors[0]) },
  };
  for (const [evidence, options] of Object.entries(evidences)) {
    const surface = await mesh.surface({ ...options, open: 'auto' });
    assert.deepEqual([surface.closed, surface.boundaries], [false, 1], evidence);
    assert.equal(surface.evidence, evidence);
    assert.ok(faceUp(surface) > 0.99, `${evidence}: ${faceUp(surface)}`);
  }
  const each = await mesh.surface({ sensors: Float64Array.from(sensors.slice(1).flat()) });
  assert.equal(each.evidence, 'sensors');
  assert.equal((await mesh.surface({ open: 'never' })).closed, true);
});

test('open curves, with y down', async () => {
  const arc = Array.from({ length: 40 }, (_, i) => [i, 4 * Math.sin(i / 9)]);
  const mesh = await delaunay2d(arc);
  const curve = await mesh.surface({ up: [0, -1], open: 'auto' });
  assert.deepEqual([curve.closed, curve.evidence, curve.edges.length], [false, 'below', 2 * 39]);
  // What is below on the screen is on the left of an edge that runs to the left.
  for (let e = 0; e < curve.edges.length; e += 2) {
    const [from, to] = [curve.edges[e], curve.edges[e + 1]];
    assert.ok(curve.vertices[2 * from] > curve.vertices[2 * to]);
  }
});

test('a refined surface is closer to the sphere', async () => {
  const mesh = await delaunay3d(await generate('sphere', 1000, { seed: 3 }));
  const [plain, refined] = [await mesh.surface(), await mesh.surface({ refine: true })];
  assertClosed(refined);
  assert.equal(refined.triangles.length, 4 * plain.triangles.length);
  assert.equal(refined.sources.filter((source) => source < 0).length, plain.triangles.length / 2);
  const missing = ({ volume }) => (4 / 3) * Math.PI - volume;
  assert.ok(missing(refined) < missing(plain) / 2, `${missing(refined)}, ${missing(plain)}`);
});

test('files of a surface', async () => {
  const surface = await (await delaunay3d(new Float32Array(box(4).flat()))).surface();
  const count = surface.triangles.length / 3;
  const text = (bytes) => new TextDecoder('latin1').decode(bytes);
  assert.match(
    text(await surface.toPLY()),
    new RegExp(`element vertex 98.*element face ${count}`, 's'),
  );
  assert.equal(text(await surface.toOBJ()).match(/^f /gm).length, count);
  assert.equal((await surface.toSTL()).length, 84 + 50 * count);
  assert.equal(text((await surface.toGLB()).subarray(0, 4)), 'glTF');
  assert.equal(text((await surface.to3MF()).subarray(0, 2)), 'PK');
  const { points } = await readPoints(await surface.toPLY(), { format: 'ply' });
  assert.deepEqual(points, surface.vertices);
  await assert.rejects(surface.toSTL({ signal: AbortSignal.abort() }), { code: 'ABORTED' });
});

test('meshes have files for printers, too', async () => {
  const cube = await delaunay3d(corners(0, 1));
  assert.ok((await cube.to3MF()).length > 0);
  assert.ok((await (await delaunay2d([0, 0, 1, 0, 0, 1])).to3MF()).length > 0);
});

test('curves in the plane', async () => {
  const square = [];
  for (let i = 0; i < 8; i++) square.push([i, 0], [8, i], [8 - i, 8], [0, 8 - i]);
  const mesh = await delaunay2d([...square, [4, 4]]);
  const surface = await mesh.surface({ dropIsolated: false, smooth: 0, solid: true });
  const { edges, vertices, volume, area, components, closed, sides, solid } = surface;
  assert.deepEqual([volume, area, components, closed, edges.length], [64, 32, 1, true, 64]);
  assert.equal(sides[32], 2);
  assert.equal(solid.length % 3, 0);
  // By the shoelace formula; clockwise with y up, as the triangles are.
  let twice = 0;
  for (let e = 0; e < edges.length; e += 2) {
    const [a, b] = [2 * edges[e], 2 * edges[e + 1]];
    twice += vertices[a] * vertices[b + 1] - vertices[b] * vertices[a + 1];
  }
  assert.equal(twice, -128);
  assert.ok(!('triangles' in surface));
});

test('empty answers', async () => {
  for (const points of [
    [],
    [0, 0, 0],
    [0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0],
    new Array(30).fill(1),
  ]) {
    const surface = await (await delaunay3d(points)).surface({ solid: true });
    const { triangles, vertices, sources, solid, volume, area, components, genus, closed } =
      surface;
    for (const array of [triangles, vertices, sources, solid]) assert.equal(array.length, 0);
    assert.deepEqual([volume, area, components, genus, closed], [0, 0, 0, 0, true]);
    assert.equal(surface.sides.length, points.length / 3);
  }
  assert.equal((await (await delaunay2d([0, 0, 1, 1])).surface()).edges.length, 0);
});

test('bad options are typed errors', async () => {
  const mesh = await delaunay3d(corners(0, 1));
  const bad = (options, message) =>
    assert.rejects(mesh.surface(options), (error) => {
      assert.ok(error instanceof GdelError, String(error));
      assert.equal(error.code, 'BAD_INPUT');
      assert.match(error.message, message);
      return true;
    });
  for (const minPart of [-0.1, 1.5, Number.NaN, '0.5', null])
    await bad({ minPart }, /option minPart must be a number from 0 to 1/);
  for (const smooth of [-1, 1.5, 101, 'twice', null])
    await bad({ smooth }, /option smooth must be 'auto' or an integer from 0 to 100/);
  for (const open of [true, 'always']) await bad({ open }, /option open must be 'never' or 'auto'/);
  for (const up of [[0, 1], 'z', [0, 0, '1']]) await bad({ up }, /option up must be an array of 3/);
  for (const [name, value] of [
    ['normals', [0, 0, 1]],
    ['normals', new Float32Array(4)],
    ['sensors', new Uint32Array(3)],
  ])
    await bad({ [name]: value }, new RegExp(`option ${name} must be a Float32Array`));
  await bad({ normals: new Float32Array(9) }, /3 .* 8/);
  await bad({ normals: new Float32Array(24).fill(Number.NaN) }, /finite/);
  await bad({ sensors: new Float32Array(9) }, /3/);
  await bad({ dropIsolated: 'no' }, /option dropIsolated must be true or false/);
  await bad({ refine: 'yes' }, /option refine must be true or false/);
  await bad({ solid: 1 }, /option solid must be true or false/);
  await bad({ minPart: () => 0.5 }, /option minPart/);
  await bad(null, /options must be an object/);
  await bad({ signal: {} }, /AbortSignal/);
  const bare = await delaunay3d(corners(0, 1), { outputs: ['hull'] });
  await assert.rejects(bare.surface(), { code: 'BAD_INPUT' });
  mesh.tetrahedra[3] = 9;
  await bad({}, /exist/);
  assert.equal((await (await delaunay3d(corners(0, 1))).surface()).components, 1);
});

test('progress and aborts', async () => {
  const mesh = await delaunay3d(await generate('sphere', 5000));
  const reports = [];
  await mesh.surface({ onProgress: (progress) => reports.push(progress) });
  assert.ok(reports.every(({ phase }) => phase === 'surface'));
  assert.equal(reports.at(-1).fraction, 1);
  assert.deepEqual(await abortOf((options) => mesh.surface(options)), {
    code: 'ABORTED',
    atOnce: true,
  });
  assert.equal((await mesh.surface()).genus, 0);
});
