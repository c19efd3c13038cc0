// Cases for the predicates in WGSL, in 3D and 2D, with their signs in big integers; and the
// assembly of WGSL.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from './package.mjs';

/**
 * The WGSL of a file with its includes resolved, each once, and these values for placeholders: `{
 * width, dim }`.
 */
export function assemble(path, values, included = new Set()) {
  const lines = readFileSync(join(root, path), 'utf8').split('\n');
  const resolved = lines.map((line) => {
    const name = line
      .match(/^\/\/!include (.*)/)?.[1]
      .trim()
      .replace(/\{(\w+)\}/, (_, key) => values[key]);
    if (!name) return line;
    if (included.has(name)) return '';
    included.add(name);
    return assemble(`shaders/${name}.wgsl`, values, included);
  });
  return resolved.join('\n');
}

const BITS = { narrow: 31n, wide: 62n };

/** SplitMix64: the same cases in every run. */
function generator(seed) {
  let state = BigInt(seed);
  const mask = (1n << 64n) - 1n;
  const next = () => {
    state = (state + 0x9e3779b97f4a7c15n) & mask;
    let x = state;
    x = ((x ^ (x >> 30n)) * 0xbf58476d1ce4e5b9n) & mask;
    x = ((x ^ (x >> 27n)) * 0x94d049bb133111ebn) & mask;
    return x ^ (x >> 31n);
  };
  /** Returns a number from min to max, both included. */
  const between = (min, max) => min + (next() % (max - min + 1n));
  const small = (min, max) => Number(between(BigInt(min), BigInt(max)));
  const shuffle = (array) => {
    for (let i = array.length - 1; i > 0; i--) {
      const j = small(0, i);
      [array[i], array[j]] = [array[j], array[i]];
    }
    return array;
  };
  return { between, small, shuffle };
}

const list = (length, item) => Array.from({ length }, (_, i) => item(i));

/** How the points of a case lie: d coordinates from 0 to `max` each of d + 2 points. */
const FAMILIES = {
  uniform: (d, max, { between }) => list(d + 2, () => list(d, () => between(0n, max))),
  corners: (d, max, { small }) => list(d + 2, () => list(d, () => (small(0, 1) ? max : 0n))),
  smallGrid: grid,
  /** In a plane, or on a line in 2D, exactly or off by one. */
  flat(d, max, { between, small }) {
    const limit = max / 64n;
    const directions = list(d - 1, () => list(d, () => between(-limit, limit)));
    const off = small(-2, d + 1);
    return list(d + 2, (i) => {
      const steps = directions.map(() => between(-8n, 8n));
      return list(d, (axis) => {
        const along = directions.reduce(
          (sum, direction, k) => sum + steps[k] * direction[axis],
          max / 2n,
        );
        return i === off && axis === 0 ? along + 1n : along;
      });
    });
  },
  /** On a line. */
  collinear(d, max, { between }) {
    const direction = list(d, () => between(-max / 32n, max / 32n));
    return list(d + 2, () => {
      const step = between(-8n, 8n);
      return direction.map((x) => max / 2n + step * x);
    });
  },
  /** On a sphere, or a circle, with lattice points, exactly or off by one. */
  cospherical(d, max, { between, small, shuffle }) {
    const vectors =
      d === 3
        ? [
            [0, 0, 9],
            [1, 4, 8],
            [4, 4, 7],
            [3, 6, 6],
          ]
        : [
            [0, 65],
            [16, 63],
            [25, 60],
            [33, 56],
            [39, 52],
          ];
    const scale = between(1n, max / (d === 3 ? 20n : 140n));
    const off = small(0, d + 1);
    return list(d + 2, (i) => {
      const vector = shuffle(vectors[small(0, vectors.length - 1)].slice());
      const nudge = i === off ? between(-1n, 1n) : 0n;
      return vector.map(
        (x, axis) =>
          max / 2n + (small(0, 1) ? scale : -scale) * BigInt(x) + (axis === 1 ? nudge : 0n),
      );
    });
  },
  /** As near to each other as a millionth of the range. */
  clustered(d, max, { between }) {
    const near = list(d, () => between(0n, max - max / 1_000_000n));
    return list(d + 2, () => near.map((x) => x + between(0n, max / 1_000_000n)));
  },
};

