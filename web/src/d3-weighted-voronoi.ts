// The interface of the npm package d3-weighted-voronoi, in the calling thread.

import { type Clipped, Clipping, clippedMethods, property } from './clipping.js';
import { GdelError, loadPower, powerNow } from './index.js';
import { type Position, polygonOf } from './treemap.js';

/** The error of `d3-weighted-voronoi`, by its name. */
export { GdelError as d3WeightedVoronoiError };

/** What a cell belongs to. */
export interface Site<T> {
  x: number;
  y: number;
  weight: number;
  /** The element of the data. */
  originalObject: T;
}

/** A cell: its corners, counter-clockwise on a screen, without the first one again. */
export interface SitePolygon<T> extends Array<Position> {
  site: Site<T>;
}

/** An accessor. */
type Accessor<T> = (datum: T) => number;

/** A function that makes diagrams, and its settings. */
export interface WeightedVoronoi<T> extends Clipped<WeightedVoronoi<T>> {
  /**
   * Returns the cells of the power diagram of the data that are not empty, in their order.
   *
   * @throws `GdelError` `NOT_LOADED` before `weightedVoronoi.load()` is done; `NOT_FINITE` or `BAD_INPUT` with the
   * `index` of the datum.
   */
  (data: readonly T[]): SitePolygon<T>[];
  x(): Accessor<T>;
  /** Sets the accessor to the *x* coordinate, by default `d => d.x`. */
  x(x: Accessor<T>): this;
  y(): Accessor<T>;
  /** Sets the accessor to the *y* coordinate, by default `d => d.y`. */
  y(y: Accessor<T>): this;
  weight(): Accessor<T>;
  /** Sets the accessor to the weight, by default `d => d.weight`. */
  weight(weight: Accessor<T>): this;
}

/** A datum as the accessors expect it by default. */
interface Datum {
  x: number;
  y: number;
  weight: number;
}

/**
 * Returns a function for power diagrams, with the interface of `d3.weightedVoronoi`: synchronous, in the calling thread.
 * Sites may be equal, of which the heaviest has the cell, in a line, or outside the polygon.
 *
 * ```js
 * import { weightedVoronoi } from 'gdel-wasm/d3-weighted-voronoi';
 * await weightedVoronoi.load(); // once
 * const cells = weightedVoronoi().clip([[0, 0], [0, height], [width, height], [width, 0]])(data);
 * ```
 */
export function weightedVoronoi<T = Datum>(): WeightedVoronoi<T> {
  const clipping = new Clipping();
  let [x, y, weight] = (['x', 'y', 'weight'] as const).map(
    (name): Accessor<T> =>
      (datum) =>
        (datum as Datum)[name],
  ) as [Accessor<T>, Accessor<T>, Accessor<T>];

  const diagram = (data: readonly T[]): SitePolygon<T>[] => {
    const sites = data.map((originalObject) => ({
      x: Number(x(originalObject)),
      y: Number(y(originalObject)),
      weight: Number(weight(originalObject)),
      originalObject,
    }));
    const found = powerNow('powerCells', {
      points: Float64Array.from(sites.flatMap((site) => [site.x, site.y])),
      weights: Float64Array.from(sites, (site) => site.weight),
      corners: Float64Array.from(clipping.polygon.flat()),
    });
    return sites
      .map((site, i) => Object.assign(polygonOf(found, i), { site }))
      .filter((polygon) => polygon.length > 0);
  };
  const self = () => layout;
  const layout = Object.assign(diagram, clippedMethods(clipping, self), {
    x: property(
      () => x,
      (value) => {
        x = value;
      },
      self,
    ),
    y: property(
      () => y,
      (value) => {
        y = value;
      },
      self,
    ),
    weight: property(
      () => weight,
      (value) => {
        weight = value;
      },
      self,
    ),
  }) as WeightedVoronoi<T>;
  return layout;
}

/** Loads the WebAssembly module that diagrams need. Later calls do nothing. */
weightedVoronoi.load = (): Promise<void> => loadPower();
