import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { VoronoiArrays } from 'gdel-wasm';
import { surfaceOfCells } from '../../src/geometry/cells';

/** Two boxes beside each other, 1 × 1 × 1 each, with a facet in common. */
function twoBoxes(): VoronoiArrays {
  const vertices: number[] = [];
  for (const x of [0, 1, 2]) for (const y of [0, 1]) for (const z of [0, 1]) vertices.push(x, y, z);
  const at = (x: number, y: number, z: number) => 4 * x + 2 * y + z;
  const box = (x: number) => [
    [at(x, 0, 0), at(x, 0, 1), at(x, 1, 1), at(x, 1, 0)],
    [at(x + 1, 0, 0), at(x + 1, 1, 0), at(x + 1, 1, 1), at(x + 1, 0, 1)],
    [at(x, 0, 0), at(x + 1, 0, 0), at(x + 1, 0, 1), at(x, 0, 1)],
    [at(x, 1, 0), at(x, 1, 1), at(x + 1, 1, 1), at(x + 1, 1, 0)],
    [at(x, 0, 0), at(x, 1, 0), at(x + 1, 1, 0), at(x + 1, 0, 0)],
    [at(x, 0, 1), at(x + 1, 0, 1), at(x + 1, 1, 1), at(x, 1, 1)],
  ];
  const facets = [...box(0), ...box(1)];
  return {
    vertices: Float64Array.from(vertices),
    facetOffsets: Uint32Array.from({ length: 13 }, (_, f) => 4 * f),
    facets: Uint32Array.from(facets.flat()),
    neighbors: Int32Array.from([-1, 1, -1, -1, -1, -1, 0, -1, -1, -1, -1, -1]),
    areas: new Float64Array(12).fill(1),
    cells: Uint32Array.of(0, 6, 12),
    volumes: Float64Array.of(1, 1),
    centroids: new Float64Array(6),
  } as unknown as VoronoiArrays;
}

/** The volume within triangles. */
function volumeOf(p: Float32Array): number {
  let sum = 0;
  for (let i = 0; i < p.length; i += 9) {
    const [a, b, c] = [0, 3, 6].map((k) => p.subarray(i + k, i + k + 3));
    sum +=
      a[0] * (b[1] * c[2] - b[2] * c[1]) -
      a[1] * (b[0] * c[2] - b[2] * c[0]) +
      a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}

const draw = (kept: number[], apart = 0) =>
  surfaceOfCells(
    {
      diagram: twoBoxes(),
      frame: { center: [1, 0.5, 0.5], scale: 0.5 },
      positions: Float32Array.of(-0.25, 0, 0, 0.25, 0, 0),
      kept: Uint8Array.from(kept),
      apart,
    },
    (point) => point,
  );

test('cells that touch are drawn without what is between them', () => {
  assert.equal(draw([1, 1]).owners.length, 20);
  assert.equal(draw([1, 0]).owners.length, 12);
  assert.equal(draw([0, 0]).owners.length, 0);
  // Half the size in each direction.
  assert.ok(Math.abs(volumeOf(draw([1, 1]).positions) - 2 / 8) < 1e-6);
});

test('cells that are apart are whole, and turned outwards', () => {
  const { positions, owners, values } = draw([1, 1], 1);
  assert.equal(owners.length, 24);
  // The drawing keeps its size: each cell is half as large in each direction.
  assert.ok(Math.abs(volumeOf(positions) - 2 / 64) < 1e-6);
  assert.deepEqual([...new Set(owners)], [0, 1]);
  assert.ok(owners.every((owner, i) => values[3 * i] === owner));
  const reach = positions.filter((_, i) => i % 3 === 0);
  assert.ok(Math.abs(Math.max(...reach) - 0.375) < 1e-6, `${Math.max(...reach)}`);
});
