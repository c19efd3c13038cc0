// What diagrams in the form of d3's are clipped to.

import { GdelError } from './index.js';
import { cornersOf, type Position } from './treemap.js';

/** Two corners: the lowest and the highest coordinates. */
export type Extent = [Position, Position];

/** Returns the area of a polygon as d3-polygon counts it: positive if it is counter-clockwise on a screen. */
export function areaOf(polygon: readonly Position[]): number {
  let sum = 0;
  polygon.forEach(([x, y], i) => {
    const [x1, y1] = polygon[(i + 1) % polygon.length]!;
    sum += y * x1 - x * y1;
  });
  return sum / 2;
}

/** Returns on which side of the line from a to b a point is: 1 left on a screen, −1 right, 0 on it up to rounding. */
export const sideOf = ([ax, ay]: Position, [bx, by]: Position, [x, y]: Position): number =>
  Math.sign((by - ay) * (x - ax) - (bx - ax) * (y - ay));

/** Returns the sides on which a polygon's corners turn. */
const turnsOf = (polygon: readonly Position[]): Set<number> =>
  new Set(
    polygon.map((corner, i) => {
      const [next, last] = [1, 2].map((more) => polygon[(i + more) % polygon.length]!);
      return sideOf(corner, next!, last!);
    }),
  );

/** Returns the convex hull of points, counter-clockwise on a screen (Andrew 1979). */
function hullOf(points: readonly Position[]): Position[] {
  const sorted = [...points].sort(([ax, ay], [bx, by]) => ax - bx || ay - by);
  const chain = (along: readonly Position[]) => {
    const hull: Position[] = [];
    for (const point of along) {
      while (hull.length > 1 && sideOf(hull.at(-2)!, hull.at(-1)!, point) <= 0) hull.pop();
      hull.push(point);
    }
    return hull.slice(0, -1);
  };
  return [...chain(sorted), ...chain(sorted.reverse())];
}

/** The polygon, and what d3 calls its extent and its size. */
export class Clipping {
  polygon: Position[] = [];
  extent: Extent = [
    [0, 0],
    [1, 1],
  ];

  constructor() {
    this.setSize([1, 1]);
  }

  /** Takes a polygon of either orientation, or the hull of one that is not convex. Does not change what it is given. */
  setPolygon(given: ArrayLike<ArrayLike<number>>): void {
    const flat = cornersOf(given);
    const corners: Position[] = [];
    for (let i = 0; i < flat.length; i += 2) corners.push([flat[i]!, flat[i + 1]!]);
    const turns = turnsOf(corners);
    const isConvex = !(turns.has(1) && turns.has(-1));
    const polygon = isConvex ? corners : hullOf(corners);
    if (areaOf(polygon) === 0) throw new GdelError('BAD_INPUT', 'the clip polygon has no inside');
    this.polygon = areaOf(polygon) < 0 ? polygon.reverse() : polygon;
    const range = (axis: 0 | 1, of: (...all: number[]) => number) =>
      of(...polygon.map((corner) => corner[axis]));
    this.extent = [
      [range(0, Math.min), range(1, Math.min)],
      [range(0, Math.max), range(1, Math.max)],
    ];
  }

  setExtent([[x0, y0], [x1, y1]]: Extent): void {
    this.setPolygon([
      [x0, y0],
      [x0, y1],
      [x1, y1],
      [x1, y0],
    ]);
  }

  setSize([width, height]: Position): void {
    this.setExtent([
      [0, 0],
      [width, height],
    ]);
  }

  get size(): Position {
    const [[x0, y0], [x1, y1]] = this.extent;
    return [x1 - x0, y1 - y0];
  }

  contains(point: Position): boolean {
    const { polygon } = this;
    return polygon.every(
      (corner, i) => sideOf(corner, polygon[(i + 1) % polygon.length]!, point) >= 0,
    );
  }
}

/** What layouts with a clip polygon have in common: getters without an argument, setters with one. */
export interface Clipped<This> {
  /** Returns the clip polygon, counter-clockwise on a screen. */
  clip(): Position[];
  /** Sets the clip polygon: of either orientation; of one that is not convex, its hull. */
  clip(polygon: ArrayLike<ArrayLike<number>>): This;
  /** Returns the lowest and the highest coordinates. */
  extent(): Extent;
  /** Sets the clip polygon to a rectangle with these corners. */
  extent(extent: Extent): This;
  /** Returns the width and the height. */
  size(): Position;
  /** Sets the clip polygon to a rectangle of this size with a corner at 0, 0. */
  size(size: Position): This;
}

/** Returns these methods. */
export function clippedMethods<This>(
  clipping: Clipping,
  self: () => This,
  changed: () => void = () => {},
): Clipped<This> {
  const method =
    (get: () => unknown, set: (value: never) => void) =>
    (...given: [never?]) => {
      if (given.length === 0) return get();
      set(given[0]!);
      changed();
      return self();
    };
  return {
    clip: method(
      () => clipping.polygon,
      (polygon) => clipping.setPolygon(polygon),
    ),
    extent: method(
      () => clipping.extent,
      (extent) => clipping.setExtent(extent),
    ),
    size: method(
      () => clipping.size,
      (size) => clipping.setSize(size),
    ),
  } as Clipped<This>;
}

/** Returns a method that is a getter without an argument and a setter with one. */
export function property<This, V>(
  get: () => V,
  set: (value: V) => void,
  self: () => This,
): { (): V; (value: V): This } {
  return ((...given: [V?]) => {
    if (given.length === 0) return get();
    set(given[0]!);
    return self();
  }) as { (): V; (value: V): This };
}
