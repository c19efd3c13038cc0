// The code that the page shows does what the page did: it is run, with the files in place of the
// server.

import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { gzipSync } from 'node:zlib';
import * as gdel from 'gdel-wasm';
import { applyEdits, type Edit } from '../../src/model/edits';
import { constraintsAfter, together } from '../../src/model/shapes';
import type { Source } from '../../src/model/source';
import { codeFor } from '../../src/ui/code';

const NAME = "it's a \\ cat #1.xyz";
const { delaunay2d, delaunay3d, generate, generate2d } = gdel;

/** Runs code with these files on its server, and returns its points and its mesh. */
async function run(code: string, files: Record<string, string | Uint8Array> = {}) {
  const fetchFile = async (address: string) => {
    const { pathname } = new URL(address, 'http://server/');
    const content = files[decodeURIComponent(pathname.slice(1))];
    assert.ok(content !== undefined, `${address} is asked for`);
    return new Response(content as BodyInit);
  };
  const [, names] = /^import \{ (.*) \}\n {2}from 'gdel-wasm';$/m.exec(code)!;
  const body = code.replace(/^import .*\n.*;$/m, '');
  const make = new Function(
    'gdel',
    'fetch',
    `return (async () => { const { ${names} } = gdel; ${body}\nreturn { mesh, saved: typeof vtu === 'undefined' ? print : vtu }; })()`,
  );
  const { mesh, saved } = await make(gdel, fetchFile);
  assert.ok(saved.length > 0);
  return mesh;
}

const settings = (source: Source, edits: readonly Edit[] = []) => ({
  source,
  edits,
  backend: 'cpu' as const,
  filter: 'all' as const,
});
const file = (name: string, dimension: 2 | 3 = 3): Source => ({
  kind: 'file',
  dimension,
  files: [new File([], name)],
});

