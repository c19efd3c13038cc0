// Treemaps of cells with exactly given areas, in a worker or in the calling thread.

import { GdelError, loadPower, powerNow, runPower } from './index.js';
import type { TreemapArrays, TreemapTask } from './nested.js';
import type { TaskOptions } from './types.js';

/** The place of a site or of a corner. */
export type Position = [number, number];

/** What a treemap fills: `[xmin, ymin, xmax, ymax]`, or the corners of a convex polygon in order. */
export type Shape = readonly [number, number, number, number] | ArrayLike<ArrayLike<number>>;

/** Options of {@link treemapSync}. */
export interface TreemapSyncOptions<T> {
  /** What the cells fill. Default: the unit square. */
  shape?: Shape | undefined;
  /**
   * Returns the value of an item, to which the area of its cell is proportional: a finite number that is not negative.
   * By default the item itself, or its property `value`. That of an item with children is the sum of theirs.
   */
  value?: ((item: T, index: number) => number) | undefined;
  /** Returns the items whose cells are within that of this one. By default, its property `children`. */
  children?: ((item: T) => ArrayLike<T> | null | undefined) | undefined;
  /** Returns where the site of an item begins; by default, and if it is not inside, that is chosen. */
  site?: ((item: T, index: number) => ArrayLike<number> | null | undefined) | undefined;
  /**
   * How often the sites move to the centres of their cells, which makes the cells rounder and takes as long as the
   * first time. Default: 2, or 0 for more than 1000 items.
   */
  relax?: number | undefined;
  /** The share of its value by which the area of a cell may be wrong. Default: 0.001. */
  tolerance?: number | undefined;
}

/** Options of {@link treemap}. */
export interface TreemapOptions<T> extends TreemapSyncOptions<T>, TaskOptions {}

/**
 * The cell of an item: the corners of a convex polygon, counter-clockwise on a screen, where *y* points down. The last
 * one is not the first one again.
 */
export interface TreemapCell<T> extends Array<Position> {
  /** The item. */
  item: T;
  /** Its index among those that are within the same cell. */
  index: number;
  /** Its value. */
  value: number;
  /** The area of the polygon. */
  area: number;
  /** The site, which need not be inside. */
  site: Position;
  /** The weight of the site in the power diagram that the cell is of. */
  weight: number;
  /** The cells within this one, for each child of the item; null without children, and for those whose value is 0. */
  children: (TreemapCell<T> | null)[] | null;
}

/** Items as lists of numbers, which can be sent to a worker. */
interface Flat<T> {
  task: TreemapTask;
  items: T[];
  indices: number[];
}

/** What cells fill if nothing else is said. */
const UNIT: Shape = [0, 0, 1, 1];

/** From so many items on, cells are as round as they are at first unless more is asked for. */
const MANY = 1000;

const bad = (message: string, index?: number) =>
  new GdelError('BAD_INPUT', message, index === undefined ? {} : { index });

/** Returns the corners of a shape: x, y, x, y, … */
export function cornersOf(shape: Shape): Float64Array<ArrayBuffer> {
  const given = Array.from(shape as ArrayLike<unknown>);
  const isBox = given.length === 4 && given.every((x) => typeof x === 'number');
  if (isBox) {
    const [x0, y0, x1, y1] = given as [number, number, number, number];
    if (!(x0 < x1 && y0 < y1)) throw bad(`the shape [${given}] must have an inside`);
    return Float64Array.of(x0, y0, x0, y1, x1, y1, x1, y0);
  }
  const corners = Float64Array.from(given.flatMap((corner) => Array.from(corner as Position)));
  if (given.length < 3 || corners.length !== 2 * given.length || !corners.every(Number.isFinite))
    throw bad('the shape must be four numbers, or three or more corners [x, y]');
  return corners;
}

