import type { Kept } from './filter';
import { FACETS, type Tetrahedralisation } from './mesh';
import type { Heights } from './plane';
import { isOutside, type Outside, paint } from './skin';
import type { Boundary } from './surface';

/** Whole tetrahedra, to be drawn one by one: pulled apart, or where no neighbours are known. */
export interface Pieces {
  /** Three coordinates a tetrahedron: its first, second, third and fourth vertex. */
  a: Float32Array;
  b: Float32Array;
  c: Float32Array;
  d: Float32Array;
  /** The tetrahedron's position on the colour scale, from 0 to 1. */
  values: Float32Array;
  /**
   * Red, green, blue once a vertex, 16 bytes a tetrahedron; the fourth byte of vertex k is 255 if
   * the facet opposite has the colours of its corners, and 0 if it has that of the value.
   */
  skin: Uint8Array;
  /** The number of the tetrahedron in the mesh. */
  owners: Uint32Array;
}

/**
 * Of the tetrahedra that a filter keeps below a level, those nearest to the surface, at most
 * `most`: layer by layer, from the facets of the boundary inwards. What lies deeper could hardly be
 * seen. Without heights, nothing is cut.
 */
export function outermost(
  { neighbors }: Tetrahedralisation,
  { kept }: Kept,
  heights: Heights | null,
  level: number,
  { facets }: Boundary,
  most: number,
): Uint32Array {
  const queue = new Uint32Array(most);
  const taken = new Uint8Array(kept.length);
  let end = 0;
  for (let i = 0; i < facets.length && end < most; i++) {
    const t = facets[i] >>> 2;
    if (taken[t]) continue;
    taken[t] = 1;
    queue[end++] = t;
  }
  for (let next = 0; next < end && end < most; next++) {
    for (let f = 4 * queue[next]; f < 4 * queue[next] + 4 && end < most; f++) {
      const u = neighbors[f];
      if (u < 0 || taken[u] || !kept[u] || (heights && heights.height[u] > level)) continue;
      taken[u] = 1;
      queue[end++] = u;
    }
  }
  return queue.slice(0, end);
}

/**
 * The given tetrahedra with their own copies of their corners; facets of the outside have its
 * colours, if it is given.
 */
export function piecesOf(
  { positions, tetrahedra, neighbors }: Tetrahedralisation,
  owners: Uint32Array,
  value: (t: number) => number,
  outside: Outside | null,
): Pieces {
  const count = owners.length;
  const corners = [0, 1, 2, 3].map(() => new Float32Array(3 * count));
  const values = new Float32Array(count);
  const skin = new Uint8Array(16 * count);
  for (let i = 0; i < count; i++) {
    const t = owners[i];
    for (let k = 0; k < 4; k++) {
      const vertex = tetrahedra[4 * t + k];
      const p = 3 * vertex;
      if (outside) {
        paint(skin, 4 * i + k, outside.colors, vertex);
        if (!isOutside(neighbors[4 * t + k], outside)) skin[16 * i + 4 * k + 3] = 0;
      }
      const corner = corners[k];
      corner[3 * i] = positions[p];
      corner[3 * i + 1] = positions[p + 1];
      corner[3 * i + 2] = positions[p + 2];
    }
    values[i] = value(t);
  }
  const [a, b, c, d] = corners;
  return { a, b, c, d, values, skin, owners };
}

/**
 * The pieces' facets as triangles, nine coordinates each, four a piece: moved apart by `apart`
 * times their centroids, and the whole scaled down to the size it had.
 */
export function trianglesOf({ a, b, c, d, owners }: Pieces, apart: number): Float32Array {
  const corners = [a, b, c, d];
  const triangles = new Float32Array(36 * owners.length);
  for (let i = 0; i < owners.length; i++) {
    for (let axis = 0; axis < 3; axis++) {
      const v = 3 * i + axis;
      const move = apart * 0.25 * (a[v] + b[v] + c[v] + d[v]);
      for (let j = 0; j < 12; j++)
        triangles[36 * i + 3 * j + axis] = (corners[FACETS[j]][v] + move) / (1 + apart);
    }
  }
  return triangles;
}

/** The skin of those triangles, four bytes a corner: see `Surface.skin`. */
export function skinOf({ skin, owners }: Pieces): Uint8Array {
  const corners = new Uint8Array(48 * owners.length);
  for (let i = 0; i < owners.length; i++) {
    for (let j = 0; j < 12; j++) {
      const own = 16 * i + 4 * FACETS[j];
      const opposite = 16 * i + 4 * Math.floor(j / 3);
      const at = 48 * i + 4 * j;
      for (let k = 0; k < 3; k++) corners[at + k] = skin[own + k];
      corners[at + 3] = skin[opposite + 3];
    }
  }
  return corners;
}
