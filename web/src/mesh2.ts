import type { Bytes, Coordinates, Doubles, Indices, SignedIndices } from './arrays.js';
import {
  type AlphaOptions,
  type AlphaShape,
  alphaShape,
  type Geometry,
  geometry,
  type InterpolateOptions,
  interpolate,
  locate,
  type NearestOptions,
  nearest,
  type Source,
  type SpanningTree,
  spanningTree,
  type Topology,
  topology,
  type VoronoiOptions,
  voronoi,
} from './derived.js';
import type { Done } from './host.js';
import { bad, optionsOf } from './options.js';
import { findNearest, Rings, stripes } from './plane.js';
import type { Update } from './run.js';
import { write2d } from './tools.js';
import type { AccessorOptions, Points, Stats, TaskOptions, UpdateOptions } from './types.js';
import { Updating } from './updating.js';
import { Voronoi2 } from './voronoi2.js';

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
}

/**
 * A 2D Delaunay triangulation in the arrays of the npm package `delaunator`: code for a
 * `Delaunator`'s `coords`, `triangles`, `halfedges` and `hull` works with this, too. All vertices
 * are indices of the input points.
 *
 * In files the triangles are counter-clockwise if the y axis points up, as other programs expect.
 */
export class Mesh2 {
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
  /** Statistics of the run. */
  declare readonly stats: Stats;
  #rings: Rings | undefined;
  readonly #update: Update<'delaunay2d'>;
  readonly #updating = new Updating();

  /** @internal */
  constructor(done: Done<'delaunay2d'>, update: Update<'delaunay2d'>) {
    this.#update = update;
    this.#take(done);
  }

