import type { Spread } from './plane';
import { PLAIN } from './skin';

/**
 * What the GPU needs to cut a mesh by itself, with how many bytes an item of each takes, and
 * whether items are tetrahedra or points.
 */
export const CUT_PARTS = {
  tetrahedra: { of: 'tetrahedra', bytes: 16 },
  neighbors: { of: 'tetrahedra', bytes: 16 },
  /** Of the centroids, as integers in the same order: {@link inOrder}. */
  heights: { of: 'tetrahedra', bytes: 4 },
  /** {@link KEPT} and {@link RIM}. */
  filtered: { of: 'tetrahedra', bytes: 1 },
  /** Positions on the colour scale. */
  values: { of: 'tetrahedra', bytes: 4 },
  /** As drawn. */
  positions: { of: 'points', bytes: 12 },
  /** Red, green, blue and 255. */
  colors: { of: 'points', bytes: 4 },
} as const;

export type CutPart = keyof typeof CUT_PARTS;

export const KEPT = 1;
export const RIM = 2;

/** Marks facets of the outside among those that the GPU lists. */
export const OUTSIDE = 0x8000_0000;

/** What a drawing says to the GPU that cuts the mesh by itself. */
export interface CutOf {
  tetrahedra: number;
  points: number;
  /** What is in each part, in words: other contents have other ones. */
  parts: Record<CutPart, string>;
  /** The direction of the heights, and what the plane's height follows from. */
  heights: Spread;
  /** Whether the outside looks different. */
  skin: boolean;
}

/**
 * Floats as integers in the same order. They compare alike on all devices, of which some take the
 * smallest floats for zero.
 */
export function inOrder(heights: Float32Array): Int32Array<ArrayBuffer> {
  const bits = new Int32Array(heights.length);
  new Float32Array(bits.buffer).set(heights);
  for (let i = 0; i < bits.length; i++) {
    // Negative numbers run the other way, and their zero is that of the others.
    if (bits[i] < 0) bits[i] = bits[i] === -0x8000_0000 ? 0 : bits[i] ^ 0x7fff_ffff;
  }
  return bits;
}

/** The highest of these integers whose float is not above a level. */
export function levelInOrder(level: number): number {
  const rounded = Math.fround(level);
  const [bits] = inOrder(Float32Array.of(rounded));
  return rounded > level ? bits - 1 : bits;
}

/** Bytes for {@link CUT_PARTS}'s `filtered`. */
export function filterBytes(kept: Uint8Array, rim: Uint8Array): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(kept.length);
  for (let t = 0; t < bytes.length; t++) bytes[t] = (kept[t] ? KEPT : 0) | (rim[t] ? RIM : 0);
  return bytes;
}

/** Colours of some points in four bytes each; plaster's where the points have none. */
export function colorBytes(
  colors: Uint8Array | null,
  from: number,
  to: number,
): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(4 * (to - from));
  for (let i = from, at = 0; i < to; i++, at += 4) {
    for (let k = 0; k < 3; k++) bytes[at + k] = colors ? colors[3 * i + k] : PLAIN[k];
    bytes[at + 3] = 255;
  }
  return bytes;
}
