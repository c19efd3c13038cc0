/** Simplices that are hashed before other events are handled. */
const SLICE = 1 << 18;

/** Returns a hash of a word, by the last steps of MurmurHash3. */
function mix(word: number): number {
  let h = (word + 0x9e3779b9) | 0;
  h = Math.imul(h ^ (h >>> 16), 0x85ebca6b);
  h = Math.imul(h ^ (h >>> 13), 0xc2b2ae35);
  return h ^ (h >>> 16);
}

/**
 * Returns a number that depends on the set of simplices and on which are neighbours, and not on their order.
 *
 * @param neighbors for each corner of each simplex what lies across the facet that goes with it, −1 outside: a
 *   simplex in 3D, a half-edge in 2D.
 */
export async function fingerprint(
  simplices: Uint32Array,
  neighbors: Int32Array,
  corners: 3 | 4,
): Promise<number> {
  const hashOf = (simplex: number) => {
    let sum = 0;
    // A sum, so that the order of the corners does not matter.
    for (let k = 0; k < corners; k++) sum = (sum + mix(simplices[corners * simplex + k])) | 0;
    return mix(sum);
  };
  const perSimplex = corners === 4 ? 1 : 3;
  let sum = 0;
  for (let t = 0; corners * t < simplices.length; t++) {
    if (t % SLICE === SLICE - 1) await new Promise((resolve) => setTimeout(resolve));
    const own = hashOf(t);
    for (let i = corners * t; i < corners * (t + 1); i++) {
      const across = neighbors[i] < 0 ? 0 : hashOf(Math.floor(neighbors[i] / perSimplex));
      sum = (sum + mix(own ^ mix(simplices[i]) ^ across)) | 0;
    }
  }
  return sum;
}