  /** Takes over what a run has made. */
  #take({ result, place }: Done<'delaunay2d'>): void {
    const { points: coords, stats, ...arrays } = result;
    Object.assign(this, arrays, { coords, stats: { ...stats, ...place } });
    this.#rings = undefined;
  }

  /**
   * Moves the points of the mesh: it becomes the mesh of as many other points, the same as a run from
   * scratch makes of them, except for the order of its triangles. See {@link Mesh3.update}.
   *
   * @throws {@link GdelError} `BAD_INPUT` for another number of points, or if the mesh is being
   * updated; and what `delaunay2d` is rejected with.
   */
  update(points: Points, options?: UpdateOptions): Promise<void>;
  update<T>(
    points: ArrayLike<T>,
    options: UpdateOptions & Pick<AccessorOptions<T>, 'point'>,
  ): Promise<void>;
  update(points: unknown, options?: UpdateOptions): Promise<void> {
    return this.#updating.run(async () => {
      const { hull, dimension } = this;
      const moved = { ...this.#source().mesh, hull, dimension };
      this.#take(await this.#update(points, options, moved, this.stats));
    });
  }

  /**
   * Returns the triangle that contains each query point, exactly, and for queries outside the hull a
   * facet of it.
   *
   * @throws {@link GdelError} `NOT_FINITE` with the `index` of a query, `BAD_INPUT`.
   */
  async locate(queries: Points, options?: TaskOptions): Promise<Locations2> {
    const { simplices, facets } = await locate(this.#source(), queries, options);
    return { triangles: simplices, halfedges: facets };
  }

  /**
   * Returns the vertex that is nearest to each query point, exactly: of several at the same distance
   * the one with the lowest index; −1 if the mesh has no triangles. With `k`, the `k` nearest ones, nearest
   * first, and −1 where there are not so many.
   */
  async nearest(queries: Points, options?: NearestOptions): Promise<SignedIndices> {
    return nearest(this.#source(), queries, options);
  }

  /**
   * Returns the interpolated value at each query point, NaN outside the hull.
   *
   * @param values One number per point of the mesh; those of duplicates are not used.
   */
  async interpolate(
    values: ArrayLike<number>,
    queries: Points,
    options?: InterpolateOptions,
  ): Promise<Doubles> {
    return interpolate(this.#source(), values, queries, options);
  }

  /**
   * Returns the Voronoi diagram of the vertices. Collinear points have cells if these are clipped to
   * a box that is given.
   */
  async voronoi(options?: VoronoiOptions): Promise<Voronoi2> {
    let arrays = await voronoi(this.#source(), options);
    const { clip } = optionsOf(options);
    if (this.triangles.length === 0 && clip !== undefined && typeof clip !== 'string')
      arrays = stripes(this, [clip[0]!, clip[1]!, clip[2]!, clip[3]!]);
    const find = (x: number, y: number, start: number) => this.find(x, y, start);
    return new Voronoi2(arrays, this.triangles.length / 3, this.duplicateOf, find);
  }

  /**
   * Returns the alpha shape for a radius: the triangles whose circumcircles have this radius or less,
   * and their boundary.
   */
  async alphaShape(options?: AlphaOptions): Promise<AlphaShape> {
    return alphaShape(this.#source(), options);
  }

  /** Returns the edges, the neighbours of each vertex and a triangle of each. */
  async topology(options?: TaskOptions): Promise<Topology> {
    return topology(this.#source(), options);
  }

  /** Returns circumcentres, radii, areas, quality and angles of the triangles. */
  async geometry(options?: TaskOptions): Promise<Geometry> {
    return geometry(this.#source(), options);
  }

  /** Returns the Euclidean minimum spanning tree of the vertices, with single-linkage clusters. */
  async spanningTree(options?: TaskOptions): Promise<SpanningTree> {
    return spanningTree(this.#source(), options);
  }

  /**
   * Returns the vertex that is nearest to the point (x, y), exactly, at once and in the calling
   * thread: of several at the same distance the one with the lowest index, −1 if there are no points
   * or a coordinate is not finite. Works for collinear points, too.
   *
   * @param start A point near it, where the search begins.
   */
  find(x: number, y: number, start = 0): number {
    const { length } = this.duplicateOf;
    if (!Number.isInteger(start) || start < 0 || (start > 0 && start >= length))
      throw bad('the start', 'the index of a point', start);
    if (length === 0 || !Number.isFinite(x) || !Number.isFinite(y)) return -1;
    const duplicateOf = this.duplicateOf[start]!;
    const vertex = duplicateOf < 0 ? start : duplicateOf;
    return findNearest(this, (this.#rings ??= new Rings(this)), [x, y], vertex);
  }

  /** Returns the points that point `i` has an edge to; none for a duplicate. */
  neighbors(i: number): number[] {
    if (!Number.isInteger(i) || i < 0 || i >= this.duplicateOf.length)
      throw bad('the point', 'the index of a point', i);
    return (this.#rings ??= new Rings(this)).of(i);
  }

  /**
   * Returns the triangles as VTK's XML unstructured grid (`.vtu`), which ParaView and PyVista read.
   */
  async toVTU(options?: TaskOptions): Promise<Bytes> {
    return (await this.#write('vtu', options)).vtu!;
  }

  /** Returns the triangles as Stanford PLY (`.ply`), binary. */
  async toPLY(options?: TaskOptions): Promise<Bytes> {
    return (await this.#write('ply', options)).ply!;
  }

  /** Returns the triangles as Wavefront OBJ (`.obj`). */
  async toOBJ(options?: TaskOptions): Promise<Bytes> {
    return (await this.#write('obj', options)).obj!;
  }

  /**
   * Returns the triangles as STL (`.stl`): binary if the coordinates fit single precision,
   * otherwise text.
   */
  async toSTL(options?: TaskOptions): Promise<Bytes> {
    return (await this.#write('stl', options)).stl!;
  }

  /**
   * Returns the triangles as binary glTF 2.0 (`.glb`), which has single precision. If that would
   * lose something, coordinates are relative to the node's translation. Axes stay as they are,
   * though glTF has *y* up.
   */
  async toGLB(options?: TaskOptions): Promise<Bytes> {
    return (await this.#write('glb', options)).glb!;
  }

  /**
   * Returns the three files of the program Triangle: points, triangles and neighbors, counted from
   * 0.
   */
  async toTriangle(options?: TaskOptions): Promise<{ node: Bytes; ele: Bytes; neigh: Bytes }> {
    const { node, ele, neigh } = await this.#write('triangle', options);
    return { node: node!, ele: ele!, neigh: neigh! };
  }

  /** Returns NumPy's `.npz` with the arrays `points`, `triangles` and `halfedges`. */
  async toNPZ(options?: TaskOptions): Promise<Bytes> {
    return (await this.#write('npz', options)).npz!;
  }

  /** Returns what everything is derived from. */
  #source(): Source {
    const { triangles, halfedges, duplicateOf, coords: points } = this;
    return { dimension: 2, points, mesh: { triangles, halfedges, duplicateOf } };
  }

  #write(format: string, options: TaskOptions | undefined): Promise<Record<string, Bytes>> {
    const { triangles, halfedges } = this;
    return write2d(this.coords, { triangles, halfedges }, format, options);
  }
}
