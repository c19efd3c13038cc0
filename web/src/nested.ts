// Treemaps: cells of given areas within a convex polygon, and within these cells others.

import type { Doubles, Indices } from './arrays.js';
import { GdelError } from './errors.js';

/** The corners of a convex polygon: x, y, x, y, …, in either orientation. */
type Outline = ArrayLike<number>;

/** Returns twice the area of a polygon, negative if it is clockwise with y up. */
function doubledArea(outline: Outline): number {
  const n = outline.length;
  let sum = 0;
  for (let i = 0; i < n; i += 2) {
    const j = (i + 2) % n;
    // Relative to the first corner, so that large offsets do no harm.
    const [x, y] = [outline[i]! - outline[0]!, outline[i + 1]! - outline[1]!];
    sum += x * (outline[j + 1]! - outline[1]!) - y * (outline[j]! - outline[0]!);
  }
  return sum;
}

/** The cells of weighted points within a convex polygon. */
export interface PowerCells {
  /** Where the corners of each cell begin; one more entry says where the last ones end. */
  offsets: Indices;
  /** The corners of all cells: x, y, x, y, … */
  outlines: Doubles;
  areas: Doubles;
  /** NaN where a cell is empty. */
  centroids: Doubles;
}

/** What is to be laid out. */
export interface TreemapTask {
  /** The corners of the convex shape: x, y, x, y, … */
  corners: Doubles;
  /** The node that each node is in, −1 for the shape itself; no node comes before the one that it is in. */
  parents: Int32Array;
  /** The value of each node: not negative, and that of one with others in it is their sum. */
  values: Doubles;
  /** Where the sites of nodes begin, NaN where they may be anywhere: x, y, x, y, … */
  sites?: Doubles | undefined;
  options: {
    /** How often the sites move to the centres of their cells. */
    relax: number;
    /** The share of its value by which a cell's area may be wrong. */
    tolerance: number;
  };
}

/** A treemap as arrays; nodes without a value have NaN, and no corners. */
export interface TreemapArrays extends Omit<PowerCells, 'centroids'> {
  sites: Doubles;
  /** The least of each cell is 0. */
  weights: Doubles;
  /** The largest share by which an area is wrong. */
  error: number;
  /** The number of Newton's steps. */
  steps: number;
}

/** A part of the progress: where it begins, and how long it is. */
export type Span = readonly [start: number, length: number];

/** What finds weights and cells. */
export interface Solver {
  weights(
    points: Doubles,
    corners: Doubles,
    masses: Doubles,
    tolerance: number,
    span: Span,
  ): { weights: Doubles; steps: number };
  cells(points: Doubles, weights: Doubles, corners: Doubles): PowerCells;
  /** Returns the corners of the convex hull, none if it has no inside. */
  hull(points: Doubles): Doubles;
  /** Returns sites for which equal weights are nearly right. */
  sites(corners: Doubles, masses: Doubles): Doubles;
}

/** The cells of those nodes that are within one cell, or within the shape. */
interface Family {
  outline: Outline;
  nodes: number[];
}

/** Lays out all nodes. */
export function layOut(task: TreemapTask, solver: Solver): TreemapArrays {
  const { corners, parents, values } = task;
  const children = new Map<number, number[]>();
  parents.forEach((parent, i) => {
    if (!(values[i]! > 0)) return;
    const siblings = children.get(parent);
    if (siblings) siblings.push(i);
    else children.set(parent, [i]);
  });
  const count = parents.length;
  const outlines: Outline[] = Array.from({ length: count }, () => []);
  const weights = new Float64Array(count).fill(NaN);
  const sites = new Float64Array(2 * count).fill(NaN);
  let [error, steps, done] = [0, 0, 0];
  const pending: Family[] = [];
  const first = children.get(-1);
  if (first) pending.push({ outline: shapeOf(corners, solver), nodes: first });
  for (let family = pending.pop(); family; family = pending.pop()) {
    const { outline, nodes } = family;
    const found = inOne(family, task, solver, [done / count, nodes.length / count]);
    nodes.forEach((node, i) => {
      outlines[node] = outlineOf(found, i);
      weights[node] = found.weights[i]!;
      sites.set(found.sites.subarray(2 * i, 2 * i + 2), 2 * node);
      const inside = children.get(node);
      if (inside) pending.push({ outline: outlines[node], nodes: inside });
    });
    // What is within a cell has its error, too.
    error = Math.max(error, errorOf(nodes, outline, values, outlines));
    steps += found.steps;
    done += nodes.length;
  }
  return { ...packed(outlines), sites, weights, error, steps };
}

/** Returns the corners of a cell. */
const outlineOf = ({ offsets, outlines }: PowerCells, i: number): Doubles =>
  outlines.slice(2 * offsets[i]!, 2 * offsets[i + 1]!);

