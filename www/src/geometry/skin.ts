/** What the outside of an object looks like. */
export interface Outside {
  /** One byte a tetrahedron: 1 for those that the object consists of. */
  kept: Uint8Array;
  /** Red, green and blue once a point; null where the points have no colours of their own. */
  colors: Uint8Array | null;
}

/** The colour of an object that has none of its own: of plaster, under a lamp. */
export const PLAIN = [214, 201, 182] as const;

/** Whether a facet belongs to the outside, with the tetrahedron across it: -1 for none. */
export function isOutside(across: number, { kept }: Outside): boolean {
  return across < 0 || kept[across] === 0;
}

/** Gives a corner the colour of its point. */
export function paint(
  skin: Uint8Array,
  corner: number,
  colors: Uint8Array | null,
  point: number,
): void {
  for (let k = 0; k < 3; k++) skin[4 * corner + k] = colors ? colors[3 * point + k] : PLAIN[k];
  skin[4 * corner + 3] = 255;
}
