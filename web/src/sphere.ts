// Points on a sphere, by longitude and latitude in degrees. Their triangulation is the hull of a 3D mesh.

import { moduleDerived } from '#assets';
import type {
  Interpolated,
  LocationsOnSphere,
  SphereArrays,
  SphereEdges,
  SphereVoronoiArrays,
} from './answers.js';
import type { Doubles, SignedIndices } from './arrays.js';
import { numbersOf } from './derived.js';
import { bad, checkArrays, checkFunction, optionsOf, taskOptions } from './options.js';
import { findNearest, Rings } from './plane.js';
import { copyOf } from './points.js';
import type { SphereArgs, TaskName, Tasks } from './protocol.js';
import { IN_3D, sharedMaker, triangulate } from './run.js';
import { runShared } from './shared.js';
import type { AccessorOptions, Points, RunOptions, Stats, TaskOptions } from './types.js';
import type { Polygon } from './voronoi2.js';

/** Options of `delaunaySphere`. */
export interface SphereOptions extends TaskOptions, Pick<RunOptions, 'backend'> {}

export interface SphereMesh extends SphereArrays {}
/**
 * The Delaunay triangulation of points on a sphere: no point is inside the circumcircle of a triangle. All
 * places, of points and queries, are longitudes and latitudes in degrees.
 */
// biome-ignore lint/suspicious/noUnsafeDeclarationMerging: the constructor assigns what the interface has.
export class SphereMesh {
  /** The coordinates x, y, z, … of the points on the unit sphere. */
  readonly points: Doubles;
  /** Statistics of the run that triangulated the points. */
  readonly stats: Stats;
  #rings: Rings | undefined;

  /** @internal */
  constructor(points: Doubles, arrays: SphereArrays, stats: Stats) {
    this.points = points;
    this.stats = stats;
    Object.assign(this, arrays);
  }

  /**
   * Returns the point that is nearest to each query, of several the one with the lowest index; −1 if there
   * are no points.
   *
   * @throws {@link GdelError} `NOT_FINITE` with the `index` of a query, `BAD_INPUT`.
   */
  async nearest(queries: Points, options?: TaskOptions): Promise<SignedIndices> {
    return this.#ask('sphereNearest', { queries }, options);
  }

  /**
   * Returns the triangle that contains each query. Those outside the spherical convex hull, by more than
   * coordinates are rounded, have none.
   *
   * @throws {@link GdelError} as {@link nearest}.
   */
  async locate(queries: Points, options?: TaskOptions): Promise<LocationsOnSphere> {
    return this.#ask('sphereLocate', { queries }, options);
  }

  /**
   * Returns the interpolated value at each query: linear in the plane of the triangle that contains it, seen
   * from the centre; NaN where none does.
   *
   * @param values One number per point.
   * @throws {@link GdelError} as {@link nearest}.
   */
  async interpolate(
    values: ArrayLike<number>,
    queries: Points,
    options?: TaskOptions,
  ): Promise<Interpolated> {
    const count = this.duplicateOf.length;
    const numbers = numbersOf('the values', values, count, 'one per point');
    return this.#ask('sphereInterpolate', { queries, values: numbers }, options);
  }

