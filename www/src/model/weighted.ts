// Weights of points, in a chunk of its own: most visitors have none.

import type { Mesh2, Mesh3 } from 'gdel-wasm';
import type { Frame } from '../geometry/mesh';
import type { Triangulation } from '../geometry/triangles';
import type { Box, Voronoi } from '../geometry/voronoi';
import type { Weighing } from '../settings';
import { addsPoint, applyEdits, type Edit, removedBy } from './edits';
import { rowsIn, TableError } from './rows';
import type { Source } from './source';

/** What the page shows of weights. */
export interface Weights {
  /** The radius of each point, whose square is its weight, 0 where that is negative; null if all weights are the same. */
  radii: Float64Array | null;
  /** The points that heavier ones hide. */
  hidden: Uint32Array;
  /** The columns of the file that radii or weights can be taken from. */
  columns: string[];
}

/** A column of numbers, one per point. */
interface Column {
  name: string;
  /** Whether these are weights, not radii. */
  isWeight: boolean;
  values: Float64Array;
}

/** What columns with radii and with weights are called. */
const RADIUS = /^(r|rad|radius|radii|diameter|size)\b/i;
const WEIGHT = /^(w|weight|weights|mass|power)\b/i;

/** A file of text that is larger is not searched for columns. */
const LARGEST = 100_000_000;

/** Returns the weights of points after changes by hand, and in 2D the edges of their diagram. */
export async function weighed(
  points: Float32Array | Float64Array,
  source: Source,
  weighing: Weighing | null,
  edits: readonly Edit[],
): Promise<object> {
  const { dimension } = source;
  const first = weighing
    ? await weightsBy(weighing, points, source)
    : new Float64Array(points.length / dimension);
  const weights = weightsAfter(first, edits);
  if (dimension === 3) return { weights };
  const changed = applyEdits(points, edits);
  return {
    weights,
    edges: (_: unknown, frame: Frame, mesh: Triangulation, box: Box) =>
      powerEdges(changed, weights, frame, mesh, box),
  };
}

/** Returns the weights of the points as they came. */
async function weightsBy(
  { by, scale }: Weighing,
  points: Float32Array | Float64Array,
  source: Source,
): Promise<Float64Array> {
  const { dimension } = source;
  const count = points.length / dimension;
  if (by === 'random') {
    const spacing = spacingOf(points, dimension);
    return Float64Array.from({ length: count }, (_, i) => (scale * spacing * random(i)) ** 2);
  }
  const column = (await columnsOf(source)).find(({ name }) => name === by);
  if (!column) throw new Error(`the file has no column “${by}”`);
  const { values, isWeight } = column;
  if (values.length !== count)
    throw new Error(`the column “${by}” has ${values.length} numbers for ${count} points`);
  return values.map((x) => (isWeight ? x : x * x) * scale ** 2);
}

/** A number from 0 to 1 for each integer, the same in every visit. */
function random(i: number): number {
  let h = Math.imul(i + 1, 0x9e3779b9);
  h = Math.imul(h ^ (h >>> 16), 0x85ebca6b);
  h = Math.imul(h ^ (h >>> 13), 0xc2b2ae35);
  return ((h ^ (h >>> 16)) >>> 0) / 2 ** 32;
}

/** About how far points are apart that fill their box evenly. */
function spacingOf(points: ArrayLike<number>, dimension: number): number {
  const [low, high] = [Array(dimension).fill(Infinity), Array(dimension).fill(-Infinity)];
  for (let i = 0; i < points.length; i++) {
    low[i % dimension] = Math.min(low[i % dimension], points[i]);
    high[i % dimension] = Math.max(high[i % dimension], points[i]);
  }
  const volume = low.reduce((product, least, axis) => product * (high[axis] - least || 1), 1);
  return (volume / Math.max(1, points.length / dimension)) ** (1 / dimension);
}

/** Returns the weights after changes by hand: points that were added have none. */
export function weightsAfter(first: Float64Array, edits: readonly Edit[]): Float64Array {
  const weights = [...first];
  for (const edit of edits) {
    if (addsPoint(edit)) weights.push(0);
    else if (edit.do === 'weigh' && edit.point < weights.length)
      weights[edit.point] = edit.radius ** 2;
    for (const point of removedBy(edit)) if (point < weights.length) weights.splice(point, 1);
  }
  return Float64Array.from(weights);
}

/** Returns what the page shows of a mesh's weights. */
export async function weightsOf(mesh: Mesh2 | Mesh3, source: Source | null): Promise<Weights> {
  const radii = mesh.weights?.map((w) => Math.sqrt(Math.max(0, w))) ?? null;
  const columns = source ? (await columnsOf(source)).map(({ name }) => name) : [];
  return { radii, hidden: mesh.hidden, columns };
}

/** The columns of the last source. */
let known: { source: Source; columns: Promise<Column[]> } | null = null;

/** Returns the columns of a file of text with a line of names. */
function columnsOf(source: Source): Promise<Column[]> {
  if (known?.source !== source) known = { source, columns: readColumns(source) };
  return known.columns;
}

