// What meshes of both dimensions have in common: they change with their points, and answer questions.

import { codeEdit, moduleEdit } from '#assets';
import type {
  AlphaOptions,
  AlphaShape,
  BallComplex,
  BallOptions,
  Geometry,
  GridOptions,
  Interpolated,
  InterpolateOptions,
  InterpolationWeights,
  NearestOptions,
  Topology,
  Transport,
  TransportOptions,
} from './answers.js';
import type { Doubles, Indices, SignedIndices } from './arrays.js';
import {
  alphaShape,
  ballComplex,
  geometry,
  gradients,
  interpolate,
  interpolateGrid,
  interpolationWeights,
  nearest,
  type Source,
  type SpanningTree,
  spanningTree,
  topology,
  transport,
} from './derived.js';
import { thrown } from './errors.js';
import { Triangles } from './files.js';
import { bad, optionsOf, taskOptions } from './options.js';
import { copyOf } from './points.js';
import type { Done, Edit, Task } from './protocol.js';
import type { Update } from './run.js';
import { loadCode } from './runtime.js';
import { runShared } from './shared.js';
import type {
  AccessorOptions,
  MoveOptions,
  Points,
  Stats,
  TaskOptions,
  UpdateOptions,
} from './types.js';
import { Updating } from './updating.js';
import { checkDelaunay } from './weights.js';

/** A mesh in typed arrays, of either dimension. */
export abstract class Mesh extends Triangles {
  /** Statistics of the run. */
  declare readonly stats: Stats;
  declare readonly hull: Indices;
  declare readonly dimension: number;
  /**
   * The points that are no vertices because of their weights, in ascending order; empty without the options
   * `weights` and `radii`.
   */
  declare readonly hidden: Indices;
  /**
   * The weights of the points, or null if the mesh is a Delaunay triangulation, which it is without
   * weights, and if all are equal. `locate`, `nearest`, `voronoi`, `ballComplex`, `topology` and `geometry`
   * take both; what else is derived from meshes, and their changes, fail with `BAD_INPUT` with weights.
   */
  declare readonly weights: Doubles | null;
  /** By which the coordinates were multiplied, one per axis; null without the option `rescale`. */
  readonly factors: readonly number[] | null;
  readonly #update: Update<Task>;
  readonly #updating = new Updating();

  /** @internal */
  constructor(done: Done<Task>, update: Update<Task>) {
    super();
    this.#update = update;
    this.factors = update.factors ?? null;
    this._take(done);
  }

  /**
   * Takes over what a run has made.
   *
   * @internal
   */
  abstract _take(done: Done<Task>): void;

  /**
   * Returns what everything is derived from.
   *
   * @internal
   */
  abstract _source(): Source;

