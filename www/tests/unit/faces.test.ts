import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { pointsOnFaces } from '../../src/geometry/faces';
import { facesOf } from '../../src/model/faceFiles';

const encode = (text: string) => new TextEncoder().encode(text).buffer as ArrayBuffer;

/** A box of twelve triangles. */
function box(x: number, y: number, z: number): Float64Array {
  const corner = (i: number) => [i & 1 ? x : 0, i & 2 ? y : 0, i & 4 ? z : 0];
  const sides = ['0231', '4576', '0154', '2673', '0462', '1375'];
  return Float64Array.from(
    sides.flatMap((side) => {
      const [a, b, c, d] = [...side].map((i) => corner(Number(i)));
      return [a, b, c, a, c, d].flat();
    }),
  );
}

/** A sheet of squares, two triangles each. */
function sheet(squares: number): Float64Array {
  const faces: number[] = [];
  for (let i = 0; i < squares; i++)
    for (let j = 0; j < squares; j++)
      for (const [a, b, c] of [
        [0, 1, 2],
        [3, 2, 1],
      ])
        for (const k of [a, b, c]) faces.push(i + (k & 1), j + (k >> 1), 0);
  return Float64Array.from(faces);
}

describe('points on faces', () => {
  test('are spread evenly over the sides of a box, and lie on them', () => {
    const size = [100, 40, 5];
    const points = pointsOnFaces(box(100, 40, 5), 8);
    assert.ok(points.length / 3 > 15_000 && points.length / 3 < 60_000, `${points.length / 3}`);
    const on = [0, 0, 0];
    for (let p = 0; p < points.length; p += 3) {
      const sides = [0, 1, 2].filter((k) => points[p + k] === 0 || points[p + k] === size[k]);
      assert.equal(sides.length, 1, `${points.subarray(p, p + 3)}`);
      on[sides[0]]++;
    }
    const areas = [200, 500, 4000];
    for (const axis of [0, 1, 2]) {
      const density = on[axis] / areas[axis] / (points.length / 3 / 4700);
      assert.ok(density > 0.8 && density < 1.25, `${density} on axis ${axis}`);
    }
  });

  test('are none where corners are everywhere, or there are enough', () => {
    assert.equal(pointsOnFaces(sheet(40), 41 * 41).length, 0);
    assert.equal(pointsOnFaces(box(1, 1, 1), 20_000).length, 0);
    assert.equal(pointsOnFaces(new Float64Array(), 500).length, 0);
  });

  test('come where a part of a model is coarse', () => {
    const coarse = Float64Array.from([...sheet(40), ...box(400, 300, 10)]);
    assert.ok(pointsOnFaces(coarse, 41 * 41 + 8).length > 30_000);
  });

  test('are not too many on slivers, nor any on what has no area', () => {
    const slivers = Float64Array.from({ length: 9 * 5000 }, (_, i) => {
      const [face, k] = [Math.floor(i / 9), i % 9];
      return [0, face, 0, 1e4, face, 0, 0, face, 1e-3][k];
    });
    const count = pointsOnFaces(slivers, 900).length / 3;
    assert.ok(count > 5_000 && count < 80_000, `${count}`);
    const nothing = Float64Array.of(0, 0, 0, 1, 1, 1, 2, 2, 2, NaN, 0, 0, 1, 0, 0, 0, 1, 0);
    assert.equal(pointsOnFaces(nothing, 3).length, 0);
    assert.equal(pointsOnFaces(Float64Array.of(0, 0, 0, 1e300, 0, 0, 0, 1e300, 0), 3).length, 0);
  });
});

describe('faces', () => {
  const triangle = [0, 0, 0, 1, 0, 0, 0, 0.5, 0];

  test('of a binary STL, though it begins like a text', () => {
    const bytes = new ArrayBuffer(84 + 50);
    new Uint8Array(bytes).set(new TextEncoder().encode('solid'));
    const view = new DataView(bytes);
    view.setUint32(80, 1, true);
    for (const [k, x] of triangle.entries()) view.setFloat32(84 + 12 + 4 * k, x, true);
    assert.deepEqual([...facesOf('a.STL', bytes)!], triangle);
  });

  test('of a text STL', () => {
    const text = `solid a\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  VERTEX 1 0 0\n\tvertex 0 .5 0\nendloop\nendfacet\nendsolid\n`;
    assert.deepEqual([...facesOf('a.stl', encode(text))!], triangle);
  });

  test('of an OBJ: of more than three corners, counted backwards, and without those that are not there', () => {
    const vertices = 'v 0 0 0\nv 1 0 0\nv 1 1 0 0.5\nv 0 1 0\n';
    const of = (faces: string) => [...facesOf('a.obj', encode(vertices + faces))!];
    assert.deepEqual(of('f 1 2 3 4\n'), [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0]);
    assert.deepEqual(of('f -4/1/1 -3//2 -2\n'), [0, 0, 0, 1, 0, 0, 1, 1, 0]);
    assert.deepEqual(of('f 1 2\nf 1 2 9\nf x y z\nf\n'), []);
  });

  test('of a format of points are none', () => {
    assert.equal(facesOf('a.xyz', encode('0 0 0\n')), null);
  });
});
