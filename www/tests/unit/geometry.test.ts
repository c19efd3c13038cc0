import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { keep, upTo } from '../../src/geometry/filter';
import { facetCircumradiusSquared, measure } from '../../src/geometry/measures';
import { FACETS, frameOf, toFrame } from '../../src/geometry/mesh';
import { neighborsOf } from '../../src/geometry/neighbors';
import { firstHit, placeOf } from '../../src/geometry/pick';
import { outermost, piecesOf, skinOf, trianglesOf } from '../../src/geometry/pieces';
import { heightsAlong, levelOf, spreadAlong } from '../../src/geometry/plane';
import { mapping, scaleFor } from '../../src/geometry/scale';
import { PLAIN } from '../../src/geometry/skin';
import { carvingRadii, criticalStops, solidRadius, spacingOf } from '../../src/geometry/solid';
import { boundaryOf, surfaceOf } from '../../src/geometry/surface';
import { AlphaRadii } from '../../src/model/alpha';
import { closeTo } from './close';

const SIDE = 4;

/**
 * The points of a grid, each cube of it in five tetrahedra, mirrored from cube to cube so that
 * their facets match.
 */
function grid() {
  const points: number[] = [];
  for (let x = 0; x <= SIDE; x++)
    for (let y = 0; y <= SIDE; y++) for (let z = 0; z <= SIDE; z++) points.push(x, y, z);
  const at = (x: number, y: number, z: number) => (x * (SIDE + 1) + y) * (SIDE + 1) + z;
  const tetrahedra: number[] = [];
  for (let x = 0; x < SIDE; x++) {
    for (let y = 0; y < SIDE; y++) {
      for (let z = 0; z < SIDE; z++) {
        const corner = (c: number) => {
          const bits = (x + y + z) % 2 ? c ^ 1 : c;
          return at(x + (bits & 1), y + ((bits >> 1) & 1), z + ((bits >> 2) & 1));
        };
        for (const t of [
          [0, 1, 2, 4],
          [3, 1, 2, 7],
          [5, 1, 4, 7],
          [6, 2, 4, 7],
          [1, 2, 4, 7],
        ])
          tetrahedra.push(...positive(points, t.map(corner)));
      }
    }
  }
  const mesh = Uint32Array.from(tetrahedra);
  return { points: Float64Array.from(points), tetrahedra: mesh, neighbors: naiveNeighbors(mesh) };
}

function positive(points: number[], [a, b, c, d]: number[]): number[] {
  const minus = (p: number, q: number) =>
    [0, 1, 2].map((k) => points[3 * p + k] - points[3 * q + k]);
  const [u, v, w] = [minus(b, a), minus(c, a), minus(d, a)];
  const volume =
    u[0] * (v[1] * w[2] - v[2] * w[1]) +
    u[1] * (v[2] * w[0] - v[0] * w[2]) +
    u[2] * (v[0] * w[1] - v[1] * w[0]);
  return volume > 0 ? [a, b, c, d] : [b, a, c, d];
}

function naiveNeighbors(tetrahedra: Uint32Array): Int32Array {
  const neighbors = new Int32Array(tetrahedra.length).fill(-1);
  const waiting = new Map<string, number>();
  for (let f = 0; f < tetrahedra.length; f++) {
    const key = [0, 1, 2]
      .map((j) => tetrahedra[(f & ~3) + FACETS[3 * (f & 3) + j]])
      .sort((p, q) => p - q)
      .join();
    const other = waiting.get(key);
    if (other === undefined) waiting.set(key, f);
    else {
      neighbors[f] = other >> 2;
      neighbors[other] = f >> 2;
    }
  }
  return neighbors;
}

const { points, tetrahedra, neighbors } = grid();
const count = tetrahedra.length / 4;
const frame = frameOf(points);
const positions = toFrame(points, frame);
const mesh = { positions, tetrahedra, neighbors };
const measures = measure(points, tetrahedra);
const all = keep(null, neighbors);

