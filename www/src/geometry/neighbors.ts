import { FACETS } from './mesh';

/** Triples of points, in whatever order, with numbers. */
export class Triples {
  private count = 0;
  private readonly bits: number;
  /** The number of the triple in each place, plus one; at most half of the places are taken. */
  private readonly places: Uint32Array;
  private readonly points: Uint32Array;

  constructor(most: number) {
    this.bits = Math.max(4, Math.ceil(Math.log2(2 * most + 1)));
    this.places = new Uint32Array(2 ** this.bits);
    this.points = new Uint32Array(3 * most);
  }

  /** Numbers a triple, and returns the number of the same one before; −1 if there is none. */
  add(a: number, b: number, c: number): number {
    const place = this.placeOf(a, b, c);
    this.count++;
    if (this.places[place] > 0) return this.places[place] - 1;
    this.places[place] = this.count;
    return -1;
  }

  has(a: number, b: number, c: number): boolean {
    return this.places[this.placeOf(a, b, c)] > 0;
  }

  /** The place of a triple, or that where it would be, with its points noted for the next number. */
  private placeOf(a: number, b: number, c: number): number {
    const [low, high] = [Math.min(a, b, c), Math.max(a, b, c)];
    // Exact in double precision.
    const middle = a + b + c - low - high;
    const { points, places, bits } = this;
    const mixed =
      Math.imul(low, 0x9e3779b1) ^ Math.imul(middle, 0x85ebca6b) ^ Math.imul(high, 0xc2b2ae35);
    let place = Math.imul(mixed ^ (mixed >>> 15), 0x27d4eb2f) >>> (32 - bits);
    for (; places[place] > 0; place = (place + 1) & (places.length - 1)) {
      const p = 3 * (places[place] - 1);
      if (points[p] === low && points[p + 1] === middle && points[p + 2] === high) return place;
    }
    if (3 * this.count < points.length) points.set([low, middle, high], 3 * this.count);
    return place;
  }
}

/** The tetrahedron across the facet opposite each vertex; −1 where there is none. */
export function neighborsOf(tetrahedra: Uint32Array): Int32Array {
  const neighbors = new Int32Array(tetrahedra.length).fill(-1);
  const facets = new Triples(tetrahedra.length);
  for (let facet = 0; facet < tetrahedra.length; facet++) {
    const other = facets.add(...cornersOf(tetrahedra, facet));
    if (other < 0) continue;
    neighbors[facet] = other >> 2;
    neighbors[other] = facet >> 2;
  }
  return neighbors;
}

/** The points of a facet: 4 · tetrahedron + the number of the vertex opposite. */
export function cornersOf(tetrahedra: Uint32Array, facet: number): [number, number, number] {
  const [first, at] = [facet & ~3, 3 * (facet & 3)];
  return [
    tetrahedra[first + FACETS[at]],
    tetrahedra[first + FACETS[at + 1]],
    tetrahedra[first + FACETS[at + 2]],
  ];
}
