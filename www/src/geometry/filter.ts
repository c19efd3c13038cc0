/** Which simplices are shown, before the cutting plane cuts. */
export interface Filter {
  kind: FilterKind;
  /** In units of the input; null for one that suits the points, `any` until that is found. */
  alpha: number | 'any' | null;
}

export type FilterKind =
  /** Every simplex: the points' convex hull is full. */
  | 'all'
  /** The alpha complex: the simplices with a circumradius of at most alpha. */
  | 'alpha'
  /** The solid that the closed surface of a scan encloses. */
  | 'surface'
  /** What a ball of radius alpha cannot carve away from outside; see `carvingRadii`. */
  | 'carve';

/** What a filter left. */
export interface Kept {
  /** One byte a tetrahedron: 1 for those that the filter keeps. */
  kept: Uint8Array;
  /** One byte a tetrahedron: 1 for those kept beside one that is not, or beside the outside. */
  rim: Uint8Array;
}

/**
 * One byte a simplex: 1 for those whose radius is at most alpha. Alpha is rounded as the radii were,
 * so that it keeps what has this radius.
 */
export function upTo(radii: Float32Array, alpha: number): Uint8Array {
  const limit = Math.fround(alpha);
  const kept = new Uint8Array(radii.length);
  for (let t = 0; t < kept.length; t++) kept[t] = radii[t] <= limit ? 1 : 0;
  return kept;
}

/** Keeps the tetrahedra with a 1; all if there is no list. */
export function keep(listed: Uint8Array | null, neighbors: Int32Array): Kept {
  const kept = listed ?? new Uint8Array(neighbors.length / 4).fill(1);
  const rim = new Uint8Array(kept.length);
  if (!listed) {
    for (let f = 0; f < neighbors.length; f++) if (neighbors[f] < 0) rim[f >> 2] = 1;
    return { kept, rim };
  }
  for (let t = 0; t < kept.length; t++) {
    if (!kept[t]) continue;
    for (let f = 4 * t; f < 4 * t + 4; f++) {
      const u = neighbors[f];
      if (u < 0 || !kept[u]) {
        rim[t] = 1;
        break;
      }
    }
  }
  return { kept, rim };
}