/** Lists the items, each after the one that it is in. */
function flatten<T>(items: ArrayLike<T>, options: TreemapSyncOptions<T>): Flat<T> {
  const {
    shape = UNIT,
    value = (item) =>
      typeof item === 'number' ? item : ((item as { value: number } | null)?.value as number),
    children = (item) => (item as { children?: ArrayLike<T> } | null)?.children,
    site,
    tolerance = 1e-3,
  } = options;
  const all: Flat<T> = { task: undefined!, items: [], indices: [] };
  const parents: number[] = [];
  const values: number[] = [];
  const add = (some: ArrayLike<T>, parent: number) => {
    for (let i = 0; i < some.length; i++) {
      all.items.push(some[i]!);
      all.indices.push(i);
      parents.push(parent);
    }
  };
  add(items, -1);
  const isLeaf: boolean[] = [];
  // The list grows meanwhile.
  for (let i = 0; i < all.items.length; i++) {
    const inside = children(all.items[i]!);
    if (inside?.length)
      for (let at = parents[i]!; at >= 0; at = parents[at]!)
        if (all.items[at] === all.items[i]) throw bad('an item is within itself');
    isLeaf.push(!inside?.length);
    if (inside?.length) add(inside, i);
  }
  all.items.forEach((item, i) => {
    const own = isLeaf[i] ? value(item, all.indices[i]!) : 0;
    if (typeof own !== 'number' || !(own >= 0 && own < Infinity))
      throw bad(`value ${i} must be a finite number from 0 on, not ${String(own)}`, i);
    values.push(own);
  });
  for (let i = values.length - 1; i >= 0; i--)
    if (parents[i]! >= 0) values[parents[i]!]! += values[i]!;
  const sum = values.reduce((sum, own, i) => (parents[i] === -1 ? sum + own : sum), 0);
  if (items.length > 0 && !(sum > 0 && sum < Infinity))
    throw bad(sum > 0 ? 'the sum of the values is not finite' : 'all values are 0');
  const { relax = all.items.length > MANY ? 0 : 2 } = options;
  if (!Number.isInteger(relax) || relax < 0 || relax > 1000)
    throw bad(`the option relax must be an integer from 0 to 1000, not ${String(relax)}`);
  if (!(typeof tolerance === 'number' && tolerance > 0 && tolerance < 1))
    throw bad(`the option tolerance must be a number between 0 and 1, not ${String(tolerance)}`);
  const corners = cornersOf(shape);
  const isInside = (x: number, y: number) => {
    const sides = new Set<number>();
    for (let i = 0; i < corners.length; i += 2) {
      const j = (i + 2) % corners.length;
      const [x0, y0] = [corners[i]!, corners[i + 1]!];
      sides.add(Math.sign((corners[j]! - x0) * (y - y0) - (corners[j + 1]! - y0) * (x - x0)));
    }
    return !(sides.has(1) && sides.has(-1));
  };
  const placeOf = (i: number): ArrayLike<number> => {
    const place = parents[i] === -1 && site?.(all.items[i]!, all.indices[i]!);
    return place && place.length === 2 && isInside(place[0]!, place[1]!) ? place : [NaN, NaN];
  };
  all.task = {
    corners,
    parents: Int32Array.from(parents),
    values: Float64Array.from(values),
    sites: site && Float64Array.from(values.flatMap((_, i) => Array.from(placeOf(i)))),
    options: { relax, tolerance },
  };
  return all;
}

/** Returns the corners of a cell. */
export function polygonOf(
  { offsets, outlines }: Pick<TreemapArrays, 'offsets' | 'outlines'>,
  i: number,
): Position[] {
  const polygon: Position[] = [];
  for (let at = offsets[i]!; at < offsets[i + 1]!; at++)
    polygon.push([outlines[2 * at]!, outlines[2 * at + 1]!]);
  return polygon;
}

/** A treemap. */
export class Treemap<T> {
  /** The cell of each item; null for those whose value is 0. */
  readonly cells: (TreemapCell<T> | null)[];
  /** The largest share by which an area differs from that which the values ask for. */
  readonly error: number;
  /** The number of Newton's steps, of all levels. */
  readonly steps: number;
  readonly #flat: Flat<T>;
  readonly #arrays: TreemapArrays;
  /** Weights with which the cells at the top are equal. */
  #equal: Promise<TreemapArrays> | undefined;

  /** @internal */
  constructor(flat: Flat<T>, arrays: TreemapArrays) {
    this.#flat = flat;
    this.#arrays = arrays;
    this.error = arrays.error;
    this.steps = arrays.steps;
    const all = flat.items.map((_, i) => {
      const polygon = polygonOf(arrays, i);
      return polygon.length > 0
        ? this.#cell(polygon, i, arrays.areas[i]!, arrays.weights[i]!)
        : null;
    });
    this.cells = [];
    flat.task.parents.forEach((parent, i) => {
      const within = parent === -1 ? this.cells : all[parent];
      if (parent === -1) this.cells.push(all[i]!);
      else if (within) ((within as TreemapCell<T>).children ??= []).push(all[i]!);
    });
  }

