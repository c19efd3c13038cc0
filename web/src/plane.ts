// Questions about a 2D mesh that are answered at once, in the calling thread.

import type { VoronoiArrays } from './answers.js';
import type { Coordinates, SignedIndices } from './arrays.js';

/** What the questions are about. */
interface Triangles {
  coords: Coordinates;
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
  { coords }: Triangles,
  rings: Rings,
  query: Point,
  start: number,
): number {
  const nearer = (a: number, b: number) =>
    compareDistances(
      query,
      [coords[2 * a]!, coords[2 * a + 1]!],
      [coords[2 * b]!, coords[2 * b + 1]!],
    );
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

type Point = readonly [number, number];

/** Returns the sign of |p − q|² − |p − r|², exactly, for all finite coordinates. */
function compareDistances(p: Point, q: Point, r: Point): number {
  const squared = (o: Point) => (p[0] - o[0]) ** 2 + (p[1] - o[1]) ** 2;
  const [one, other] = [squared(q), squared(r)];
  // Each has a relative error below 2⁻⁵⁰, where nothing overflows or underflows.
  const difference = one - other;
  const sum = one + other;
  if (sum > 1e-280 && sum < 1e300 && Math.abs(difference) > sum * 2 ** -49)
    return Math.sign(difference);
  const [px, py, qx, qy, rx, ry] = integers([...p, ...q, ...r]);
  const exactly = (x: bigint, y: bigint) => (px! - x) ** 2n + (py! - y) ** 2n;
  const [a, b] = [exactly(qx!, qy!), exactly(rx!, ry!)];
  return a < b ? -1 : a > b ? 1 : 0;
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

/**
 * Returns the Voronoi cells of collinear points within a box: it is cut in the middle between each
 * point and the next.
 */
export function stripes(
  { coords, hull, duplicateOf }: Triangles,
  [xmin, ymin, xmax, ymax]: readonly [number, number, number, number],
): VoronoiArrays {
  const count = duplicateOf.length;
  const vertices: number[] = [];
  const facets: number[] = [];
  const neighbors: number[] = [];
  const areas: number[] = [];
  const polygons = new Map<number, Corner[]>();
  for (let place = 0; place < hull.length; place++) {
    const i = hull[place]!;
    // Counter-clockwise where y points down, as the triangles are.
    let polygon: Corner[] = [
      { x: xmin, y: ymin, beyond: -1 },
      { x: xmin, y: ymax, beyond: -1 },
      { x: xmax, y: ymax, beyond: -1 },
      { x: xmax, y: ymin, beyond: -1 },
    ];
    for (const j of [hull[place - 1], hull[place + 1]])
      if (j !== undefined) polygon = nearerHalf(polygon, coords, i, j);
    polygons.set(i, polygon);
  }
  const cells = new Uint32Array(count + 1);
  const volumes = new Float64Array(count);
  const centroids = new Float64Array(2 * count).fill(Number.NaN);
  for (let i = 0; i < count; i++) {
    const polygon = polygons.get(i) ?? [];
    const first = vertices.length / 2;
    const [ox, oy] = [coords[2 * i]!, coords[2 * i + 1]!];
    let [twice, mx, my] = [0, 0, 0];
    polygon.forEach(({ x, y, beyond }, k) => {
      const to = polygon[(k + 1) % polygon.length]!;
      vertices.push(x, y);
      facets.push(first + k, first + ((k + 1) % polygon.length));
      neighbors.push(beyond);
      areas.push(Math.hypot(to.x - x, to.y - y));
      // The triangle with the point itself.
      const cross = (to.x - ox) * (y - oy) - (to.y - oy) * (x - ox);
      twice += cross;
      mx += cross * (x + to.x - 2 * ox);
      my += cross * (y + to.y - 2 * oy);
    });
    cells[i + 1] = neighbors.length;
    volumes[i] = twice / 2;
    if (twice > 0) {
      centroids[2 * i] = ox + mx / (3 * twice);
      centroids[2 * i + 1] = oy + my / (3 * twice);
    }
  }
  return {
    vertices: Float64Array.from(vertices),
    facetOffsets: Uint32Array.from({ length: neighbors.length + 1 }, (_, f) => 2 * f),
    facets: Uint32Array.from(facets),
    neighbors: Int32Array.from(neighbors),
    areas: Float64Array.from(areas),
    cells,
    volumes,
    centroids,
  };
}

/** A corner of a polygon, and what is beyond the edge that starts there: a point, or −1. */
interface Corner {
  x: number;
  y: number;
  beyond: number;
}

/** Returns the part of a polygon that is nearer to point `i` than to point `j`. */
function nearerHalf(polygon: Corner[], coords: Coordinates, i: number, j: number): Corner[] {
  const [px, py, qx, qy] = [coords[2 * i]!, coords[2 * i + 1]!, coords[2 * j]!, coords[2 * j + 1]!];
  const side = ({ x, y }: Corner) =>
    (x - px - (qx - px) / 2) * (qx - px) + (y - py - (qy - py) / 2) * (qy - py);
  const kept: Corner[] = [];
  polygon.forEach((from, k) => {
    const to = polygon[(k + 1) % polygon.length]!;
    const [s, t] = [side(from), side(to)];
    if (s < 0) kept.push(from);
    if (s < 0 === t < 0) return;
    const part = s / (s - t);
    const at = { x: from.x + part * (to.x - from.x), y: from.y + part * (to.y - from.y) };
    kept.push({ ...at, beyond: s < 0 ? j : from.beyond });
  });
  return kept;
}