/** The volume that a closed surface encloses. */
function enclosed(triangles: Float32Array): number {
  let volume = 0;
  for (let i = 0; i < triangles.length; i += 9) {
    const [ax, ay, az, bx, by, bz, cx, cy, cz] = triangles.subarray(i, i + 9);
    volume += (ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)) / 6;
  }
  return volume;
}

test('neighbours are found, also of a part of the tetrahedra', () => {
  assert.deepEqual(neighborsOf(tetrahedra), neighbors);
  const part = tetrahedra.subarray(4 * 7, 4 * 93);
  assert.deepEqual(neighborsOf(part), naiveNeighbors(part));
  assert.deepEqual(neighborsOf(new Uint32Array(0)), new Int32Array(0));
});

describe('measures', () => {
  test('volumes add up to the cube', () => {
    closeTo(
      measures.volume.reduce((sum, v) => sum + v, 0),
      SIDE ** 3,
      3,
    );
  });

  test('a regular tetrahedron has radius ratio 1, its circumradius is right, also far away', () => {
    const regular = Float64Array.of(1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1).map((x) => x + 1e6);
    const { radiusRatio, circumradius, volume } = measure(regular, Uint32Array.of(0, 1, 2, 3));
    closeTo(radiusRatio[0], 1, 5);
    closeTo(circumradius[0], Math.sqrt(3), 5);
    closeTo(volume[0], 8 / 3, 5);
  });

  test('a flat tetrahedron has no volume and no finite circumradius', () => {
    const flat = measure(
      Float64Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0),
      Uint32Array.of(0, 1, 2, 3),
    );
    assert.deepEqual([flat.volume[0], flat.circumradius[0], flat.radiusRatio[0]], [0, Infinity, 0]);
  });
});

describe('the cut', () => {
  for (const normal of [
    [1, 0, 0],
    [0, 0, -1],
    [0.6, 0.64, 0.48],
  ] as const) {
    for (const keep of [0, 0.3, 0.5, 1]) {
      test(`along ${normal} at ${keep} bounds just the tetrahedra below it`, () => {
        const heights = heightsAlong(normal, mesh);
        const level = levelOf({ normal, keep }, spreadAlong(normal, mesh.positions));
        const { facets, shown } = boundaryOf(mesh, all, heights, level);
        if (level === Infinity)
          assert.deepEqual(boundaryOf(mesh, all, null, level), { facets, shown });
        const below = Array.from(heights.height.keys()).filter((t) => heights.height[t] <= level);
        assert.equal(shown, below.length);
        const surface = surfaceOf(mesh, facets, () => 0.5, null);
        const volume = below.reduce((sum, t) => sum + measures.volume[t], 0);
        // A surface that were open, or wound the wrong way somewhere, would enclose something else.
        closeTo(enclosed(surface.positions), volume * frame.scale ** 3, 4);
        const owners = new Set(below);
        assert.equal(
          surface.owners.every((t) => owners.has(t)),
          true,
        );
      });
    }
  }

  test('keeps everything at 1 and shows the hull', () => {
    const heights = heightsAlong([1, 0, 0], mesh);
    const { facets, shown } = boundaryOf(
      mesh,
      all,
      heights,
      levelOf({ normal: [1, 0, 0], keep: 1 }, spreadAlong([1, 0, 0], mesh.positions)),
    );
    assert.equal(shown, count);
    assert.equal(facets.length, 6 * 2 * SIDE * SIDE);
  });
});