describe('the code on the page', () => {
  const xyz = '0 0 0\n1 0 0\n0 1 0\n0 0 1\n0.1 0.2 0.7\n';

  test('generates the same points', async () => {
    for (const distribution of ['uniform', 'thin-sphere'] as const) {
      const source = { kind: 'generator', dimension: 3, distribution, count: 60, seed: 5 } as const;
      const mesh = await run(codeFor(settings(source)));
      const expected = await delaunay3d(await generate(distribution, 60, { seed: 5 }));
      assert.deepEqual(mesh.tetrahedra, expected.tetrahedra);
    }
  });

  test('finds the surface that is shown, and saves it', async () => {
    const code = codeFor({ ...settings(file(NAME)), filter: 'surface' });
    assert.match(code, /surface\.volume/);
    assert.doesNotMatch(code, /vtu/);
    assert.equal((await run(code, { [NAME]: xyz })).points.length, 15);
  });

  test('changes them as they were changed by hand', async () => {
    const edits: Edit[] = [
      { do: 'add', at: [0.5, -2.25] },
      { do: 'move', point: 99, at: [7, 8] },
      { do: 'move', point: 0, at: [1e-7, 8] },
      { do: 'remove', point: 3 },
    ];
    for (const count of [0, 20]) {
      const source: Source = {
        kind: 'generator',
        dimension: 2,
        distribution: 'disk',
        count,
        seed: 1,
      };
      const all = count > 0 ? edits : [0, 1, 2].map((i) => ({ ...edits[0], at: [i, i * i] }));
      const mesh = await run(codeFor(settings(source, all as Edit[])));
      const before = count > 0 ? await generate2d('disk', count, { seed: 1 }) : new Float64Array();
      const expected = await delaunay2d(applyEdits(before, all as Edit[]));
      assert.deepEqual(mesh.triangles, expected.triangles);
    }
  });

  describe('of polygons', () => {
    const square = (low: number, high: number): Edit[] => [
      ...[
        [low, low],
        [high, low],
        [high, high],
        [low, high],
      ].map((at) => ({ do: 'corner', at }) as Edit),
      { do: 'close' },
    ];
    const drawn: Edit[] = [...square(0, 9), ...square(3, 6)];
    const polygonsOf = (edits: readonly Edit[], count: number, shapes?: gdel.Shapes) => ({
      ...constraintsAfter(
        shapes ? together([{ points: new Float64Array(3 * count), shapes }]) : null,
        count,
        edits,
      )!,
      start: count,
      refinement: null,
    });
    const generated = (count: number): Source => ({
      kind: 'generator',
      dimension: 2,
      distribution: 'uniform',
      count,
      seed: 1,
    });

    test('draws them, with points besides', async () => {
      const mesh = await run(codeFor(settings(generated(0), drawn), null, polygonsOf(drawn, 0)));
      assert.equal(mesh.insideTriangles().length, 3 * 8);
      const more = await run(codeFor(settings(generated(20), drawn), null, polygonsOf(drawn, 20)));
      assert.equal(more.coords.length, 2 * 28);
      assert.ok(more.insideTriangles().length > 3 * 8);
    });

    test('chooses what the page chose', async () => {
      const crossing: Edit[] = [...drawn, ...square(4, 12)];
      const edits: Edit[] = [
        ...crossing,
        { do: 'mesh', split: 1, fill: 2, minAngle: 25, maxArea: 2 },
      ];
      const mesh = await run(codeFor(settings(generated(0), edits), null, polygonsOf(edits, 0)));
      const { refinement } = mesh.constraints;
      assert.ok(refinement.pointsInside > 0 && refinement.minAngle >= 25);
    });

    test('reads files, and adds to them', async () => {
      const text =
        '{"type":"Polygon","coordinates":[[[0,0],[9,0],[9,9],[0,9],[0,0]],[[1,1],[2,1],[1,2],[1,1]]]}';
      const shapes = await gdel.readShapes(new TextEncoder().encode(text), { format: 'json' });
      for (const name of ['a map.geojson', 'a map.geojson.gz']) {
        const files = { [name]: name.endsWith('z') ? gzipSync(text) : text };
        const code = (edits: Edit[]) =>
          run(codeFor(settings(file(name, 2), edits), null, polygonsOf(edits, 7, shapes)), files);
        assert.equal((await code([])).insideTriangles().length, 3 * 7);
        const moved = await code([{ do: 'move', point: 0, at: [-1, -1] }]);
        assert.deepEqual([...moved.coords.slice(0, 2)], [-1, -1]);
        assert.equal(moved.insideTriangles().length, 3 * 7);
        const holed = await code([
          ...square(3, 6),
          { do: 'mesh', split: 0, fill: 0, minAngle: 20, maxArea: 0 },
        ]);
        assert.ok(holed.constraints.refinement.minAngle >= 20);
        assert.equal(new Set(holed.constraints.regions).size, 3);
      }
    });
  });

  test('reads a file of any name, compressed or not, in space and in the plane', async () => {
    const { tetrahedra } = await run(codeFor(settings(file(NAME))), { [NAME]: xyz });
    assert.equal(tetrahedra.length, 4 * 4);
    const name = `${NAME}.gz`;
    const zipped = { [name]: gzipSync(xyz) };
    const mesh = await run(codeFor(settings(file(name))), zipped);
    assert.deepEqual(mesh.tetrahedra, tetrahedra);
    for (const [each, files] of [
      [NAME, { [NAME]: xyz }],
      [name, zipped],
    ] as const) {
      const flat = await run(codeFor(settings(file(each, 2))), files);
      assert.deepEqual([...flat.coords], [0, 0, 1, 0, 0, 1, 0, 0, 0.1, 0.2]);
    }
  });

  test('fetches what is on the web', async () => {
    const source: Source = { kind: 'url', dimension: 3, url: 'http://server/a/cat.xyz?key=1' };
    const { tetrahedra } = await run(codeFor(settings(source)), { 'a/cat.xyz': xyz });
    assert.equal(tetrahedra.length, 4 * 4);
  });

  test('reads several files as one cloud', async () => {
    const source: Source = {
      kind: 'file',
      dimension: 3,
      files: [new File([], 'left.xyz'), new File([], 'right.xyz')],
    };
    const files = { 'left.xyz': '0 0 0\n1 0 0\n', 'right.xyz': '0 1 0\n0 0 1\n' };
    assert.equal((await run(codeFor(settings(source)), files)).tetrahedra.length, 4);
    const flat = await run(codeFor(settings({ ...source, dimension: 2 })), files);
    assert.deepEqual([...flat.coords], [0, 0, 1, 0, 0, 1, 0, 0]);
  });

  test('reads the page’s own file where points were put on faces', () => {
    const onFaces = { points: 9, taken: true };
    assert.match(codeFor(settings(file('part.stl')), { onFaces }), /TetGen\n.*\n {2}'part\.node'/);
    const bare = codeFor(settings(file('part.stl')), { onFaces: { ...onFaces, taken: false } });
    assert.match(bare, /'part\.stl'/);
  });

  test('reads the page’s own file where the package cannot read the one that was opened', async () => {
    const { node } = await (
      await delaunay3d([
        [0, 0, 0],
        [1, 0, 0],
        [0, 1, 0],
        [0, 0, 1 / 3],
      ])
    ).toTetGen();
    const code = codeFor(settings(file('my cat.glb')));
    assert.match(code, /\/\/ From Download: TetGen/);
    assert.equal((await run(code, { 'my-cat.node': node })).tetrahedra.length, 4);
    const flat = await run(codeFor(settings(file('my cat.glb', 2))), { 'my-cat.node': node });
    assert.equal(flat.triangles.length, 3);
    assert.equal(flat.duplicateOf.length, 4);
  });
});
