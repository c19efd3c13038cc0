import assert from 'node:assert/strict';
import { test } from 'node:test';
import { delaunay2d, readShapes } from 'gdel-wasm';
import { anglesOf } from '../../src/model/constrained';
import { applyEdits, type Edit, editsFromText, editsToText, withEdit } from '../../src/model/edits';
import { exampleOf, SHAPE_EXAMPLES, type ShapeExample } from '../../src/model/shapeExamples';
import { constraintsAfter, cornersOnlyOf, together } from '../../src/model/shapes';
import { columnsIn } from '../../src/model/weighted';

const corner = (x: number, y: number): Edit => ({ do: 'corner', at: [x, y] });
/** A triangle, and one that shares two corners with it. */
const DRAWN: Edit[] = [
  corner(0, 0),
  corner(4, 0),
  corner(0, 4),
  { do: 'close' },
  { do: 'join', point: 1 },
  { do: 'join', point: 2 },
  corner(4, 4),
  { do: 'close' },
];

/** Made before the server ends that loads the parts of the package. */
const examples = await Promise.all(
  (Object.keys(SHAPE_EXAMPLES) as ShapeExample[]).map(async (name) => {
    const source = await exampleOf(name);
    if (source.kind !== 'file') throw new Error(name);
    const shapes = await readShapes(source.files[0]);
    const mesh = await delaunay2d(shapes.points, shapes);
    const fine = await mesh.refine({ minAngle: 30 });
    return { name, source, shapes, mesh, fine };
  }),
);
const house = await readShapes(
  new TextEncoder().encode('{"type":"Polygon","coordinates":[[[0,0],[4,0],[4,3],[0,0]]]}'),
  { name: 'house.json' },
);

test('polygons are closed one after the other, and share corners', () => {
  const { rings, open, fill, meshing } = constraintsAfter(null, 0, DRAWN)!;
  assert.deepEqual(rings, [
    [0, 1, 2],
    [1, 2, 3],
  ]);
  assert.deepEqual([open, fill, meshing.split], [[], 'evenodd', 0]);
  assert.deepEqual([...applyEdits(new Float64Array(), DRAWN)], [0, 0, 4, 0, 0, 4, 4, 4]);
  const begun = constraintsAfter(null, 2, DRAWN.slice(0, 2))!;
  assert.deepEqual([begun.rings, begun.open], [[], [2, 3]]);
  // Of points besides, all are inside until something is closed.
  assert.equal(begun.fill, 'all');
  assert.equal(constraintsAfter(null, 0, DRAWN.slice(0, 2))!.fill, 'evenodd');
  assert.equal(constraintsAfter(null, 5, [{ do: 'add', at: [0, 0] }]), null);
});

test('a ring goes with the corners that are its own', () => {
  const before = constraintsAfter(null, 0, DRAWN)!;
  assert.deepEqual(cornersOnlyOf(0, before), [0]);
  const erased: Edit[] = [...DRAWN, { do: 'erase', ring: 0, points: [0] }];
  assert.deepEqual(constraintsAfter(null, 0, erased)!.rings, [[0, 1, 2]]);
  assert.deepEqual([...applyEdits(new Float64Array(), erased)], [4, 0, 0, 4, 4, 4]);
  // One with less than three corners is none.
  const removed: Edit[] = [...DRAWN, { do: 'remove', point: 0 }];
  assert.deepEqual(constraintsAfter(null, 0, removed)!.rings, [[0, 1, 2]]);
  const both: Edit[] = [...removed, { do: 'remove', point: 2 }];
  assert.deepEqual(constraintsAfter(null, 0, both)!.rings, []);
});

test('what is chosen last counts, and is one change', () => {
  const angle = (minAngle: number): Edit => ({
    do: 'mesh',
    split: 1,
    fill: 2,
    minAngle,
    maxArea: 0.5,
  });
  const edits = withEdit(withEdit(DRAWN, angle(20)), angle(30));
  assert.equal(edits.length, DRAWN.length + 1);
  const { fill, suits, meshing } = constraintsAfter(null, 0, edits)!;
  assert.deepEqual([fill, suits, meshing.minAngle], ['nonzero', 'evenodd', 30]);
});

test('a link holds polygons', () => {
  const edits: Edit[] = [
    ...DRAWN,
    { do: 'erase', ring: 1, points: [3, 1] },
    { do: 'mesh', split: 1, fill: 4, minAngle: 34, maxArea: 1e-7 },
  ];
  assert.deepEqual(editsFromText(editsToText(edits)), edits);
  for (const text of [
    'close_1',
    'join_x',
    'corner_1',
    'erase',
    'erase_0_1_2',
    'mesh_0_0_35_0',
    'mesh_0_9_30_0',
    'mesh_2_0_30_0',
    'mesh_0_0_30_-1',
    'mesh_0_0_30',
  ])
    assert.equal(editsFromText(text), null, text);
});

test('files are taken together', () => {
  const inSpace = { points: new Float64Array(9), shapes: house };
  const all = together([{ points: new Float64Array(6) }, inSpace, inSpace]);
  assert.deepEqual(
    all.rings.map((ring) => [...ring]),
    [
      [2, 3, 4],
      [5, 6, 7],
    ],
  );
  assert.equal(all.fill, 'evenodd');
  const wound = { ...inSpace, shapes: { ...house, fill: 'nonzero' as const } };
  assert.equal(together([wound]).fill, 'nonzero');
  assert.equal(together([wound, inSpace]).fill, 'evenodd');
  const after = constraintsAfter(all, 8, [{ do: 'remove', point: 0 }])!;
  assert.deepEqual(after.rings, [
    [1, 2, 3],
    [4, 5, 6],
  ]);
});

test('angles are counted, inside only', () => {
  // Half a square, and the other half outside.
  const points = [0, 0, 1, 0, 0, 1, 1, 1];
  const { smallest, counts } = anglesOf(points, [0, 2, 1, 1, 2, 3], [1, 0]);
  assert.ok(Math.abs(smallest - 45) < 1e-9);
  assert.equal(
    counts.reduce((sum, n) => sum + n),
    3,
  );
  assert.equal(counts[18], 1);
  assert.ok(Number.isNaN(anglesOf(points, [0, 2, 1], [0]).smallest));
});

test('examples are files that can be meshed, and short enough for links', () => {
  for (const { name, source, shapes, mesh, fine } of examples) {
    assert.ok(source.kind === 'file' && source.packed && source.packed.length < 2500, name);
    assert.deepEqual(shapes.leftOut, []);
    assert.ok(mesh.insideTriangles().length < mesh.triangles.length, name);
    const { refinement } = fine.constraints!;
    assert.ok(
      refinement!.pointsInside > 100 && refinement!.minAngle >= 30,
      `${name}: ${JSON.stringify(refinement)}`,
    );
  }
});

test('a table with a quotation mark that is never closed is an error that columns survive', () => {
  assert.throws(() => columnsIn('x,y,r\n1,2,"3'), /Line 2: a quotation mark/);
});