describe('filters', () => {
  const carving = carvingRadii(points, tetrahedra, neighbors);
  const carved = (alpha: number) =>
    keep(upTo(carving, alpha), neighbors).kept.reduce((sum, kept) => sum + kept, 0);

  test('the alpha complex keeps what is small enough', () => {
    const { kept } = keep(upTo(measures.circumradius, 0.1), neighbors);
    assert.equal(
      kept.every((k) => k === 0),
      true,
    );
  });

  test('a slider stops at critical values, of which it leaves out some that are too near', () => {
    const radii = Float32Array.of(4, 1, 2, 0.5, 2, 2.0001, 1e9, Number.NaN, Infinity);
    // What is below the range is the first step, unless there is a larger one in it.
    assert.deepEqual([...criticalStops(radii, [1, 16], 4)], [1, 2.0001, 4].map(Math.fround));
    assert.deepEqual([...criticalStops(Float32Array.of(0.5), [1, 16], 4)], [0.5]);
    const fine = criticalStops(radii, [0.25, 1e9], 1e6);
    assert.deepEqual([...fine], [0.5, 1, 2, 2.0001, 4, 1e9].map(Math.fround));
    assert.deepEqual([...criticalStops(new Float32Array(0), [0, 0], 10)], []);
    assert.deepEqual([...criticalStops(Float32Array.of(3, 3), [3, 3], 10)], [3]);
    assert.deepEqual([...criticalStops(radii, [0, 16], 4)], [4]);
  });

  test('carving takes nothing from outside where no facet is large, and all where every facet is', () => {
    assert.equal(carved(1), count);
    assert.equal(carved(0.1), 0);
  });

  test('a ball of radius alpha carves a tetrahedron whose facets have a larger circumcircle', () => {
    const regular = Float64Array.of(1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1);
    const one = Uint32Array.of(0, 1, 2, 3);
    const outside = Int32Array.of(-1, -1, -1, -1);
    const radii = carvingRadii(regular, one, outside);
    // Equilateral facets with sides of √8.
    const circumradius = Math.sqrt(8 / 3);
    assert.deepEqual(
      [0.999, 1.001].map((times) => keep(upTo(radii, times * circumradius), outside).kept[0]),
      [0, 1],
    );
  });

  test('carving for every radius at once leaves what carving for one leaves', () => {
    const scattered = jittered(7);
    const radii = carvingRadii(scattered.points, scattered.tetrahedra, scattered.neighbors);
    for (const alpha of [0.05, 0.1, 0.2, 0.3, 0.5, 1]) {
      const expected = carveNaively(alpha, scattered);
      const kept = keep(upTo(radii, alpha), scattered.neighbors).kept;
      // Radii are told apart by a tenth of a percent.
      const wrong = [...kept].filter((k, t) => k !== expected[t]).length;
      assert.ok(wrong <= 0.002 * kept.length, `${wrong} of ${kept.length} differ for ${alpha}`);
    }
  });

  test('the solid of a grid is found as soon as its cubes hang together', () => {
    // Facets with two sides of a cube, and those across it: the latter are inside.
    const radius = solidRadius(carving, measures.volume, tetrahedra, 3);
    closeTo(radius, Math.SQRT1_2, 1);
    assert.equal(carved(radius), count);
    const none = new Float32Array();
    assert.equal(solidRadius(none, none, new Uint32Array(), 3), Infinity);
  });

  test('an uneven scan closes, and outliers do not blow it up', () => {
    // Four points hang together by a chain of tetrahedra of radius 1; at 3 the inside comes in, and
    // a point that belongs to nothing at 100.
    const radii = Float32Array.of(...Array(600).fill(1), 3, 3, 100);
    const volumes = Float32Array.of(...Array(600).fill(0.002), 5, 5, 20);
    const simplices = Uint32Array.from([...radii.keys()].flatMap((t) => [t, t + 1, t + 2, t + 3]));
    assert.equal(solidRadius(radii, volumes, simplices, 3), 3);
    // Land has no inside: its small holes close, and no more.
    volumes.fill(0.01);
    const ramp = radii.map((_, t) => 1 + t / 1000);
    closeTo(solidRadius(ramp, volumes, simplices, 3), 2 * 1.588, 1);
  });

  test('the slider stops at critical values from the spacing to what bounds the object, not beyond', () => {
    const alphas = new AlphaRadii(
      points,
      tetrahedra,
      neighbors,
      3,
      frameOf(points),
      () => measures,
      null,
    );
    const { value, isAuto, stops } = alphas.of({ kind: 'carve', alpha: null })!;
    closeTo(value, Math.SQRT1_2, 1);
    assert.ok(isAuto);
    // The spacing, 1, is larger than what suits here, from which on there are stops then.
    assert.ok(stops[0] <= 1, `${stops[0]}`);
    assert.ok(stops.every((stop, i) => i === 0 || stop > stops[i - 1]));
    assert.ok(stops[stops.length - 1] <= (SIDE / 2) * Math.sqrt(3), `${stops}`);
    const radii = new Set(alphas.radii('carve'));
    assert.ok(stops.every((stop) => radii.has(stop)));
    const chosen = alphas.of({ kind: 'carve', alpha: 1.5 })!;
    assert.deepEqual([chosen.value, chosen.isAuto], [1.5, false]);
    assert.equal(alphas.of({ kind: 'all', alpha: null }), null);
  });

  test('the spacing is an edge of the grid', () => {
    closeTo(spacingOf(points, tetrahedra, 3), 1, 5);
  });
});

