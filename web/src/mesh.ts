import type {
  Contour3,
  ContourOptions,
  LocateOptions,
  SurfaceOptions,
  VoronoiArrays,
  VoronoiOptions,
} from './answers.js';
import type { Bytes, Coordinates, Indices, SignedIndices } from './arrays.js';
import { Mesh } from './changing.js';
import {
  alphaShape,
  contours,
  locate,
  type Source,
  Surface3,
  surface,
  voronoi,
} from './derived.js';
import { GdelError } from './errors.js';
import type { TriangleFormat } from './files.js';
import type { Done } from './protocol.js';
import type { Update } from './run.js';
import { weighted, write } from './tools.js';
import type { Output, Points, TaskOptions, Trace } from './types.js';

/** Where points are in a 3D mesh. */
export interface Locations3 {
  /**
   * For each query the tetrahedron that contains it, −1 outside the hull. If several do, it is the
   * one whose vertices come first when they are sorted.
   */
  tetrahedra: SignedIndices;
  /**
   * For each query outside, 4 × *tetrahedron* + *k*, where the facet opposite vertex *k* is on the
   * hull and sees the query; −1 inside, and everywhere if the points are flat.
   */
  facets: SignedIndices;
  /** How many queries are outside. */
  outside: number;
}

/**
 * A 3D Delaunay triangulation in typed arrays. All vertices are indices of the input points.
 */
export class Mesh3 extends Mesh {
  /**
   * Four vertices per tetrahedron, positively oriented: det(b − a, c − a, d − a) > 0. No
   * tetrahedron is flat.
   */
  declare readonly tetrahedra: Indices;
  /**
   * Four per tetrahedron: entry *k* is the tetrahedron across the facet opposite vertex *k*, or −1
   * on the hull.
   */
  declare readonly neighbors: SignedIndices;
  /**
   * Three vertices per triangle of the convex hull, counter-clockwise as seen from outside. Empty for points
   * in a plane: files have their polygon, triangulated, from both sides, and so has the `surface` of
   * {@link alphaShape} for `alpha: Infinity`.
   */
  declare readonly hull: Indices;
  /**
   * One per point: −1, or the lowest index of a point with the same coordinates, which represents
   * this one in the mesh.
   */
  declare readonly duplicateOf: SignedIndices;
  /**
   * The affine dimension of the points: 3, or 2, 1, 0 if they are coplanar, collinear, coincident;
   * 0 if there are none. Below 3 there are no tetrahedra.
   */
  declare readonly dimension: 0 | 1 | 2 | 3;
  /**
   * The coordinates x, y, z, x, y, z, …: a copy of the input, or its buffer if that was
   * transferred.
   */
  declare readonly points: Coordinates;
  /** The intermediate triangulations, if `outputs` has `'trace'` and the GPU computed the mesh. */
  declare readonly trace?: Trace;
  readonly #outputs: readonly Output[];
  /** @internal */
  constructor(done: Done<'delaunay3d'>, outputs: readonly Output[], update: Update<'delaunay3d'>) {
    super(done, update);
    this.#outputs = outputs;
  }

  /** @internal */
  _take({ result, place, weights = null }: Done<'delaunay3d'>): void {
    const hidden = result.hidden ?? new Uint32Array(0);
    Object.assign(this, { trace: undefined, weights }, result, {
      hidden,
      stats: { ...result.stats, ...place },
    });
  }

  /**
   * Returns the tetrahedron that contains each query point, exactly, and for queries outside the hull a
   * facet of it. What is outside by no more than rounding counts as inside: see {@link LocateOptions}.
   *
   * @throws {@link GdelError} `NOT_FINITE` with the `index` of a query, `BAD_INPUT`.
   */
  async locate(queries: Points, options?: LocateOptions): Promise<Locations3> {
    const { simplices, facets, outside } = await locate(this._source(), queries, options);
    return { tetrahedra: simplices, facets, outside };
  }

  /**
   * Returns for each level the isosurface of values that are linear within each tetrahedron.
   *
   * @param values One number per point of the mesh. Where one is not finite, the mesh has a hole.
   * @throws {@link GdelError} `BAD_INPUT`.
   */
  async contours(
    values: ArrayLike<number>,
    levels: ArrayLike<number>,
    options?: ContourOptions,
  ): Promise<Contour3[]> {
    return contours(this._source(), values, levels, options);
  }