  #cell(polygon: Position[], i: number, area: number, weight: number): TreemapCell<T> {
    const { items, indices, task } = this.#flat;
    const { sites } = this.#arrays;
    return Object.assign(polygon, {
      item: items[i]!,
      index: indices[i]!,
      value: task.values[i]!,
      area,
      site: [sites[2 * i]!, sites[2 * i + 1]!] as Position,
      weight,
      children: null,
    });
  }

  /**
   * Returns the cells of the items at the top on their way from equal areas, at 0, to the right ones, at 1: those of
   * the power diagram whose weights are between. No cell vanishes on the way: the root of its area is a concave
   * function of the share, so that it is never below what is between the roots at both ends.
   *
   * ```js
   * for (let share = 0; share <= 1; share += 1 / 60) draw(await map.between(share));
   * ```
   *
   * @throws `GdelError` `BAD_INPUT` if the share is not between 0 and 1; `ABORTED`.
   */
  async between(share: number, options: TaskOptions = {}): Promise<(TreemapCell<T> | null)[]> {
    if (!(share >= 0 && share <= 1))
      throw bad(`the share must be a number from 0 to 1, not ${String(share)}`);
    const { task } = this.#flat;
    const used: number[] = [];
    task.parents.forEach((parent, i) => {
      if (parent === -1 && task.values[i]! > 0) used.push(i);
    });
    const points = Float64Array.from(
      used.flatMap((i) => [...this.#arrays.sites.subarray(2 * i, 2 * i + 2)]),
    );
    this.#equal ??= runPower(
      'treemap',
      {
        corners: task.corners,
        parents: new Int32Array(used.length).fill(-1),
        values: new Float64Array(used.length).fill(1),
        sites: points,
        options: { relax: 0, tolerance: task.options.tolerance },
      },
      options,
    );
    let equal: TreemapArrays;
    try {
      equal = await this.#equal;
    } catch (error) {
      // The next call tries again.
      this.#equal = undefined;
      throw error;
    }
    const weights = Float64Array.from(
      used,
      (i, at) => (1 - share) * equal.weights[at]! + share * this.#arrays.weights[i]!,
    );
    const found = await runPower('powerCells', { points, weights, corners: task.corners }, options);
    const cells: (TreemapCell<T> | null)[] = this.cells.map(() => null);
    used.forEach((i, at) => {
      const cell = this.#cell(polygonOf(found, at), i, found.areas[at]!, weights[at]!);
      cells[cell.index] = cell;
    });
    return cells;
  }
}

/** Checks items. */
function listOf<T>(items: ArrayLike<T>): ArrayLike<T> {
  if (!Array.isArray(items) && !ArrayBuffer.isView(items)) throw bad('the items must be an array');
  return items;
}

/**
 * Divides a convex shape into cells whose areas are those of the items' values, exactly up to the tolerance: the power
 * diagram of weights that optimal transport finds. Always ends; the same input has the same result. Works in a worker.
 *
 * ```js
 * import { treemap } from 'gdel-wasm/treemap';
 *
 * const { cells } = await treemap(countries, { value: (country) => country.population, shape: [0, 0, 960, 500] });
 * for (const cell of cells) if (cell) drawPolygon(cell, cell.item.name);
 * ```
 *
 * @throws `GdelError` `BAD_INPUT` with the `index` of a value that is negative or not finite, counted with those before
 * it at all levels; or if all are 0, the shape is not convex, or values differ so much that rounding leaves a cell
 * nothing; `ABORTED`.
 */
export async function treemap<T>(
  items: ArrayLike<T>,
  options: TreemapOptions<T> = {},
): Promise<Treemap<T>> {
  const { signal, onProgress, ...others } = options;
  const flat = flatten(listOf(items), others);
  return new Treemap(flat, await runPower('treemap', flat.task, { signal, onProgress }));
}

/** Loads the WebAssembly module that {@link treemapSync} needs. Later calls do nothing. */
treemap.load = (): Promise<void> => loadPower();

/**
 * Returns the same as {@link treemap}, computed in the calling thread.
 *
 * @throws `GdelError` `NOT_LOADED` before `treemap.load()` is done, and what {@link treemap} is rejected with.
 */
export function treemapSync<T>(
  items: ArrayLike<T>,
  options: TreemapSyncOptions<T> = {},
): Treemap<T> {
  const flat = flatten(listOf(items), options);
  return new Treemap(flat, powerNow('treemap', flat.task));
}

export default treemap;
