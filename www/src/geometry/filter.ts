import { facetCircumradiusSquared } from './measures';
import { FACETS } from './mesh';

/** Which tetrahedra a filter keeps, before the plane cuts. */
export type Filter =
  /** Every tetrahedron: the points' convex hull is full. */
  | { kind: 'all' }
  /** The alpha complex's tetrahedra: those with a circumradius of at most alpha. */
  | { kind: 'alpha'; alpha: number }
  /**
   * What a ball of radius alpha cannot carve away from outside: it enters through the facets whose circumcircle is larger
   * than it. Of a scanned surface, this leaves the solid.
   */
  | { kind: 'carve'; alpha: number };

/** What a filter left. */
export interface Kept {
  /** One byte a tetrahedron: 1 for those that the filter keeps. */
  kept: Uint8Array;
  /** One byte a tetrahedron: 1 for those kept beside one that is not, or beside the outside. */
  rim: Uint8Array;
}

/** Applies a filter to all tetrahedra. */
export function applyFilter(
  filter: Filter,
  points: ArrayLike<number>,
  tetrahedra: Uint32Array,
  neighbors: Int32Array,
  circumradius: Float32Array,
): Kept {
  const kept = keptBy(filter, points, tetrahedra, neighbors, circumradius);
  const rim = new Uint8Array(kept.length);
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

function keptBy(
  filter: Filter,
  points: ArrayLike<number>,
  tetrahedra: Uint32Array,
  neighbors: Int32Array,
  circumradius: Float32Array,
): Uint8Array {
  const count = tetrahedra.length / 4;
  const kept = new Uint8Array(count);
  if (filter.kind === 'all') return kept.fill(1);
  if (filter.kind === 'alpha') {
    for (let t = 0; t < count; t++) kept[t] = circumradius[t] <= filter.alpha ? 1 : 0;
    return kept;
  }
  return carve(filter.alpha, points, tetrahedra, neighbors, kept.fill(1));
}

function carve(
  alpha: number,
  points: ArrayLike<number>,
  tetrahedra: Uint32Array,
  neighbors: Int32Array,
  kept: Uint8Array,
): Uint8Array {
  const open = (t: number, k: number) =>
    facetCircumradiusSquared(
      points,
      tetrahedra[4 * t + FACETS[3 * k]],
      tetrahedra[4 * t + FACETS[3 * k + 1]],
      tetrahedra[4 * t + FACETS[3 * k + 2]],
    ) >
    alpha * alpha;

  const carved = new Uint32Array(kept.length);
  let end = 0;
  const take = (t: number) => {
    kept[t] = 0;
    carved[end++] = t;
  };
  for (let t = 0; t < kept.length; t++) {
    for (let k = 0; k < 4; k++) {
      if (kept[t] && neighbors[4 * t + k] < 0 && open(t, k)) take(t);
    }
  }
  for (let next = 0; next < end; next++) {
    const t = carved[next];
    for (let k = 0; k < 4; k++) {
      const u = neighbors[4 * t + k];
      if (u >= 0 && kept[u] && open(t, k)) take(u);
    }
  }
  return kept;
}

/**
 * An alpha that suits a cloud: ten times the typical distance between neighbouring points, measured as the median of the
 * shortest edges of a sample of the simplices, tetrahedra or triangles.
 */
export function typicalAlpha(
  points: ArrayLike<number>,
  simplices: Uint32Array,
  dimension: 2 | 3 = 3,
): number {
  const corners = dimension + 1;
  const count = simplices.length / corners;
  const samples = Math.min(count, 10_000);
  const shortest = new Float64Array(samples);
  for (let i = 0; i < samples; i++) {
    const t = corners * Math.floor((i * count) / samples);
    let least = Infinity;
    for (let j = 0; j < corners; j++) {
      for (let k = j + 1; k < corners; k++) {
        let squared = 0;
        for (let axis = 0; axis < dimension; axis++) {
          squared +=
            (points[dimension * simplices[t + j] + axis] -
              points[dimension * simplices[t + k] + axis]) **
            2;
        }
        least = Math.min(least, squared);
      }
    }
    shortest[i] = Math.sqrt(least);
  }
  shortest.sort();
  return samples > 0 ? 10 * shortest[samples >> 1] : 0;
}