/** The grid with its points moved at random: not Delaunay, but as good for carving. */
function jittered(seed: number) {
  let state = seed;
  const random = () => {
    state = (state * 1103515245 + 12345) % 2 ** 31;
    return state / 2 ** 31;
  };
  return { points: points.map((x) => 0.2 * (x + 0.45 * random())), tetrahedra, neighbors };
}

/** Carves for one radius, from outside inwards. */
function carveNaively(
  alpha: number,
  { points, tetrahedra, neighbors }: ReturnType<typeof jittered>,
): Uint8Array {
  const kept = new Uint8Array(tetrahedra.length / 4).fill(1);
  const isOpen = (t: number, k: number) => {
    const [a, b, c] = [0, 1, 2].map((j) => tetrahedra[4 * t + FACETS[3 * k + j]]);
    return facetCircumradiusSquared(points, a, b, c) > alpha * alpha;
  };
  for (let changed = true; changed; ) {
    changed = false;
    for (let t = 0; t < kept.length; t++) {
      for (let k = 0; k < 4; k++) {
        const u = neighbors[4 * t + k];
        if (!kept[t] || (u >= 0 && kept[u]) || !isOpen(t, k)) continue;
        kept[t] = 0;
        changed = true;
      }
    }
  }
  return kept;
}

describe('pieces', () => {
  const heights = heightsAlong([1, 0, 0], mesh);
  const boundary = boundaryOf(mesh, all, heights, Infinity);

  test('all tetrahedra where there is room, each once', () => {
    const owners = outermost(mesh, all, heights, Infinity, boundary, count);
    assert.deepEqual(
      [...owners].sort((a, b) => a - b),
      [...Array(count).keys()],
    );
  });

  test('the outermost first where there is not', () => {
    const outer = new Set([...boundary.facets].map((f) => f >>> 2));
    const owners = outermost(mesh, all, heights, Infinity, boundary, outer.size);
    assert.deepEqual(new Set(owners), outer);
    assert.equal(outermost(mesh, all, heights, Infinity, boundary, 3).length, 3);
  });

  test('are closed, and all shrink alike when pulled apart', () => {
    const owners = Uint32Array.from({ length: count }, (_, t) => t);
    const pieces = piecesOf(mesh, owners, () => 0, null);
    for (const apart of [0, 0.7]) {
      closeTo(
        enclosed(trianglesOf(pieces, apart)),
        (SIDE * frame.scale) ** 3 / (1 + apart) ** 3,
        4,
      );
    }
  });
});

