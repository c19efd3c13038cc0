import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { Delaunay } from 'd3-delaunay';
import Delaunator from 'delaunator';
import { frameOf, toFrame } from '../../src/geometry/mesh';
import { flatSurface, measureTriangles, type Triangulation } from '../../src/geometry/triangles';
import { type Box, voronoiEdges } from '../../src/geometry/voronoi';
import { closeTo } from './close';

const ONE = { center: [0, 0, 0] as [number, number, number], scale: 1 };

function triangulate(points: Float64Array): Triangulation {
  const { triangles, halfedges, hull } = new Delaunator(points);
  return {
    positions: toFrame(points, ONE, 2),
    triangles: Uint32Array.from(triangles),
    halfedges: Int32Array.from(halfedges),
    hull: Uint32Array.from(hull),
  };
}

/** Numbers from 0 to 1, the same in every run. */
function random(seed: number): () => number {
  return () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32;
}

function cloud(n: number, place: (next: () => number) => [number, number]): Float64Array {
  const next = random(1);
  return Float64Array.from(Array.from({ length: n }, () => place(next)).flat());
}

const lengthOf = (lines: Float32Array) => {
  let sum = 0;
  for (let i = 0; i < lines.length; i += 6)
    sum += Math.hypot(lines[i + 3] - lines[i], lines[i + 4] - lines[i + 1]);
  return sum;
};

/**
 * The length of d3's diagram within a box: every edge is in two of its cells, but for those of the
 * box.
 */
function lengthOfTheirs(points: Float64Array, { low, high }: Box): number {
  const voronoi = new Delaunay(points).voronoi([low[0], low[1], high[0], high[1]]);
  const inside = ([ax, ay]: number[], [bx, by]: number[]) =>
    !(ax === bx && (ax === low[0] || ax === high[0])) &&
    !(ay === by && (ay === low[1] || ay === high[1]));
  let sum = 0;
  for (const cell of voronoi.cellPolygons()) {
    for (let i = 1; i < cell.length; i++)
      if (inside(cell[i - 1], cell[i]))
        sum += Math.hypot(cell[i][0] - cell[i - 1][0], cell[i][1] - cell[i - 1][1]);
  }
  return sum / 2;
}

const CLOUDS: Record<string, Float64Array> = {
  uniform: cloud(300, (next) => [next(), next()]),
  'few, with a hull whose circumcentres lie far outside': cloud(7, (next) => [
    next(),
    0.05 * next(),
  ]),
  'a thin ring': cloud(200, (next) => {
    const angle = 2 * Math.PI * next();
    const radius = 0.5 + 0.002 * next();
    return [0.5 + radius * Math.cos(angle), 0.5 + radius * Math.sin(angle)];
  }),
  'one triangle, obtuse': Float64Array.of(0, 0, 1, 0, 0.5, 0.02),
  'two lines': cloud(100, (next) => [next(), Math.round(next())]),
};

describe('the Voronoi diagram is as long as d3’s', () => {
  for (const [name, points] of Object.entries(CLOUDS)) {
    for (const [where, box] of Object.entries<Box>({
      around: { low: [-0.5, -0.5], high: [1.5, 1.5] },
      'in the middle': { low: [0.25, 0.25], high: [0.75, 0.75] },
      'far around': { low: [-20, -20], high: [20, 20] },
    })) {
      test(`${name}, ${where}`, () => {
        const theirs = lengthOfTheirs(points, box);
        assert.ok(
          Math.abs(lengthOf(voronoiEdges(points, ONE, triangulate(points), box).ends) - theirs) <
            1e-5 * Math.max(1, theirs),
        );
      });
    }
  }
});

test('every edge of the diagram is as far from the two nearest points, and no point is nearer', () => {
  const points = CLOUDS.uniform;
  const { ends: lines } = voronoiEdges(points, ONE, triangulate(points), {
    low: [-2, -2],
    high: [3, 3],
  });
  for (let i = 0; i < lines.length; i += 6) {
    const [x, y] = [(lines[i] + lines[i + 3]) / 2, (lines[i + 1] + lines[i + 4]) / 2];
    const distances = Array.from({ length: points.length / 2 }, (_, p) =>
      Math.hypot(points[2 * p] - x, points[2 * p + 1] - y),
    ).sort((a, b) => a - b);
    assert.ok(distances[1] - distances[0] < 1e-5);
  }
});

test('a grid’s diagram is its dual grid, without edges of length 0', () => {
  const points = Float64Array.from(
    Array.from({ length: 25 }, (_, i) => [i % 5, Math.floor(i / 5)]).flat(),
  );
  const { ends: lines } = voronoiEdges(points, ONE, triangulate(points), {
    low: [-1, -1],
    high: [5, 5],
  });
  closeTo(lengthOf(lines), 2 * 4 * 6, 4);
  for (let i = 0; i < lines.length; i += 6)
    assert.ok(Math.hypot(lines[i + 3] - lines[i], lines[i + 4] - lines[i + 1]) > 0.4);
});

test('of points on one line, it is the bisectors of neighbours', () => {
  const points = Float64Array.of(0, 0, 3, 3, 1, 1);
  const mesh: Triangulation = {
    positions: toFrame(points, ONE, 2),
    triangles: new Uint32Array(),
    halfedges: new Int32Array(),
    hull: Uint32Array.of(0, 2, 1),
  };
  const { ends: lines } = voronoiEdges(points, ONE, mesh, { low: [-10, -10], high: [10, 10] });
  assert.equal(lines.length, 12);
  for (const i of [0, 3]) {
    closeTo(lines[i] + lines[i + 1], 1, 4);
    closeTo(lines[6 + i] + lines[7 + i], 4, 4);
  }
});

test('a large offset costs no precision', () => {
  const points = CLOUDS.uniform;
  const far = points.map((x) => x + 2 ** 22);
  const near = far.map((x) => x - 2 ** 22);
  const [of, nearOf] = [frameOf(far, 2), frameOf(near, 2)];
  const box = { low: [-1, -1], high: [1, 1] } as const;
  closeTo(
    lengthOf(voronoiEdges(far, of, triangulate(near), box).ends),
    lengthOf(voronoiEdges(near, nearOf, triangulate(near), box).ends),
    4,
  );
});

test('triangles are measured, and turned towards the eye', () => {
  const points = Float64Array.of(0, 0, 4, 0, 0, 3);
  const mesh = triangulate(points);
  const { volume, circumradius, radiusRatio } = measureTriangles(points, mesh.triangles);
  assert.deepEqual([volume[0], circumradius[0]], [6, 2.5]);
  // Inradius 1.
  closeTo(radiusRatio[0], 0.8, 6);
  const [ax, ay, , bx, by, , cx, cy] = flatSurface(
    mesh,
    Uint32Array.of(0),
    () => 0,
    null,
  ).positions;
  assert.ok((bx - ax) * (cy - ay) - (by - ay) * (cx - ax) > 0);
});
