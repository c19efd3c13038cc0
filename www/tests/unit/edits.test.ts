import assert from 'node:assert/strict';
import { test } from 'node:test';
import {
  applyEdits,
  colorsAfter,
  type Edit,
  editsFromText,
  editsToText,
  withEdit,
} from '../../src/model/edits';
import { weightsAfter } from '../../src/model/weighted';

const EDITS: Edit[] = [
  { do: 'add', at: [0.5, -2.25] },
  { do: 'move', point: 0, at: [7, 8] },
  { do: 'remove', point: 1 },
  { do: 'move', point: 1, at: [9, 1e-7] },
];

test('changes apply in order, and leave the points before as they are', () => {
  const before = Float64Array.of(1, 2, 3, 4);
  assert.deepEqual([...applyEdits(before, EDITS)], [7, 8, 9, 1e-7]);
  assert.deepEqual([...before], [1, 2, 3, 4]);
  assert.equal(applyEdits(before, []), before);
});

test('what names a point that is not there changes nothing', () => {
  const edits: Edit[] = [
    { do: 'remove', point: 2 },
    { do: 'move', point: 99, at: [0, 0] },
  ];
  assert.deepEqual([...applyEdits(Float64Array.of(1, 2, 3, 4), edits)], [1, 2, 3, 4]);
});

test('many moves of one point are one change', () => {
  const to = (x: number): Edit => ({ do: 'move', point: 3, at: [x, 0] });
  assert.deepEqual(withEdit(withEdit(EDITS, to(1)), to(2)), [...EDITS, to(2)]);
  assert.equal(withEdit([to(1)], { do: 'move', point: 4, at: [2, 0] }).length, 2);
});

test('a link holds them', () => {
  assert.deepEqual(editsFromText(editsToText(EDITS)), EDITS);
});

test('what makes no sense in a link is no change', () => {
  for (const text of [
    '',
    'add',
    'add_1',
    'add_1_2_3',
    'add_1_NaN',
    'add__2',
    'move_1_2',
    'move_-1_2_3',
    'move_0.5_2_3',
    'remove_x',
    'remove_1*',
    'drop_1',
  ]) {
    assert.equal(editsFromText(text), null, text);
  }
});

test('colours stay with their points', () => {
  const colors = Uint8Array.of(1, 1, 1, 2, 2, 2, 3, 3, 3);
  assert.equal(colorsAfter(colors, []), colors);
  const after = colorsAfter(colors, [
    { do: 'move', point: 2, at: [5, 5] },
    { do: 'add', at: [1, 1] },
    { do: 'remove', point: 0 },
    { do: 'remove', point: 9 },
  ]);
  assert.deepEqual([...after], [2, 2, 2, 3, 3, 3, 0, 0, 0]);
});

test('weights belong to points, which move up', () => {
  const edits: Edit[] = [
    { do: 'weigh', point: 1, radius: 2 },
    { do: 'add', at: [5, 6] },
    { do: 'weigh', point: 2, radius: 0.5 },
    { do: 'remove', point: 0 },
    { do: 'weigh', point: 7, radius: 3 },
  ];
  assert.deepEqual([...applyEdits(Float64Array.of(1, 2, 3, 4), edits)], [3, 4, 5, 6]);
  assert.deepEqual([...weightsAfter(Float64Array.of(9, 9), edits)], [4, 0.25]);
  assert.deepEqual(editsFromText(editsToText(edits)), edits);
  assert.equal(editsFromText('weigh_1_-2'), null);
  const twice = withEdit(edits, { do: 'weigh', point: 7, radius: 1 });
  assert.equal(twice.length, edits.length);
});