/**
 * A few steps apart, at the ends of the lattice or anywhere: all kinds of degeneracy, also points
 * that coincide.
 */
function grid(d, max, { between, small }) {
  const side = between(1n, 4n);
  const step = small(0, 1) ? 1n : between(1n, max / side);
  const most = max - step * side;
  const origin = list(d, () => [0n, most, between(0n, most)][small(0, 2)]);
  return list(d + 2, () => origin.map((x) => x + step * between(0n, side)));
}

/** The names of the families. */
export const families = Object.keys(FAMILIES);

/** `count` cases of a family: of each vertex its position and index. */
export function cases(family, dimension, width, count) {
  const random = generator(1 + Object.keys(FAMILIES).indexOf(family));
  const max = (1n << BITS[width]) - 1n;
  return list(count, () => {
    const positions = FAMILIES[family](dimension, max, random);
    // Indices in no order, and large ones too.
    const base = random.small(0, 1) ? 0 : 0xffff_ffff - 16;
    const indices = random.shuffle(list(16, (i) => base + i));
    return positions.map((position, i) => ({ position, index: indices[i] }));
  });
}

/** By the cofactors of the first column. */
function determinant(rows) {
  if (rows.length === 1) return rows[0][0];
  return rows.reduce((sum, [first], i) => {
    if (first === 0n) return sum;
    const others = rows.filter((_, j) => j !== i).map((row) => row.slice(1));
    return sum + (i % 2 ? -first : first) * determinant(others);
  }, 0n);
}

const sign = (value) => (value > 0n ? 1 : value < 0n ? -1 : 0);

/**
 * The exact signs of a case: the orientation of all vertices but the last, as det(b − a, c − a, …);
 * the determinant of the in-sphere test; that with ties broken by the heights of the points, the
 * lowest index first, which is 0 only where all points are coplanar, or collinear in 2D; and the
 * orientation with ties broken by the last vertex for the interior point, as far as heights decide.
 */
export function exactSigns(vertices) {
  const flat = vertices.map(({ position }) => [...position, 1n]);
  const minus = (p, q) => p.map((x, axis) => x - q[axis]);
  const [first, ...others] = vertices.slice(0, -1).map(({ position }) => position);
  const orientation = sign(determinant(others.map((p) => minus(p, first))));
  const lifted = flat.map((row) => [row.slice(0, -1).reduce((sum, x) => sum + x * x, 0n), ...row]);
  const inSphere = sign(determinant(lifted));
  // Of a set of points that is flat, the last vertex's cofactor is 0.
  const byIndex = [...vertices.keys()].sort((i, j) => vertices[i].index - vertices[j].index);
  const cofactor = (i) => (i % 2 ? -1 : 1) * sign(determinant(flat.filter((_, j) => j !== i)));
  const broken = inSphere || (byIndex.map(cofactor).find((s) => s !== 0) ?? 0);
  return { orientation, inSphere, broken, leaning: orientation || broken };
}

/** The contents of the kernel's input buffers: words of 32 bits. */
export function buffers(cases, dimension, width) {
  // In 3D the interior point comes behind: here, where the last vertex is.
  const interior = (vertices) => ({ ...vertices.at(-1), index: 0xffff_ffff });
  const vertices = cases.flatMap((five) => (dimension === 3 ? [...five, interior(five)] : five));
  const high = (x) => (width === 'wide' ? Number(x >> 31n) : Number(x));
  const low = (x) => Number(x & 0x7fff_ffffn);
  const words = vertices.flatMap(({ position, index }) => {
    const [highs, lows] = [position.map(high), width === 'wide' ? position.map(low) : []];
    if (dimension === 2) return [...highs, ...lows];
    return [...highs, index, ...(lows.length ? [...lows, 0] : [])];
  });
  return dimension === 2 ? [words, vertices.map(({ index }) => index)] : [words];
}
