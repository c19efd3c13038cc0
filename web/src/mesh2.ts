import type { Bytes, Coordinates, Indices, SignedIndices } from './arrays.js';
import type { Tasks } from './protocol.js';
import { write2d } from './tools.js';
import type { Place, Stats, TaskOptions } from './types.js';

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
  readonly triangles: Indices;
  /**
   * Three per triangle: the opposite of the half-edge from vertex *k* to the next one, or −1 on the
   * hull.
   */
  readonly halfedges: SignedIndices;
  /**
   * The vertices on the convex hull, including those in the middle of its edges, in the orientation
   * of the triangles. If all points are collinear: the distinct points, sorted.
   */
  readonly hull: Indices;
  /**
   * One per point: −1, or the lowest index of a point with the same coordinates, which represents
   * this one in the mesh.
   */
  readonly duplicateOf: SignedIndices;
  /**
   * The affine dimension of the points: 2, or 1 if they are collinear, or 0 if they are coincident
   * or there are none. Below 2 there are no triangles.
   */
  readonly dimension: 0 | 1 | 2;
  /** The coordinates x, y, x, y, …: a copy of the input, or its buffer if that was transferred. */
  readonly coords: Coordinates;
  /** Statistics of the run. */
  readonly stats: Stats;

  /** @internal */
  constructor(arrays: Tasks['delaunay2d']['result'], place: Place) {
    this.triangles = arrays.triangles;
    this.halfedges = arrays.halfedges;
    this.hull = arrays.hull;
    this.duplicateOf = arrays.duplicateOf;
    this.dimension = arrays.dimension;
    this.coords = arrays.points;
    this.stats = { ...arrays.stats, ...place };
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

  #write(format: string, options: TaskOptions | undefined): Promise<Record<string, Bytes>> {
    const { triangles, halfedges } = this;
    return write2d(this.coords, { triangles, halfedges }, format, options);
  }
}