  /** Returns the Voronoi cells. */
  async voronoi(options?: TaskOptions): Promise<SphereVoronoi> {
    return new SphereVoronoi(await this.#ask('sphereVoronoi', {}, options));
  }

  /**
   * Returns the point that is nearest to a place, at once and in the calling thread: of several at the same
   * distance the one with the lowest index, −1 if there are no points or a coordinate is not finite.
   *
   * @param start A point near it, where the search begins.
   */
  find(longitude: number, latitude: number, start = 0): number {
    const { triangles, halfedges, duplicateOf, points: coords } = this;
    const { length } = duplicateOf;
    if (!Number.isInteger(start) || start < 0 || (start > 0 && start >= length))
      throw bad('the start', 'the index of a point', start);
    if (length === 0 || !Number.isFinite(longitude) || !Number.isFinite(latitude)) return -1;
    if (!this.#rings) {
      // Only one or two vertices without triangles.
      const hull = triangles.length > 0 ? [] : this.#vertices();
      this.#rings = new Rings({ triangles, halfedges, hull, duplicateOf });
    }
    const first = duplicateOf[start]!;
    const query = onSphere(longitude, latitude);
    return findNearest({ coords }, this.#rings, query, first < 0 ? start : first);
  }

  /** Returns the edges, their lengths, and which of them are in the Urquhart graph. */
  edges(): SphereEdges {
    const { triangles, halfedges, outer } = this;
    const ends = (e: number) => [triangles[e]!, triangles[e % 3 === 2 ? e - 2 : e + 1]!];
    const longest = new Uint8Array(triangles.length);
    for (let e = 0; e < triangles.length; e += 3) {
      if (outer[e / 3]) continue;
      // Of edges of the same length, the first by its points.
      const [first] = [e, e + 1, e + 2]
        .map((e) => ({ e, squared: this.#squared(ends(e)), ends: ends(e).sort((v, w) => v - w) }))
        .sort(
          (a, b) => b.squared - a.squared || a.ends[0]! - b.ends[0]! || a.ends[1]! - b.ends[1]!,
        );
      longest[first!.e] = longest[halfedges[first!.e]!] = 1;
    }
    const found: number[][] = [];
    const urquhart: number[] = [];
    for (let e = 0; e < triangles.length; e++) {
      const opposite = halfedges[e]!;
      const isInside = !outer[Math.floor(e / 3)] || !outer[Math.floor(opposite / 3)];
      if (e > opposite || !isInside) continue;
      found.push(ends(e).sort((v, w) => v - w));
      urquhart.push(1 - longest[e]!);
    }
    const vertices = triangles.length > 0 ? [] : this.#vertices();
    if (vertices.length === 2) {
      found.push(vertices);
      urquhart.push(1);
    }
    // The chord and what is left of the diameter.
    const angle = (edge: number[]) => {
      const squared = this.#squared(edge);
      return 2 * Math.atan2(Math.sqrt(squared), Math.sqrt(Math.max(0, 4 - squared)));
    };
    return {
      edges: Uint32Array.from(found.flat()),
      lengths: Float64Array.from(found, angle),
      urquhart: Uint8Array.from(urquhart),
    };
  }

  /** Returns the squared length of the chord between two points. */
  #squared([v, w]: number[]): number {
    let squared = 0;
    for (let axis = 0; axis < 3; axis++)
      squared += (this.points[3 * v! + axis]! - this.points[3 * w! + axis]!) ** 2;
    return squared;
  }

  /** Returns the points that are not duplicates of others. */
  #vertices(): number[] {
    return [...this.duplicateOf.keys()].filter((i) => this.duplicateOf[i] === -1);
  }

  async #ask<T extends TaskName & `sphere${string}`>(
    task: T,
    { queries, ...args }: { queries?: Points; values?: Doubles },
    options: TaskOptions | undefined,
  ): Promise<Tasks[T]['result']> {
    const checked = taskOptions(optionsOf(options));
    const { points, triangles, duplicateOf } = this;
    const own: SphereArgs = { points, triangles, duplicateOf };
    checkArrays(own);
    const copy = queries === undefined ? {} : { queries: await copyOf(queries, 2, checked) };
    const all = { ...own, ...args, ...copy } as Tasks[T]['args'];
    return runShared(moduleDerived, task, all, checked);
  }
}

export interface SphereVoronoi extends SphereVoronoiArrays {}
/** The Voronoi cells of points on a sphere, as arrays and as polygons. */
// biome-ignore lint/suspicious/noUnsafeDeclarationMerging: the constructor assigns what the interface has.
export class SphereVoronoi {
  /** @internal */
  constructor(arrays: SphereVoronoiArrays) {
    Object.assign(this, arrays);
  }

  /**
   * Returns the cell of point `i` as a closed ring of longitudes and latitudes, counter-clockwise as seen from
   * outside, with great circles as edges. Null for a duplicate, and for a single point, whose cell is the
   * whole sphere.
   */
  cellPolygon(i: number): Polygon | null {
    const count = this.areas.length;
    if (!Number.isInteger(i) || i < 0 || i >= count)
      throw bad('the point', `an index below ${count}`, i);
    const corners = this.corners.subarray(this.cells[i]!, this.cells[i + 1]!);
    if (corners.length === 0) return null;
    return [...corners, corners[0]!].map((v) => [this.vertices[2 * v]!, this.vertices[2 * v + 1]!]);
  }

  /** Returns the polygons of all cells that have one, each with its point in the property `index`. */
  *cellPolygons(): Generator<Polygon & { index: number }> {
    for (let i = 0; i < this.areas.length; i++) {
      const polygon = this.cellPolygon(i);
      if (polygon) yield Object.assign(polygon, { index: i });
    }
  }
}

/**
 * Returns the Delaunay triangulation of points on a sphere, given by longitude and latitude in degrees: λ, φ, λ,
 * φ, … or one row per point. Longitudes may be any; equal places are equal points. It is that of the points'
 * coordinates on the unit sphere, which are rounded, exactly.
 *
 * ```ts
 * const sphere = await delaunaySphere([[0, 0], [90, 0], [180, 0], [-90, 0], [0, 90], [0, -90]]);
 * const { areas } = await sphere.voronoi(); // six times 4π / 6
 * sphere.find(80, 10); // 1
 * ```
 *
 * @throws {@link GdelError}, as a rejected promise.
 */
export function delaunaySphere(lonLat: Points, options?: SphereOptions): Promise<SphereMesh>;
/** Returns the same for items of any kind: the option `point` returns the longitude and the latitude of one. */
export function delaunaySphere<T>(
  lonLat: ArrayLike<T>,
  options: SphereOptions & Pick<AccessorOptions<T>, 'point'>,
): Promise<SphereMesh>;
export async function delaunaySphere(
  lonLat: Points | ArrayLike<unknown>,
  options?: SphereOptions & Partial<Pick<AccessorOptions<unknown>, 'point'>>,
): Promise<SphereMesh> {
  const { backend, point } = optionsOf(options);
  checkFunction('point', point);
  const { signal, onProgress } = taskOptions(optionsOf(options));
  /** The options of a part of the work. */
  const part = (from: number, to: number): TaskOptions => ({
    signal,
    onProgress:
      onProgress &&
      (({ phase, fraction }) => onProgress({ phase, fraction: from + (to - from) * fraction })),
  });
  const places = await copyOf(lonLat, 2, { signal, point });
  const given = await runShared(moduleDerived, 'onSphere', { places }, { signal });
  const run = { ...part(0, 0.8), backend, transfer: true };
  const { result, place } = await triangulate(sharedMaker('auto'), IN_3D, given, run, [
    'hull',
    'duplicateOf',
  ]);
  const { hull: triangles, duplicateOf } = result;
  const points = result.points as Doubles;
  const args = { points, triangles, duplicateOf };
  const arrays = await runShared(moduleDerived, 'sphere', args, part(0.8, 1));
  return new SphereMesh(points, arrays, { ...result.stats, ...place });
}

/** Returns the point of the unit sphere at a place. */
function onSphere(longitude: number, latitude: number): number[] {
  const [sin, cos] = sinCos(longitude);
  const [z, radius] = sinCos(latitude);
  return [radius * cos, radius * sin, z];
}

/** Returns the sine and the cosine of an angle in degrees; exactly for multiples of 90°. */
function sinCos(degrees: number): readonly [number, number] {
  const within = degrees % 360;
  const quarter = Math.round(within / 90);
  const rest = ((within - 90 * quarter) * Math.PI) / 180;
  const [sin, cos] = [Math.sin(rest), Math.cos(rest)];
  return (
    [
      [sin, cos],
      [cos, -sin],
      [-sin, -cos],
      [-cos, sin],
    ] as const
  )[quarter & 3]!;
}
