import { FACETS } from './mesh';

/** The tetrahedron across the facet opposite each vertex; −1 where there is none. */
export function neighborsOf(tetrahedra: Uint32Array): Int32Array {
  const neighbors = new Int32Array(tetrahedra.length).fill(-1);
  // Facets that wait for the tetrahedron on their other side, by their points; at most half of the
  // places are taken.
  const bits = Math.max(4, Math.ceil(Math.log2(2 * tetrahedra.length + 1)));
  const places = new Int32Array(2 ** bits).fill(-1);
  const [mine, theirs] = [new Uint32Array(3), new Uint32Array(3)];
  const pointsOf = (facet: number, into: Uint32Array) => {
    for (let j = 0; j < 3; j++) into[j] = tetrahedra[(facet & ~3) + FACETS[3 * (facet & 3) + j]];
    if (into[0] > into[1]) [into[0], into[1]] = [into[1], into[0]];
    if (into[1] > into[2]) [into[1], into[2]] = [into[2], into[1]];
    if (into[0] > into[1]) [into[0], into[1]] = [into[1], into[0]];
  };
  for (let facet = 0; facet < tetrahedra.length; facet++) {
    pointsOf(facet, mine);
    const hash =
      Math.imul(mine[0], 0x9e3779b1) ^
      Math.imul(mine[1], 0x85ebca6b) ^
      Math.imul(mine[2], 0xc2b2ae35);
    let place = Math.imul(hash ^ (hash >>> 15), 0x27d4eb2f) >>> (32 - bits);
    for (; places[place] >= 0; place = (place + 1) & (places.length - 1)) {
      pointsOf(places[place], theirs);
      if (mine.every((point, j) => point === theirs[j])) break;
    }
    const other = places[place];
    if (other < 0) places[place] = facet;
    else {
      neighbors[facet] = other >> 2;
      neighbors[other] = facet >> 2;
    }
  }
  return neighbors;
}
