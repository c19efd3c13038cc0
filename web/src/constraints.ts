// Constraints in 2D: segments that are to be edges, and boundaries of what is inside.

import { type Coordinates, type Doubles, type Indices, kindOf } from './arrays.js';
import { GdelError } from './errors.js';
import { bad, checkOneOf, nameOf } from './options.js';
import type { ConstraintOptions } from './types.js';

/** Constraints as WebAssembly takes them: two indices per segment. */
export interface Segments {
  edges: Indices;
  boundary: Indices;
  /** x, y, x, y, … */
  holes: Doubles;
  fill: string;
  isSplit: boolean;
}

const FILLS = ['all', 'evenodd', 'nonzero', 'enclosed'];

/** Returns the points with those of polygons after them, and the segments. */
export function constraintsOf(
  options: ConstraintOptions,
  points: Coordinates,
): { points: Coordinates; segments: Segments } {
  const count = points.length / 2;
  const segments = segmentsOf(options, count);
  const { polygons } = options;
  if (!polygons) return { points, segments };
  const own = coordinatesOf(polygons);
  const sides = own.rings.flatMap((ring) => closed(ring.map((i) => count + i)));
  segments.boundary = Uint32Array.from([...segments.boundary, ...sides]);
  const all = new Float64Array(points.length + own.coordinates.length);
  all.set(points);
  all.set(own.coordinates, points.length);
  return { points: all, segments };
}

/** Returns the segments between so many points, without those of polygons. */
export function segmentsOf(options: ConstraintOptions, count: number): Segments {
  const { edges, rings, polygons, holes, fill, crossings = 'error' } = options;
  const hasBoundary = (rings ?? polygons ?? null) !== null;
  const rule = fill ?? (hasBoundary ? 'evenodd' : 'all');
  checkOneOf('the option fill', rule, FILLS);
  checkOneOf('the option crossings', crossings, ['error', 'split']);
  return {
    edges: Uint32Array.from(pairsOf(edges ?? [], count)),
    boundary: Uint32Array.from(sidesOf(rings ?? [], count)),
    holes: Float64Array.from(placesOf('the option holes', holes ?? [])),
    fill: rule,
    isSplit: crossings === 'split',
  };
}

function listOf(what: string, value: unknown, mustBe: string): ArrayLike<unknown> {
  if (!Array.isArray(value) && kindOf(value) === undefined) throw bad(what, mustBe, value);
  return value as ArrayLike<unknown>;
}

/** Returns the ends of edges, which are pairs of indices, or two indices each in one array. */
function pairsOf(edges: unknown, count: number): number[] {
  const mustBe = 'an array with two indices per edge';
  const list = Array.from(listOf('the option edges', edges, mustBe));
  if (typeof list[0] === 'number') {
    if (list.length % 2 !== 0)
      throw new GdelError('BAD_INPUT', `${list.length} indices are no edges, of two indices each`);
    return list.map((v, i) => indexOf(v, count, () => `edge ${i >> 1}`));
  }
  return list.flatMap((pair, i) => {
    const ends = Array.from(listOf(`edge ${i}`, pair, 'a pair of indices'));
    if (ends.length !== 2) throw bad(`edge ${i}`, 'a pair of indices', pair);
    return ends.map((v) => indexOf(v, count, () => `edge ${i}`));
  });
}

/** Returns the ends of the sides of rings. */
function sidesOf(rings: unknown, count: number): number[] {
  const mustBe = 'an array of rings';
  return Array.from(listOf('the option rings', rings, mustBe)).flatMap((ring, i) => {
    const vertices = Array.from(listOf(`ring ${i}`, ring, 'an array of indices'));
    return closed(vertices.map((v) => indexOf(v, count, () => `ring ${i}`)));
  });
}

function indexOf(value: unknown, count: number, where: () => string): number {
  if (!Number.isInteger(value) || (value as number) < 0 || (value as number) >= count)
    throw new GdelError(
      'BAD_INPUT',
      `${where()} has ${nameOf(value)}, which is not the index of one of the ${count} points`,
    );
  return value as number;
}

/** Returns the ends of the sides of a ring, whose last vertex may be the first one. */
function closed(ring: number[]): number[] {
  const { length } = ring;
  const vertices = length > 1 && ring[0] === ring[length - 1] ? ring.slice(1) : ring;
  const sides: number[] = [];
  vertices.forEach((v, i) => {
    sides.push(v, vertices[i + 1 === vertices.length ? 0 : i + 1]!);
  });
  return sides;
}

/** Returns the coordinates of polygons, and rings of their indices. */
function coordinatesOf(polygons: unknown): { coordinates: number[]; rings: number[][] } {
  const coordinates: number[] = [];
  const rings: number[][] = [];
  const mustBe = 'an array of polygons, which are arrays of rings of positions';
  Array.from(listOf('the option polygons', polygons, mustBe)).forEach((polygon, p) => {
    Array.from(listOf(`polygon ${p}`, polygon, 'an array of rings')).forEach((ring, r) => {
      const places = placesOf(`ring ${r} of polygon ${p}`, ring);
      const { length } = places;
      if (length > 2 && places[0] === places[length - 2] && places[1] === places[length - 1])
        places.splice(length - 2);
      const start = coordinates.length / 2;
      rings.push(Array.from({ length: places.length / 2 }, (_, i) => start + i));
      for (const x of places) coordinates.push(x);
    });
  });
  return { coordinates, rings };
}

/** Returns the first two coordinates of positions. */
function placesOf(where: string, positions: unknown): number[] {
  const list = Array.from(listOf(where, positions, 'an array of positions'));
  return list.flatMap((position, i) => {
    const what = `position ${i} in ${where}`;
    const [x, y] = Array.from(listOf(what, position, 'an array of numbers'));
    if (typeof x !== 'number' || typeof y !== 'number')
      throw bad(what, 'two numbers or more', position);
    return [x, y];
  });
}