async function readColumns(source: Source): Promise<Column[]> {
  // Columns of several files would have to be joined; those of addresses would be fetched again.
  if (source.kind !== 'file' || source.files.length !== 1) return [];
  const [file] = source.files;
  if (!/\.(csv|txt|xyz|asc|tsv)$/i.test(file.name) || file.size > LARGEST) return [];
  try {
    return columnsIn(await file.text());
  } catch (error) {
    // Its points can be read nevertheless.
    if (error instanceof TableError) return [];
    throw error;
  }
}

/** A remark, or the mark before the names of columns. */
const REMARK = /^\s*(#|\/\/)\s*/;

/** Returns the columns of a table that are called like radii or weights. */
export function columnsIn(text: string): Column[] {
  const lines = text
    .replace(/^\uFEFF/, '')
    .split(/\r\n|\r|\n/)
    .filter((line) => line.trim() !== '');
  const header = lines.shift()?.replace(REMARK, '') ?? '';
  const [names] = rowsIn(header, { blanks: true });
  const wanted = (names?.cells ?? []).flatMap((name, at) => {
    const isWeight = WEIGHT.test(name);
    const share = /^diameter/i.test(name) ? 0.5 : 1;
    return isWeight || RADIUS.test(name)
      ? { name, at, isWeight, share, values: [] as number[] }
      : [];
  });
  if (wanted.length === 0) return [];
  const table = [header, ...lines.filter((line) => !REMARK.test(line))].join('\n');
  let isHeader = true;
  for (const { cells } of rowsIn(table, { blanks: true })) {
    if (!isHeader)
      for (const { at, share, values } of wanted) values.push(share * Number(cells[at] || NaN));
    isHeader = false;
  }
  return wanted.flatMap(({ name, isWeight, values }) =>
    values.length > 0 && values.every((x) => Number.isFinite(x) && (isWeight || x >= 0))
      ? { name, isWeight, values: Float64Array.from(values) }
      : [],
  );
}

/**
 * The edges of the power diagram within a box. Each is perpendicular to an edge of the mesh, from the power centre of
 * the triangle on one side to that of the other, and outside the hull goes on without end. As for Voronoi edges, what
 * is computed is where the centres are on the radical line.
 */
export function powerEdges(
  points: ArrayLike<number>,
  weights: ArrayLike<number>,
  { center, scale }: Frame,
  { triangles, halfedges, hull }: Triangulation,
  { low, high }: Box,
): Voronoi {
  const ends: number[] = [];
  const at = (p: number): [number, number, number] => [
    (points[2 * p] - center[0]) * scale,
    (points[2 * p + 1] - center[1]) * scale,
    weights[p] * scale * scale,
  ];
  /** A place on the radical line of p and q that is nearest to p, and the direction to the left of p → q. */
  const line = (p: number, q: number) => {
    const [px, py, pw] = at(p);
    const [qx, qy, qw] = at(q);
    const [dx, dy] = [qx - px, qy - py];
    const share = 0.5 + (pw - qw) / (2 * (dx * dx + dy * dy));
    return { x: px + share * dx, y: py + share * dy, nx: -dy, ny: dx, px, py, pw };
  };
  const add = (p: number, q: number, start: number, stop: number) => {
    const { x, y, nx, ny } = line(p, q);
    let [from, to] = [start, stop];
    // Liang and Barsky's clipping.
    for (const [place, by, min, max] of [
      [x, nx, low[0], high[0]],
      [y, ny, low[1], high[1]],
    ]) {
      if (by === 0) {
        if (place < min || place > max) return;
        continue;
      }
      const [s, t] = [(min - place) / by, (max - place) / by];
      from = Math.max(from, Math.min(s, t));
      to = Math.min(to, Math.max(s, t));
    }
    if (from < to) ends.push(x + from * nx, y + from * ny, 0, x + to * nx, y + to * ny, 0);
  };
  /** Where on the radical line of an edge the power centre of the triangle is. */
  const centerOf = (e: number): number => {
    const [p, q, r] = [triangles[e], triangles[next(e)], triangles[next(next(e))]];
    const { x, y, nx, ny, px, py, pw } = line(p, q);
    const [rx, ry, rw] = at(r);
    const [ux, uy] = [rx - px, ry - py];
    // On the radical line of p and r: u · (place − p) = (|u|² + pw − rw) / 2.
    const rest = (ux * ux + uy * uy + pw - rw) / 2 - ux * (x - px) - uy * (y - py);
    const along = ux * nx + uy * ny;
    return along === 0 ? Infinity : rest / along;
  };

  if (triangles.length === 0)
    for (let i = 1; i < hull.length; i++) add(hull[i - 1], hull[i], -Infinity, Infinity);
  for (let e = 0; e < triangles.length; e++) {
    const twin = halfedges[e];
    if (twin >= 0 && twin < e) continue;
    // Triangles are clockwise: e's own lies to the right, its twin's to the left.
    const right = centerOf(e);
    const left = twin < 0 ? Infinity : -centerOf(twin);
    // A line in the other direction has the other sign, and begins at the same place.
    if (left > right) add(triangles[e], triangles[next(e)], right, left);
  }
  return { ends: Float32Array.from(ends), box: { low, high } };
}

const next = (e: number) => (e % 3 === 2 ? e - 2 : e + 1);