  /**
   * Has the mesh replaced. `edit` says what is removed; without it, the points have moved. Returns the
   * indices of new points; or, of those that are left where some were dropped, what they were.
   */
  #change(
    points: unknown,
    options: UpdateOptions | undefined,
    edit?: Omit<Edit, 'before'>,
  ): Promise<Indices> {
    return this.#updating.run(async () => {
      checkDelaunay(this);
      const { points: before, mesh } = this._source();
      const { hull, dimension, stats } = this;
      const moved = { ...mesh, hull, dimension };
      const done = await this.#update(points, options, moved, stats, edit && { ...edit, before });
      const { kept, ...result } = done.result as typeof done.result & { kept?: Indices };
      this._take({ ...done, result } as Done<Task>);
      const first = mesh.duplicateOf.length;
      const length = this._source().mesh.duplicateOf.length - first;
      return kept ?? Uint32Array.from({ length }, (_, i) => first + i);
    });
  }

  /**
   * Makes the mesh the regular triangulation of its points for other weights, or for its first ones. So far that
   * takes as long as a run from scratch. Points that the old weights hid come back. When the promise is
   * fulfilled, the arrays of the mesh are new; until then, and if it is rejected, the mesh is what it was.
   *
   * @throws {@link GdelError} `BAD_INPUT` for another number of weights, if one is not finite, if the mesh has
   * constraints, if points were removed from it or rescaled, or if it is being changed; `ABORTED`.
   */
  async updateWeights(weights: ArrayLike<number>, options?: TaskOptions): Promise<void> {
    await this.#weigh({ ...optionsOf(options), weights: weights ?? [] }, this._source().points);
  }

  /** Triangulates as many points as the mesh has from scratch, with weights. */
  async #weigh(options: MoveOptions, points: unknown): Promise<void> {
    await this.#updating.run(async () => {
      const source = this._source();
      const { regularArgs, madeOf } = await loadCode(codeEdit);
      const own = await copyOf(points as Points, source.dimension, options);
      const args = thrown(() => regularArgs(source, options, own));
      const result = await runShared(moduleEdit, 'regular', args, taskOptions(options));
      this._take(madeOf(result, args, this.stats) as Done<Task>);
    });
  }

  /**
   * Moves the points of the mesh: it becomes the mesh of as many other points, the same as a run from
   * scratch makes of them, except for the order of its simplices. A mesh of the GPU that has changed
   * little is repaired, which is faster; {@link UpdateStats}, in `stats.update`, say what was done.
   *
   * What triangulated the points does it: its backend, and its worker. The arrays of the mesh are
   * replaced by new ones when the promise is fulfilled. Until then, and if it is rejected, the mesh is
   * what it was.
   *
   * Points with weights keep them, or get those of the options `weights` or `radii`; that takes as long as a run
   * from scratch, and the CPU does it.
   *
   * @throws {@link GdelError} `BAD_INPUT` for another number of points or weights, if the mesh is being changed,
   * or if `outputs` lacked `'neighbors'` or `'duplicateOf'`; and what a run is rejected with.
   */
  update(points: Points, options?: MoveOptions): Promise<void>;
  update<P>(
    points: ArrayLike<P>,
    options: MoveOptions & Pick<AccessorOptions<P>, 'point'>,
  ): Promise<void>;
  async update(points: unknown, options?: MoveOptions): Promise<void> {
    const given = optionsOf(options);
    if (given.weights ?? given.radii ?? this.weights) await this.#weigh(given, points);
    else await this.#change(points, options);
  }

  /**
   * Inserts points into the mesh, after those that it has, and returns their indices. It becomes the same
   * as a run from scratch makes of all, except for the order of its simplices: also if new points lie
   * outside the hull, equal others, or are the first that are not flat. A few points take little more
   * than copies of the arrays. The CPU does it; else as for {@link update}.
   *
   * @throws {@link GdelError} as {@link update}; the `index` in `NOT_FINITE` is among the new points.
   */
  insert(points: Points, options?: UpdateOptions): Promise<Indices>;
  insert<P>(
    points: ArrayLike<P>,
    options: UpdateOptions & Pick<AccessorOptions<P>, 'point'>,
  ): Promise<Indices>;
  async insert(points: unknown, options?: UpdateOptions): Promise<Indices> {
    return this.#change(points, options, { removed: new Float64Array(0) });
  }

  /**
   * Removes the points with these indices. The mesh becomes that of the others, which keep their
   * indices; if a removed point stood for others, the lowest of these takes its place. The removed ones
   * are *unused*: in `duplicateOf` they are their own duplicates. Later changes leave them so, until
   * {@link compact} drops them. The CPU does it; else as for {@link update}.
   *
   * @throws {@link GdelError} as {@link update}; `BAD_INPUT` for an index that is none, is given twice,
   * or was removed before.
   */
  async remove(indices: ArrayLike<number>, options?: TaskOptions): Promise<void> {
    if (!Array.isArray(indices) && !ArrayBuffer.isView(indices))
      throw bad('the indices', 'an array', indices);
    const removed = Float64Array.from(indices, (i) => (typeof i === 'number' ? i : Number.NaN));
    await this.#change([], options, { removed });
  }

  /**
   * Drops the points that were removed, so that the mesh numbers the others in their order. Returns
   * what their indices were, for values that belong to them.
   *
   * @throws {@link GdelError} as {@link update}.
   */
  async compact(options?: TaskOptions): Promise<Indices> {
    return this.#change([], options, {});
  }

  /**
   * Returns the vertex that is nearest to each query point, exactly: of several at the same distance
   * the one with the lowest index; −1 if there are no points. With `k`, the `k` nearest ones, nearest
   * first, and −1 where there are not so many. With weights, distances are power distances,
   * |x − p|² − *w*, and hidden points are never nearest.
   */
  async nearest(queries: Points, options?: NearestOptions): Promise<SignedIndices> {
    return nearest(this._source(), queries, options);
  }

  /**
   * Returns the interpolated value at each query point, and how many of these are outside the hull.
   *
   * @param values One number per point of the mesh; those of removed points are not used.
   * @throws {@link GdelError} `NOT_FINITE` with the `index` of a query, `BAD_INPUT`.
   */
  async interpolate(
    values: ArrayLike<number>,
    queries: Points,
    options?: InterpolateOptions,
  ): Promise<Interpolated> {
    return interpolate(this._source(), values, queries, options);
  }

  /**
   * Returns the interpolated value at the centre of each cell of a grid, such as the pixels of an image: row by row, with
   * *x* growing in a row, *y* from row to row, and in 3D *z* from layer to layer. Faster than
   * {@link interpolate}.
   *
   * @param values One number per point of the mesh; those of removed points are not used.
   * @throws {@link GdelError} `BAD_INPUT`.
   *
   * @example
   *
   * ```js
   * const { values: heights } = await mesh.interpolateGrid(z, { width: 500, height: 400 });
   * ```
   */
  async interpolateGrid(values: ArrayLike<number>, options: GridOptions): Promise<Interpolated> {
    return interpolateGrid(this._source(), values, options);
  }

  /**
   * Returns the weights with which values at the points are interpolated at each query point, for many
   * columns of values. Those of smooth methods depend on the values, so there are none.
   *
   * @throws {@link GdelError} `NOT_FINITE` with the `index` of a query, `BAD_INPUT`.
   */
  async interpolationWeights(
    queries: Points,
    options?: InterpolateOptions,
  ): Promise<InterpolationWeights> {
    return interpolationWeights(this._source(), queries, options);
  }

  /**
   * Returns the gradient of values at each point, which smooth interpolation uses: 2 or 3 numbers per
   * point, 0 for duplicates. Along the edges, the cubics that they determine with the values are
   * the least curved on the whole.
   *
   * @param values One number per point of the mesh; those of removed points are not used.
   * @throws {@link GdelError} `BAD_INPUT`.
   */
  async gradients(values: ArrayLike<number>, options?: InterpolateOptions): Promise<Doubles> {
    return gradients(this._source(), values, options);
  }

  /**
   * Returns the alpha shape for a radius: the simplices whose circumspheres have this radius or less,
   * and their boundary. For points with weights, there is {@link ballComplex}.
   */
  async alphaShape(options?: AlphaOptions): Promise<AlphaShape> {
    return alphaShape(this._source(), options);
  }

  /**
   * Returns the alpha complex of balls around the points, such as the atoms of a molecule (Edelsbrunner, *Weighted
   * alpha shapes*, 1992; *The union of balls and its dual shape*, 1995). A simplex of the mesh, or a face of one,
   * is part of it if the balls of its vertices meet where their cells in the power diagram do: an edge for two, a
   * triangle for three. So it has the components, the tunnels and the voids of the union of the balls.
   *
   * `alpha`² is added to the weights, which makes the balls larger; the complex for 0 is the *dual complex* of the
   * union. Without weights it is that of {@link alphaShape}, but for `alpha` as it is. What is part of it is exact,
   * also where balls touch. After `rescale`, lengths are those of the rescaled points.
   *
   * @example
   *
   * ```js
   * const mesh = await delaunay3d(centers, { radii });
   * const { components, edges, solid } = await mesh.ballComplex({ radii });
   * ```
   *
   * @throws {@link GdelError} `BAD_INPUT` for an option, if there is not one weight or radius per point, one is not
   * finite or a radius is negative, if the mesh has other weights or constraints, or if `outputs` lacked
   * `'neighbors'` or `'duplicateOf'`; `OUT_OF_MEMORY`, `ABORTED`.
   */
  async ballComplex(options?: BallOptions): Promise<BallComplex> {
    return ballComplex(this._source(), options);
  }

  /** Returns the edges, the facets, the neighbours of each vertex and a simplex of each. */
  async topology(options?: TaskOptions): Promise<Topology> {
    return topology(this._source(), options);
  }

  /** Returns circumcentres, radii, volumes or areas, quality and angles of the simplices. */
  async geometry(options?: TaskOptions): Promise<Geometry> {
    return geometry(this._source(), options);
  }

  /** Returns the Euclidean minimum spanning tree of the points, with single-linkage clusters. */
  async spanningTree(options?: TaskOptions): Promise<SpanningTree> {
    return spanningTree(this._source(), options);
  }

  /**
   * Finds the weights with which the cell of each point in the power diagram has a given volume, its mass, by
   * semi-discrete optimal transport. The points count, and not the weights of the mesh. Points may be outside
   * of what the cells are clipped to; equal points share a cell.
   *
   * @example
   *
   * ```js
   * const clip = [0, 0, 16, 9];
   * const { weights } = await mesh.transport({ masses: [3, 1, 4, 1, 5], normalize: true, clip });
   * await mesh.updateWeights(weights);
   * const treemap = await mesh.voronoi({ clip });
   * ```
   *
   * @throws {@link GdelError} `BAD_INPUT` for masses that are not positive or do not fit, or if rounding keeps
   * the cells from being as exact as the tolerance; `ABORTED`.
   */
  async transport(options?: TransportOptions): Promise<Transport> {
    return transport(this._source(), options);
  }
}