describe('the skin', () => {
  const heights = heightsAlong([1, 0, 0], mesh);
  /** Every point has a colour of its own. */
  const colors = Uint8Array.from(positions, (_, i) => (17 * i) % 251);
  const bytesOf = (values: ArrayLike<number>, at: number, length: number) =>
    Array.from({ length }, (_, k) => values[at + k]);
  /** The colour of the point at a corner. */
  const colorAt = (triangles: Float32Array, corner: number) => {
    const place = bytesOf(triangles, 3 * corner, 3).join();
    for (let p = 0; p < positions.length; p += 3)
      if (bytesOf(positions, p, 3).join() === place) return bytesOf(colors, p, 3);
    assert.fail('the corner is no point');
  };
  const outside = { kept: all.kept, colors };

  test('is on the outside and not on the cut', () => {
    const level = levelOf({ normal: [1, 0, 0], keep: 0.5 }, spreadAlong([1, 0, 0], mesh.positions));
    const { facets } = boundaryOf(mesh, all, heights, level);
    const { skin, positions: triangles } = surfaceOf(mesh, facets, () => 0, outside);
    let cut = 0;
    for (let corner = 0; corner < skin.length / 4; corner++) {
      const isOutside = mesh.neighbors[facets[Math.floor(corner / 3)]] < 0;
      assert.equal(skin[4 * corner + 3], isOutside ? 255 : 0);
      if (isOutside) assert.deepEqual(bytesOf(skin, 4 * corner, 3), colorAt(triangles, corner));
      else cut++;
    }
    assert.ok(cut > 0 && cut < skin.length / 4);
  });

  test('is plain without colours, and nowhere where nobody asks for it', () => {
    const { facets } = boundaryOf(mesh, all, heights, Infinity);
    const plain = surfaceOf(mesh, facets, () => 0, { kept: all.kept, colors: null }).skin;
    for (let at = 0; at < plain.length; at += 4)
      assert.deepEqual(bytesOf(plain, at, 4), [...PLAIN, 255]);
    assert.ok(surfaceOf(mesh, facets, () => 0, null).skin.every((byte) => byte === 0));
  });

  test('is on the same facets of pieces', () => {
    const owners = Uint32Array.from({ length: count }, (_, t) => t);
    const pieces = piecesOf(mesh, owners, () => 0, outside);
    const skin = skinOf(pieces);
    const triangles = trianglesOf(pieces, 0);
    for (let corner = 0; corner < skin.length / 4; corner++) {
      const isOutside = mesh.neighbors[Math.floor(corner / 3)] < 0;
      assert.equal(skin[4 * corner + 3], isOutside ? 255 : 0);
      assert.deepEqual(bytesOf(skin, 4 * corner, 3), colorAt(triangles, corner));
    }
  });
});

test('a ray meets the nearest triangle that faces it', () => {
  const heights = heightsAlong([1, 0, 0], mesh);
  const { facets } = boundaryOf(mesh, all, heights, Infinity);
  const { positions: triangles, owners } = surfaceOf(mesh, facets, () => 0, null);
  const hit = firstHit(triangles, { origin: [5, 0.05, 0.03], direction: [-1, 0, 0] });
  assert.ok(hit);
  const { triangle, weights } = hit;
  const xs = [0, 3, 6].map((j) => triangles[9 * triangle + j]);
  for (const x of xs) closeTo(x, SIDE * 0.5 * frame.scale, 5);
  assert.equal(owners[triangle], facets[triangle] >>> 2);
  closeTo(weights[0] + weights[1] + weights[2], 1, 6);
  const place = placeOf(triangles, hit);
  for (const [axis, x] of [SIDE * 0.5 * frame.scale, 0.05, 0.03].entries())
    closeTo(place[axis], x, 5);
  assert.equal(firstHit(triangles, { origin: [5, 2, 0], direction: [-1, 0, 0] }), null);
});

test('scales leave out the extremes and stay within the map', () => {
  const kept = all.kept;
  const scale = scaleFor('volume', { measured: measures }, kept);
  closeTo(scale.domain[0], 1 / 6, 5);
  closeTo(scale.domain[1], 1 / 3, 5);
  const value = mapping(scale, { measured: measures }, null);
  for (let t = 0; t < count; t++) assert.ok(value(t) >= 0);
  closeTo(
    mapping(scaleFor('quality', { measured: measures }, kept), { measured: measures }, null)(4),
    1,
    5,
  );
});
