// Polygons and lines in the plane, in a chunk of its own: most visitors have points.

import { type Fill, type Refinement, readShapes, type Shapes } from 'gdel-wasm';
import { addsPoint, drawPolygons, type Edit, FILLS, type Meshing, removedBy } from './edits';

/** What the segments of files are, by the indices of points. */
export type FileShapes = Pick<Shapes, 'edges' | 'rings' | 'holes' | 'fill' | 'leftOut'>;

/** What is to become of points, by their indices. */
export interface Constraints {
  /** Lines that bound nothing: two points each. */
  edges: number[];
  /** Closed polygons. */
  rings: number[][];
  /** The corners of the polygon that is drawn. */
  open: number[];
  holes: [number, number][];
  /** What is inside, by choice or because it suits. */
  fill: Fill;
  /** The rule that suits. */
  suits: Fill;
  meshing: Meshing;
}

/** A segment, by its two points. */
type Segment = readonly [number, number];

/** What the page shows of polygons and lines. */
export interface Constrained extends Omit<Constraints, 'holes'> {
  /** How many points there were before any change by hand. */
  start: number;
  /** What of the file was left out, such as `2 text`. */
  leftOut: readonly string[];
  /** The segments that cross, in pairs, where that is an error: the first of them. There is no mesh then. */
  crossing: readonly (readonly [Segment, Segment])[];
  /** How many points were put at crossings. */
  atCrossings: number;
  /** How the mesh was refined; null if it was not. */
  refinement: Refinement | null;
  angles: Angles;
}

/** The angles of the triangles inside. */
export interface Angles {
  /** In degrees; NaN without triangles. */
  smallest: number;
  /** How many there are from each multiple of {@link ANGLE_STEP} degrees to the next. */
  counts: number[];
}

/** How polygons are meshed unless something else is chosen. */
export const PLAIN: Meshing = { split: 0, fill: 0, minAngle: 0, maxArea: 0 };

/** The width of a bar of the histogram, in degrees. */
export const ANGLE_STEP = 5;

/** Refinement ends at so many points: more would take a browser too long for a slider. */
export const MOST_ADDED = 100_000;

/** Reads a file of shapes: three coordinates per point, of which the last one is 0. */
export async function readInSpace(
  content: Blob | ArrayBuffer,
  name: string,
  signal: AbortSignal,
): Promise<{ points: Float64Array; shapes: Shapes }> {
  const shapes = await readShapes(content, { name, signal });
  const points = new Float64Array((shapes.points.length / 2) * 3);
  for (let i = 0; i < shapes.points.length; i++) points[3 * (i >> 1) + (i & 1)] = shapes.points[i];
  return { points, shapes };
}

/** Returns the shapes of files whose points are taken together. */
export function together(
  parts: readonly { points: ArrayLike<number>; shapes?: Shapes | undefined }[],
): FileShapes {
  const all: FileShapes & { edges: Uint32Array } = {
    edges: new Uint32Array(),
    rings: [],
    holes: [],
    fill: 'evenodd',
    leftOut: [],
  };
  const fills = new Set<Fill>();
  const edges: number[] = [];
  let start = 0;
  for (const { points, shapes } of parts) {
    if (shapes) {
      const moved = (indices: Uint32Array) => indices.map((i) => start + i);
      for (const i of moved(shapes.edges)) edges.push(i);
      for (const ring of shapes.rings) all.rings.push(moved(ring));
      all.holes.push(...shapes.holes);
      all.leftOut.push(...shapes.leftOut);
      fills.add(shapes.fill);
    }
    start += points.length / 3;
  }
  return {
    ...all,
    edges: Uint32Array.from(edges),
    fill: fills.size === 1 ? [...fills][0] : 'evenodd',
  };
}

/** Returns the constraints after changes by hand to so many points; null where there are none. */
export function constraintsAfter(
  shapes: FileShapes | null,
  count: number,
  edits: readonly Edit[],
): Constraints | null {
  if (!shapes && !drawPolygons(edits)) return null;
  let edges = [...(shapes?.edges ?? [])];
  let rings = shapes?.rings.map((ring) => [...ring]) ?? [];
  let open: number[] = [];
  let meshing = PLAIN;
  let end = count;
  for (const edit of edits) {
    if (addsPoint(edit)) {
      if (edit.do === 'corner') open.push(end);
      end++;
    } else if (edit.do === 'join' && edit.point < end) open.push(edit.point);
    else if (edit.do === 'close') {
      if (open.length > 2) rings.push(open);
      open = [];
    } else if (edit.do === 'erase') rings.splice(edit.ring, 1);
    else if (edit.do === 'mesh') meshing = edit;
    const gone = removedBy(edit).filter((point) => point < end);
    if (gone.length === 0) continue;
    const left = renumbered(end, gone);
    end -= gone.length;
    rings = rings.map(left).filter((ring) => ring.length > 2);
    open = left(open);
    edges = edges.flatMap((_, e) => {
      const ends = e % 2 === 0 ? left(edges.slice(e, e + 2)) : [];
      return ends.length === 2 ? ends : [];
    });
  }
  const suits = fillFor(shapes?.fill ?? 'evenodd', rings, new Set(open).size === end);
  const holes = shapes?.holes ?? [];
  return { edges, rings, open, holes, fill: FILLS[meshing.fill] ?? suits, suits, meshing };
}

/** Returns what makes indices of so many points those of the points that are left. */
function renumbered(count: number, gone: readonly number[]): (indices: number[]) => number[] {
  const isGone = new Uint8Array(count);
  for (const point of gone) isGone[point] = 1;
  const now = new Uint32Array(count);
  for (let i = 0, left = 0; i < count; i++) {
    now[i] = left;
    left += 1 - isGone[i];
  }
  return (indices) => indices.filter((i) => !isGone[i]).map((i) => now[i]);
}

/** What suits: where nothing is bounded, all is inside, unless there is only the polygon that is drawn. */
function fillFor(own: Fill, rings: readonly number[][], isOnlyDrawn: boolean): Fill {
  return rings.length > 0 || own === 'enclosed' || isOnlyDrawn ? own : 'all';
}

/** The points that only this ring goes through, the last one first: they go with it. */
export function cornersOnlyOf(
  ring: number,
  { rings, edges, open }: Pick<Constraints, 'rings' | 'edges' | 'open'>,
): number[] {
  const others = new Set([...edges, ...open, ...rings.filter((_, i) => i !== ring).flat()]);
  return [...new Set(rings[ring])].filter((point) => !others.has(point)).sort((a, b) => b - a);
}
