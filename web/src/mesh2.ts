import { codeEdit, moduleEdit } from '#assets';
import type {
  Contour2,
  ContourOptions,
  LocateOptions,
  RefineOptions,
  Surface2,
  SurfaceOptions,
  VoronoiOptions,
} from './answers.js';
import type { Bytes, Coordinates, Indices, SignedIndices } from './arrays.js';
import { Mesh } from './changing.js';
import type { Constrained } from './constrained.js';
import { contours, locate, type Source, surface, voronoi } from './derived.js';
import { thrown } from './errors.js';
import type { TriangleFormat } from './files.js';
import { bad, optionsOf, taskOptions } from './options.js';
import { findNearest, Rings } from './plane.js';
import type { Done } from './protocol.js';
import { loadCode } from './runtime.js';
import { runShared } from './shared.js';
import { weighted, write } from './tools.js';
import type { Points, TaskOptions } from './types.js';
import { Voronoi2 } from './voronoi2.js';
import { checkDelaunay, checkUnconstrained } from './weights.js';

/** Where points are in a 2D mesh. */
export interface Locations2 {
  /**
   * For each query the triangle that contains it, −1 outside the hull. If several do, it is the one
   * whose vertices come first when they are sorted.
   */
  triangles: SignedIndices;
  /**
   * For each query outside, a half-edge on the hull that sees the query; −1 inside, and everywhere
   * if the points are collinear.
   */
  halfedges: SignedIndices;
  /** How many queries are outside. */
  outside: number;
}

/**
 * A 2D Delaunay triangulation in the arrays of the npm package `delaunator`: code for a
 * `Delaunator`'s `coords`, `triangles`, `halfedges` and `hull` works with this, too. All vertices
 * are indices of the input points.
 *
 * In files the triangles are counter-clockwise if the y axis points up, as other programs expect. Files have the
 * triangles inside the boundaries.
 */
export class Mesh2 extends Mesh {
  /**
   * Three vertices per triangle, counter-clockwise if the y axis points down: det(b − a, c − a) <
   * 0. No triangle is flat.
   */
  declare readonly triangles: Indices;
  /**
   * Three per triangle: the opposite of the half-edge from vertex *k* to the next one, or −1 on the
   * hull.
   */
  declare readonly halfedges: SignedIndices;
  /**
   * The vertices on the convex hull, including those in the middle of its edges, in the orientation
   * of the triangles. If all points are collinear: the distinct points, sorted.
   */
  declare readonly hull: Indices;
  /**
   * One per point: −1, or the lowest index of a point with the same coordinates, which represents
   * this one in the mesh.
   */
  declare readonly duplicateOf: SignedIndices;
  /**
   * The affine dimension of the points: 2, or 1 if they are collinear, or 0 if they are coincident
   * or there are none. Below 2 there are no triangles.
   */
  declare readonly dimension: 0 | 1 | 2;
  /** The coordinates x, y, x, y, …: a copy of the input, or its buffer if that was transferred. */
  declare readonly coords: Coordinates;
  /**
   * What became of the options `edges`, `rings` and `polygons`; null without them. Interpolated values and cells do not cross
   * constrained edges, and they and contours end at boundaries. What only a Delaunay triangulation has fails with
   * `BAD_INPUT`: smooth interpolation, alpha shapes, surfaces, spanning trees, and changes.
   */
  declare readonly constraints: Constrained | null;
  /** The vertices around each vertex of these triangles. */
  #rings: [Indices, Rings] | undefined;

  /** @internal */
  _take({ result, place, weights = null }: Done<'delaunay2d'>): void {
    const { points: coords, stats, ...arrays } = result;
    const { hidden = new Uint32Array(0), constraints = null } = result;
    const extras = { weights, hidden, constraints };
    Object.assign(this, arrays, { coords, ...extras, stats: { ...stats, ...place } });
  }

  /**
   * Returns the triangle that contains each query point, exactly, and for queries outside the hull an
   * edge of it. What is outside by no more than rounding counts as inside: see {@link LocateOptions}.
   *
   * @throws {@link GdelError} `NOT_FINITE` with the `index` of a query, `BAD_INPUT`.
   */
  async locate(queries: Points, options?: LocateOptions): Promise<Locations2> {
    const { simplices, facets, outside } = await locate(this._source(), queries, options);
    return { triangles: simplices, halfedges: facets, outside };
  }

  /**
   * Returns for each level the contour lines of values that are linear within each triangle. Else as
   * {@link Mesh3.contours}.
   */
  async contours(
    values: ArrayLike<number>,
    levels: ArrayLike<number>,
    options?: ContourOptions,
  ): Promise<Contour2[]> {
    return contours(this._source(), values, levels, options);
  }

  /**
   * Returns the Voronoi diagram of the vertices, with weights their power diagram. The cells of
   * collinear points are segments of their line, unless they are clipped to a box that has an
   * inside.
   *
   * With constraints, it is the bounded diagram: cells end at boundaries, at the hull, and at constrained edges that block
   * the view of their vertex.
   */
  async voronoi(options?: VoronoiOptions): Promise<Voronoi2> {
    const arrays = await voronoi(this._source(), options);
    const find = (x: number, y: number, start: number) => this.find(x, y, start);
    return new Voronoi2(arrays, this.triangles.length / 3, this.duplicateOf, find);
  }

