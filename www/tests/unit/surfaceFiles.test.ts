import assert from 'node:assert/strict';
import { test } from 'node:test';
import { surfaceFile } from '../../src/model/surfaceFiles';

// Far from the origin, where single precision would move the points; the first is not used.
const points = Float64Array.of(9, 9, 9, 4e6, 0, 0.1, 4e6 + 1, 0, 0.1, 4e6, 1, 0.1);
const triangles = Uint32Array.of(1, 2, 3);

test('a surface is saved as PLY in the precision of the input, without other points', () => {
  const file = surfaceFile({ points, colors: null, triangles }, 'PLY');
  const text = new TextDecoder('latin1').decode(file);
  assert.match(text, /element vertex 3\nproperty double x/);
  const view = new DataView(file.buffer, text.indexOf('end_header\n') + 11);
  assert.deepEqual(
    [0, 1, 2].map((i) => view.getFloat64(8 * i, true)),
    [4e6, 0, 0.1],
  );
  assert.deepEqual(
    [0, 1, 2].map((i) => view.getInt32(73 + 4 * i, true)),
    [0, 1, 2],
  );
  const single = surfaceFile({ points: Float32Array.from(points), colors: null, triangles }, 'PLY');
  assert.match(new TextDecoder('latin1').decode(single), /property float x/);
});

test('a surface is saved as OBJ with all digits, counted from 1', () => {
  assert.equal(
    new TextDecoder().decode(surfaceFile({ points, colors: null, triangles }, 'OBJ')),
    'v 4000000 0 0.1\nv 4000001 0 0.1\nv 4000000 1 0.1\nf 1 2 3\n',
  );
});

test('a surface is saved as STL with normals that point outwards', () => {
  const file = surfaceFile({ points, colors: null, triangles }, 'STL');
  const view = new DataView(file.buffer);
  assert.equal(file.length, 84 + 50);
  assert.equal(view.getUint32(80, true), 1);
  assert.deepEqual(
    [0, 1, 2].map((i) => view.getFloat32(84 + 4 * i, true)),
    [0, 0, 1],
  );
});

test('a surface is saved with the colours of its points where the format has any', () => {
  const colors = Uint8Array.of(1, 2, 3, 255, 0, 51, 4, 5, 6, 7, 8, 9);
  const ply = surfaceFile({ points, colors, triangles }, 'PLY');
  const text = new TextDecoder('latin1').decode(ply);
  assert.match(text, /z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n/);
  const vertices = text.indexOf('end_header\n') + 11;
  assert.deepEqual([...ply.subarray(vertices + 24, vertices + 27)], [255, 0, 51]);
  assert.equal(ply.length, vertices + 3 * 27 + 13);
  assert.match(
    new TextDecoder().decode(surfaceFile({ points, colors, triangles }, 'OBJ')),
    /^v 4000000 0 0.1 1 0 0.2\n/,
  );
  assert.equal(surfaceFile({ points, colors, triangles }, 'STL').length, 84 + 50);
});
