// Questions about triangles in a plane or on a sphere that are answered at once, in the calling thread.

import type { Coordinates, SignedIndices } from './arrays.js';

/** What the questions are about. */
interface Triangles {
  triangles: ArrayLike<number>;
  halfedges: ArrayLike<number>;
  hull: ArrayLike<number>;
  duplicateOf: SignedIndices;
}

const next = (e: number) => (e % 3 === 2 ? e - 2 : e + 1);

/** The vertices around each vertex. */
export class Rings {
  readonly #mesh: Triangles;
  /**
   * A half-edge that starts at each vertex, −1 if there is none; on the hull the one from which all
   * others are reached.
   */
  readonly #outgoing: Int32Array;
  /** If there are no triangles: the place of each point along the line, −1 for duplicates. */
  readonly #places: Int32Array;

  constructor(mesh: Triangles) {
    this.#mesh = mesh;
    const { triangles, halfedges, hull, duplicateOf } = mesh;
    this.#outgoing = new Int32Array(duplicateOf.length).fill(-1);
    for (let e = 0; e < triangles.length; e++) {
      const v = triangles[e]!;
      if (this.#outgoing[v] === -1 || halfedges[e] === -1) this.#outgoing[v] = e;
    }
    this.#places = new Int32Array(triangles.length === 0 ? duplicateOf.length : 0).fill(-1);
    if (triangles.length === 0)
      for (let place = 0; place < hull.length; place++) this.#places[hull[place]!] = place;
  }

  /** Returns the vertices that vertex `i` has an edge to; none for a duplicate. */
  of(i: number): number[] {
    const { triangles, halfedges, hull } = this.#mesh;
    const found: number[] = [];
    if (triangles.length === 0) {
      const place = this.#places[i]!;
      if (place > 0) found.push(hull[place - 1]!);
      if (place >= 0 && place + 1 < hull.length) found.push(hull[place + 1]!);
      return found;
    }
    const start = this.#outgoing[i]!;
    let e = start;
    while (e !== -1) {
      found.push(triangles[next(e)]!);
      // The half-edge that ends at the vertex, and the one that starts there on its other side.
      const incoming = next(next(e));
      e = halfedges[incoming]!;
      if (e === -1) found.push(triangles[incoming]!);
      if (e === start) break;
    }
    return found;
  }
}

/**
 * Returns the vertex that is nearest to a point, exactly; of several the one with the lowest index.
 * Every vertex that is not has a neighbour that is nearer, and those that are equally near hang
 * together: so a walk from `start` ends at the right one.
 */
export function findNearest(
  { coords }: { coords: Coordinates },
  rings: Rings,
  query: readonly number[],
  start: number,
): number {
  const nearer = (a: number, b: number) => compareDistances(query, coords, a, b);
  let best = start;
  for (;;) {
    let following = best;
    for (const v of rings.of(best)) if (nearer(v, following) < 0) following = v;
    if (following === best) break;
    best = following;
  }
  // All that are as near.
  const tied = new Set([best]);
  for (const at of tied) {
    for (const v of rings.of(at)) if (nearer(v, best) === 0) tied.add(v);
  }
  let lowest = best;
  for (const v of tied) lowest = Math.min(lowest, v);
  return lowest;
}

/**
 * Returns the sign of the difference of the squared distances of points `a` and `b` from a query, exactly, for
 * all finite coordinates.
 */
function compareDistances(
  query: readonly number[],
  coords: Coordinates,
  a: number,
  b: number,
): number {
  const { length } = query;
  const squared = (v: number) =>
    query.reduce((sum, x, axis) => sum + (x - coords[length * v + axis]!) ** 2, 0);
  const [one, other] = [squared(a), squared(b)];
  // Each has a relative error below 2⁻⁵⁰, where nothing overflows or underflows.
  const difference = one - other;
  const sum = one + other;
  if (sum > 1e-280 && sum < 1e300 && Math.abs(difference) > sum * 2 ** -49)
    return Math.sign(difference);
  const own = (v: number) => coords.subarray(length * v, length * v + length);
  const all = integers([...query, ...own(a), ...own(b)]);
  const exactly = (first: number) =>
    query.reduce((sum, _, axis) => sum + (all[axis]! - all[first + axis]!) ** 2n, 0n);
  const [p, q] = [exactly(length), exactly(2 * length)];
  return p < q ? -1 : p > q ? 1 : 0;
}

/** Returns numbers as multiples of one power of two. */
function integers(numbers: number[]): bigint[] {
  const parts = numbers.map((x) => {
    const bits = new BigUint64Array(new Float64Array([x]).buffer)[0]!;
    const exponent = Number((bits >> 52n) & 0x7ffn);
    const fraction = bits & 0xf_ffff_ffff_ffffn;
    const mantissa = exponent > 0 ? fraction | (1n << 52n) : fraction;
    return { mantissa: bits >> 63n ? -mantissa : mantissa, exponent: Math.max(exponent, 1) };
  });
  const used = parts.filter(({ mantissa }) => mantissa !== 0n).map(({ exponent }) => exponent);
  const lowest = Math.min(...used);
  return parts.map(({ mantissa, exponent }) =>
    mantissa === 0n ? 0n : mantissa << BigInt(exponent - lowest),
  );
}
