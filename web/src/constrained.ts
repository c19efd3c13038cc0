// What became of constraints: a part of the code that is loaded when there are some.

import type { Refinement } from './answers.js';
import type { Bytes, Indices, SignedIndices } from './arrays.js';
import { bad } from './options.js';

/** The arrays and numbers of {@link Constrained}. */
export interface ConstrainedArrays {
  /** The constrained edges: two vertices each, the lower one first, in ascending order. */
  readonly edges: Indices;
  /** One per triangle: 1 if it is inside the boundaries, else 0. */
  readonly inside: Bytes;
  /** One per triangle: the number of its region. Constrained edges separate regions. */
  readonly regions: Indices;
  /** The segments, two points each: `edges`, `rings`, `polygons`, cut where a point was put at a crossing. */
  readonly segments: Indices;
  /** How many segments were ignored, since their ends are equal. */
  readonly zeroLength: number;
  /** How many points were put at crossings, which are the last ones. */
  readonly added: number;
  /** The greatest distance of such a point from its crossing. */
  readonly moved: number;
  /** What refinement has done, if the mesh is its result. */
  readonly refinement?: Refinement;
  /** After refinement: the segment before it that each segment is a piece of; −1 for edges of the hull. */
  readonly segmentOf?: SignedIndices;
}

/** What became of the constraints of a 2D mesh. */
export interface Constrained extends ConstrainedArrays {}
// biome-ignore lint/suspicious/noUnsafeDeclarationMerging: the constructor assigns what the interface has.
export class Constrained {
  readonly #duplicateOf: SignedIndices;

  /** @internal */
  constructor(arrays: ConstrainedArrays, duplicateOf: SignedIndices) {
    Object.assign(this, arrays);
    this.#duplicateOf = duplicateOf;
  }

  /** Returns whether there is a constrained edge between two points, which may be duplicates. */
  isEdge(a: number, b: number): boolean {
    const [low, high] = [this.#first(a), this.#first(b)].sort((v, w) => v - w) as [number, number];
    const { edges } = this;
    let [start, end] = [0, edges.length / 2];
    while (start < end) {
      const middle = (start + end) >> 1;
      const difference = edges[2 * middle]! - low || edges[2 * middle + 1]! - high;
      if (difference === 0) return true;
      if (difference < 0) start = middle + 1;
      else end = middle;
    }
    return false;
  }

  /** Returns the point that stands for point `i`. */
  #first(i: number): number {
    const of = this.#duplicateOf[i];
    if (of === undefined) throw bad('the point', 'the index of a point', i);
    return of === -1 ? i : of;
  }
}
