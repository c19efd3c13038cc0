import { write2d } from './tools.js';
import type { Stats, TaskOptions } from './types.js';

/**
 * A 2D Delaunay triangulation, as plain arrays in the form of the npm package `delaunator`: what works on a `Delaunator`'s
 * `coords`, `triangles`, `halfedges` and `hull` works on this. All indices are those of the input points.
 *
 * Files have the triangles counter-clockwise where the y axis points up, as other programs do.
 */
export class Mesh2 {
  /** Three vertices a triangle, counter-clockwise where the y axis points down: det(b − a, c − a) < 0. Never flat. */
  readonly triangles: Uint32Array;
  /** Three a triangle: the half-edge that runs against the one from vertex *k* to the next, −1 on the hull. */
  readonly halfedges: Int32Array;
  /** The vertices of the convex hull, those in the middle of its edges included, in the triangles' sense. The distinct
   * points in order if all are collinear. */
  readonly hull: Uint32Array;
  /** One a point: −1, or the lowest index of a point with the same coordinates, which stands for this one. */
  readonly duplicateOf: Int32Array;
  /** 2; or 1, 0 where all points are collinear, equal: then there are no triangles. 0 for no points. */
  readonly dimension: 0 | 1 | 2;
  /** x, y, x, y, … as they were triangulated: a copy of the input, or its buffer if that was transferred. */
  readonly coords: Float32Array | Float64Array;
  /** What the run did. */
  readonly stats: Stats;

  /** @internal */
  constructor(arrays: Omit<Mesh2, `to${string}`>) {
    this.triangles = arrays.triangles;
    this.halfedges = arrays.halfedges;
    this.hull = arrays.hull;
    this.duplicateOf = arrays.duplicateOf;
    this.dimension = arrays.dimension;
    this.coords = arrays.coords;
    this.stats = arrays.stats;
  }

  /** VTK's XML unstructured grid (`.vtu`), which ParaView and PyVista read. */
  async toVTU(options: TaskOptions = {}): Promise<Uint8Array> {
    return (await this.#write('vtu', options)).vtu!;
  }

  /** Stanford PLY (`.ply`), binary. */
  async toPLY(options: TaskOptions = {}): Promise<Uint8Array> {
    return (await this.#write('ply', options)).ply!;
  }

  /** Wavefront OBJ (`.obj`). */
  async toOBJ(options: TaskOptions = {}): Promise<Uint8Array> {
    return (await this.#write('obj', options)).obj!;
  }

  /** STL (`.stl`): binary where single precision holds the coordinates, else text. */
  async toSTL(options: TaskOptions = {}): Promise<Uint8Array> {
    return (await this.#write('stl', options)).stl!;
  }

  /** Binary glTF 2.0 (`.glb`), whose numbers are single precision: relative to the node's translation where that would lose
   * something. Axes stay as they are, though glTF has y point up. */
  async toGLB(options: TaskOptions = {}): Promise<Uint8Array> {
    return (await this.#write('glb', options)).glb!;
  }

  /** The three files of the program Triangle: points, triangles and neighbours, counted from 0. */
  async toTriangle(
    options: TaskOptions = {},
  ): Promise<{ node: Uint8Array; ele: Uint8Array; neigh: Uint8Array }> {
    const { node, ele, neigh } = await this.#write('triangle', options);
    return { node: node!, ele: ele!, neigh: neigh! };
  }

  /** NumPy's `.npz` with the arrays `points`, `triangles` and `halfedges`. */
  async toNPZ(options: TaskOptions = {}): Promise<Uint8Array> {
    return (await this.#write('npz', options)).npz!;
  }

  #write(format: string, options: TaskOptions): Promise<Record<string, Uint8Array>> {
    const { triangles, halfedges } = this;
    return write2d(this.coords, { triangles, halfedges }, format, options);
  }
}