/** Returns the largest share by which an area within an outline is wrong. */
function errorOf(
  nodes: readonly number[],
  outline: Outline,
  values: Doubles,
  outlines: readonly Outline[],
): number {
  let sum = 0;
  for (const node of nodes) sum += values[node]!;
  const perValue = Math.abs(doubledArea(outline)) / sum;
  let error = 0;
  for (const node of nodes) {
    const wanted = perValue * values[node]!;
    error = Math.max(error, Math.abs(Math.abs(doubledArea(outlines[node]!)) / wanted - 1));
  }
  return error;
}

/** By so much of its area, a shape may be smaller than its convex hull: its corners are rounded. */
const DENT = 1e-9;

/** Returns the corners of a shape, which has to be convex up to rounding. */
function shapeOf(corners: Doubles, solver: Solver): Doubles {
  const hull = solver.hull(corners);
  const area = Math.abs(doubledArea(hull));
  if (!(area > 0)) throw new GdelError('BAD_INPUT', 'the shape must have an inside');
  if (Math.abs(doubledArea(corners)) < (1 - DENT) * area)
    throw new GdelError('BAD_INPUT', 'the shape must be convex, with its corners in order');
  return hull;
}

/** Finds the cells within one outline. */
function inOne(
  { outline, nodes }: Family,
  { values, sites: given, options: { relax, tolerance } }: TreemapTask,
  solver: Solver,
  [start, length]: Span,
): PowerCells & { weights: Doubles; sites: Doubles; steps: number } {
  // Rounding makes dents in a cell.
  const corners = solver.hull(Float64Array.from(outline));
  const masses = Float64Array.from(nodes, (node) => values[node]!);
  let sites = solver.sites(corners, masses);
  nodes.forEach((node, i) => {
    const at = given?.subarray(2 * node, 2 * node + 2);
    if (at?.every(Number.isFinite)) sites.set(at, 2 * i);
  });
  let steps = 0;
  const solve = (round: number) => {
    const share = length / (relax + 1);
    const span = [start + round * share, share] as const;
    const { weights, ...more } = solver.weights(sites, corners, masses, tolerance, span);
    steps += more.steps;
    return { ...solver.cells(sites, weights, corners), weights };
  };
  let found = solve(0);
  const apart = separated(sites, masses, found, solver);
  if (apart) {
    sites = apart;
    found = solve(0);
  }
  for (let round = 1; round <= relax; round++) {
    sites = centered(sites, found);
    found = solve(round);
  }
  const empty = nodes.findIndex((_, i) => found.offsets[i] === found.offsets[i + 1]);
  if (empty >= 0) {
    const value = `value ${nodes[empty]}, ${masses[empty]},`;
    throw new GdelError(
      'BAD_INPUT',
      `${value} is too small beside the others for a cell of its own`,
    );
  }
  return { ...found, sites, steps };
}

/** Returns sites in the centres of their cells. */
const centered = (sites: Doubles, { centroids }: PowerCells): Doubles =>
  sites.map((x, i) => (Number.isNaN(centroids[i]!) ? x : centroids[i]!));

/**
 * Returns sites of which no two are equal: those that share a cell are spread over it. Undefined if there are none.
 */
function separated(
  sites: Doubles,
  masses: Doubles,
  cells: PowerCells,
  solver: Solver,
): Doubles | undefined {
  const at = new Map<string, number[]>();
  masses.forEach((_, i) => {
    // Adding 0 makes −0 positive.
    const key = `${sites[2 * i]! + 0},${sites[2 * i + 1]! + 0}`;
    const there = at.get(key);
    if (there) there.push(i);
    else at.set(key, [i]);
  });
  if (at.size === masses.length) return undefined;
  const apart = sites.slice();
  for (const equal of at.values()) {
    if (equal.length === 1) continue;
    const owner = equal.find((i) => cells.offsets[i] !== cells.offsets[i + 1]);
    if (owner === undefined) continue;
    const own = Float64Array.from(equal, (i) => masses[i]!);
    const places = solver.sites(outlineOf(cells, owner), own);
    equal.forEach((i, place) => {
      apart.set(places.subarray(2 * place, 2 * place + 2), 2 * i);
    });
  }
  return apart;
}

/** Returns outlines one after the other, and their areas. */
function packed(all: readonly Outline[]): Omit<PowerCells, 'centroids'> {
  const offsets = new Uint32Array(all.length + 1);
  all.forEach((outline, i) => {
    offsets[i + 1] = offsets[i]! + outline.length / 2;
  });
  const outlines = new Float64Array(2 * offsets[all.length]!);
  all.forEach((outline, i) => {
    outlines.set(outline, 2 * offsets[i]!);
  });
  const areas = Float64Array.from(all, (outline) =>
    outline.length ? Math.abs(doubledArea(outline)) / 2 : 0,
  );
  return { offsets, outlines, areas };
}
