import type { Kept } from './filter';
import { FACETS, type Tetrahedralisation } from './mesh';
import type { Heights } from './plane';
import { isOutside, type Outside, paint } from './skin';

/** The facets that bound the tetrahedra which a filter keeps below a level. */
export interface Boundary {
  /** 4 · tetrahedron + the number of the vertex opposite. */
  facets: Uint32Array;
  /** How many tetrahedra are kept below the level. */
  shown: number;
}

/** Triangles ready for the GPU: no two share vertices. */
export interface Surface {
  /** Nine coordinates a triangle, counter-clockwise as seen from outside. */
  positions: Float32Array;
  /** The position of the triangle's tetrahedron on the colour scale, from 0 to 1, once a corner. */
  values: Float32Array;
  /** Red, green, blue once a corner, and 255 where they count; 0 where the value does. */
  skin: Uint8Array;
  /** The triangle's tetrahedron. */
  owners: Uint32Array;
}

/**
 * The boundary of the whole tetrahedra whose centroids are at most as high as `level`. Without
 * heights, of all that are kept.
 */
export function boundaryOf(
  { neighbors }: Tetrahedralisation,
  { kept, rim }: Kept,
  heights: Heights | null,
  level: number,
): Boundary {
  const isCut = (t: number) => heights !== null && heights.height[t] > level;
  const isNearCut = (t: number) => heights !== null && !(heights.reach[t] <= level);
  let facets = new Uint32Array(1 << 16);
  let count = 0;
  let shown = 0;
  for (let t = 0; t < kept.length; t++) {
    if (kept[t] === 0 || isCut(t)) continue;
    shown++;
    if (rim[t] === 0 && !isNearCut(t)) continue;
    for (let f = 4 * t; f < 4 * t + 4; f++) {
      const u = neighbors[f];
      if (u >= 0 && kept[u] === 1 && !isCut(u)) continue;
      if (count === facets.length) {
        const larger = new Uint32Array(2 * count);
        larger.set(facets);
        facets = larger;
      }
      facets[count++] = f;
    }
  }
  return { facets: facets.slice(0, count), shown };
}

/**
 * The triangles of some facets; those of the outside have its colours, if it is given.
 *
 * @param value the position on the colour scale, of a tetrahedron and the number of its facet
 */
export function surfaceOf(
  { positions, tetrahedra, neighbors }: Tetrahedralisation,
  facets: Uint32Array,
  value: (t: number, i: number) => number,
  outside: Outside | null,
): Surface {
  const corners = new Float32Array(9 * facets.length);
  const values = new Float32Array(3 * facets.length);
  const skin = new Uint8Array(12 * facets.length);
  const owners = new Uint32Array(facets.length);
  for (let i = 0; i < facets.length; i++) {
    const t = facets[i] >>> 2;
    const k = facets[i] & 3;
    const painted = outside && isOutside(neighbors[facets[i]], outside);
    for (let j = 0; j < 3; j++) {
      const vertex = tetrahedra[4 * t + FACETS[3 * k + j]];
      const p = 3 * vertex;
      if (painted) paint(skin, 3 * i + j, outside.colors, vertex);
      corners[9 * i + 3 * j] = positions[p];
      corners[9 * i + 3 * j + 1] = positions[p + 1];
      corners[9 * i + 3 * j + 2] = positions[p + 2];
    }
    owners[i] = t;
    values.fill(value(t, i), 3 * i, 3 * i + 3);
  }
  return { positions: corners, values, skin, owners };
}