  /**
   * Returns the Voronoi diagram of the vertices, with weights their power diagram. The cells of
   * coplanar points are polygons in their plane, with edges as facets, and those of collinear
   * points segments, with ends as facets, unless they are clipped to a box that has an inside.
   */
  async voronoi(options?: VoronoiOptions): Promise<VoronoiArrays> {
    return voronoi(this._source(), options);
  }

  /**
   * Finds the closed surface that the points were taken from, such as those of a scan, and the solid
   * that it encloses. Neither normals nor a radius are needed, but points that are dense compared with
   * the details. The result depends on the points and the options alone. Flat points, and fewer than
   * four, have an empty surface.
   *
   * @example
   *
   * ```js
   * const surface = await mesh.surface();
   * console.log(`${surface.volume} cubic units, genus ${surface.genus}`);
   * const file = await surface.to3MF(); // for a printer
   * ```
   *
   * @throws {@link GdelError} `BAD_INPUT` for an option, or if `outputs` lacked `'neighbors'` or
   * `'duplicateOf'`; `OUT_OF_MEMORY`, `ABORTED`.
   */
  async surface(options?: SurfaceOptions): Promise<Surface3> {
    return new Surface3(await surface(this._source(), options));
  }

  /**
   * Returns the tetrahedra as VTK's XML unstructured grid (`.vtu`), which ParaView and PyVista
   * read. Weighted points have the data `weight` and `hidden`.
   */
  async toVTU(options?: TaskOptions): Promise<Bytes> {
    return (await this.#files('vtu', [], options)).vtu!;
  }

  /**
   * Returns TetGen's three files: points, with weights if they have any, tetrahedra and neighbors,
   * counted from 0.
   */
  async toTetGen(options?: TaskOptions): Promise<{ node: Bytes; ele: Bytes; neigh: Bytes }> {
    const { node, ele, neigh } = await this.#files('tetgen', ['neighbors'], options);
    return { node: node!, ele: ele!, neigh: neigh! };
  }

  /**
   * Returns NumPy's `.npz` with the arrays `points`, `tetrahedra` and `neighbors`, for weighted
   * points also `weight` and `hidden`.
   */
  async toNPZ(options?: TaskOptions): Promise<Bytes> {
    return (await this.#files('npz', ['neighbors'], options)).npz!;
  }

  /** @internal */
  _source(): Source {
    this.#check(['neighbors', 'duplicateOf'], 'this needs');
    const { tetrahedra, neighbors, duplicateOf, points, factors } = this;
    const weights = this.weights ?? undefined;
    return { dimension: 3, points, factors, mesh: { tetrahedra, neighbors, duplicateOf, weights } };
  }

  /** @internal */
  async _write(format: TriangleFormat, options: TaskOptions | undefined): Promise<Bytes> {
    const isFlat = this.dimension === 2;
    const hull = isFlat ? await this.#polygon() : this.hull;
    return (await this.#files(format, ['hull'], options, hull))[format]!;
  }

  /** Returns the convex hull of points in a plane from both sides, which weights do not change. */
  async #polygon(): Promise<Indices> {
    const { mesh, ...source } = this._source();
    const plain = { ...source, mesh: { ...mesh, weights: undefined } };
    return (await alphaShape(plain, { alpha: Infinity })).surface;
  }

  /** Copies only what the format needs to the writer. */
  #files(
    format: string,
    needs: readonly Output[],
    options: TaskOptions | undefined,
    hull?: Indices,
  ): Promise<Record<string, Bytes>> {
    this.#check(needs, `${format} files need`);
    const mesh = {
      tetrahedra: hull ? new Uint32Array(0) : this.tetrahedra,
      hull,
      neighbors: needs.includes('neighbors') ? this.neighbors : undefined,
      ...(hull ? {} : weighted(this)),
    };
    return write('write', { points: this.points, mesh, format }, options);
  }

  /** Checks that the mesh has some arrays. */
  #check(needs: readonly Output[], who: string): void {
    const missing = needs.find((output) => !this.#outputs.includes(output));
    if (missing)
      throw new GdelError(
        'BAD_INPUT',
        `${who} '${missing}', which was not among the outputs of the run`,
      );
  }
}