  /**
   * Returns the vertex that is nearest to the point (x, y), exactly, at once and in the calling
   * thread: of several at the same distance the one with the lowest index, −1 if there are no
   * points or a coordinate is not finite. Works for collinear points, too, but not with weights:
   * {@link nearest} does.
   *
   * @param start A point near it, where the search begins.
   */
  find(x: number, y: number, start = 0): number {
    checkDelaunay(this);
    const { length } = this.duplicateOf;
    if (!Number.isInteger(start) || start < 0 || (start > 0 && start >= length))
      throw bad('the start', 'the index of a point', start);
    if (this.hull.length === 0 || !Number.isFinite(x) || !Number.isFinite(y)) return -1;
    const first = this.duplicateOf[start]!;
    // One that was removed is nowhere.
    const vertex = first < 0 ? start : first === start ? this.hull[0]! : first;
    const [fx, fy] = this.factors ?? [1, 1];
    return findNearest(this, this.#ringsNow(), [x * fx!, y * fy!], vertex);
  }

  /** Returns the vertices of the triangles inside the boundaries, three each; without constraints, of all. */
  insideTriangles(): Indices {
    const { inside } = this.constraints ?? {};
    return inside ? this.triangles.filter((_, e) => inside[(e / 3) | 0]) : this.triangles;
  }

  /**
   * Returns a new mesh with points added on segments and inside, until the triangles inside have the shape and size that
   * are asked for, except where segments meet under small angles. Where the hull bounds what is inside, its edges
   * count as segments. `constraints.refinement` says what was done. The same input has the same result everywhere.
   *
   * ```js
   * const mesh = await delaunay2d([], { polygons });
   * const fine = await mesh.refine({ minAngle: 30, maxArea: 0.1 });
   * ```
   *
   * @throws {@link GdelError} `BAD_INPUT`, also without constraints; `ABORTED`.
   */
  async refine(options?: RefineOptions): Promise<Mesh2> {
    const task = taskOptions(optionsOf(options));
    const { placeOf, refineArgs, withConstraints } = await loadCode(codeEdit);
    const args = thrown(() => refineArgs(this, options));
    const result = withConstraints(await runShared(moduleEdit, 'refine', args, task));
    const place = placeOf(this.stats);
    // A class that names itself loses its name when it is bundled.
    const Same = this.constructor as typeof Mesh2;
    // The new mesh has constraints, too, and so is never updated.
    return new Same({ result, place }, async () => checkUnconstrained(this) as never);
  }

  /** Returns the points that point `i` has an edge to; none for a duplicate. */
  neighbors(i: number): number[] {
    if (!Number.isInteger(i) || i < 0 || i >= this.duplicateOf.length)
      throw bad('the point', 'the index of a point', i);
    return this.#ringsNow().of(i);
  }

  /**
   * Finds the closed curves that the points were taken from: polygons from unordered points. Else as
   * {@link Mesh3.surface}.
   */
  async surface(options?: SurfaceOptions): Promise<Surface2> {
    const { triangles, ...curves } = await surface(this._source(), options);
    return curves;
  }

  /**
   * Returns the triangles as VTK's XML unstructured grid (`.vtu`), which ParaView and PyVista read.
   * Weighted points have the data `weight` and `hidden`.
   */
  async toVTU(options?: TaskOptions): Promise<Bytes> {
    return (await this.#files('vtu', options)).vtu!;
  }

  /**
   * Returns the three files of the program Triangle: points, with weights if they have any,
   * triangles and neighbors, counted from 0.
   */
  async toTriangle(options?: TaskOptions): Promise<{ node: Bytes; ele: Bytes; neigh: Bytes }> {
    const { node, ele, neigh } = await this.#files('triangle', options);
    return { node: node!, ele: ele!, neigh: neigh! };
  }

  /**
   * Returns NumPy's `.npz` with the arrays `points`, `triangles` and `halfedges`, for weighted
   * points also `weight` and `hidden`.
   */
  async toNPZ(options?: TaskOptions): Promise<Bytes> {
    return (await this.#files('npz', options)).npz!;
  }

  /** @internal */
  _source(): Source {
    const { triangles, halfedges, duplicateOf, coords: points, factors } = this;
    const { weights, constraints } = this;
    const extras = { weights: weights ?? undefined, constraints: constraints ?? undefined };
    return {
      dimension: 2,
      points,
      factors,
      mesh: { triangles, halfedges, duplicateOf, ...extras },
    };
  }

  #ringsNow(): Rings {
    if (this.#rings?.[0] !== this.triangles) this.#rings = [this.triangles, new Rings(this)];
    return this.#rings[1];
  }

  /** @internal */
  async _write(format: TriangleFormat, options: TaskOptions | undefined): Promise<Bytes> {
    return (await this.#files(format, options))[format]!;
  }

  #files(format: string, options: TaskOptions | undefined): Promise<Record<string, Bytes>> {
    const { coords: points, triangles, halfedges, constraints } = this;
    const mesh = { triangles, halfedges, inside: constraints?.inside, ...weighted(this) };
    return write('write2d', { points, mesh, format }, options);
  }
}
