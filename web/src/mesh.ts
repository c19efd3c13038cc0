import { GdelError } from './errors.js';
import { write } from './tools.js';
import type { Output, Stats, TaskOptions, Trace } from './types.js';

/**
 * A 3D Delaunay triangulation, as plain arrays. All indices are those of the input points, which {@link points} has.
 */
export class Mesh3 {
  /** Four vertices a tetrahedron, positively oriented: det(b − a, c − a, d − a) > 0. Never flat. */
  readonly tetrahedra: Uint32Array;
  /** Four a tetrahedron: entry *k* is the tetrahedron across the facet opposite vertex *k*, −1 outside the hull. */
  readonly neighbors: Int32Array;
  /** Three vertices a triangle of the convex hull, counter-clockwise as seen from outside. */
  readonly hull: Uint32Array;
  /** One a point: −1, or the lowest index of a point with the same coordinates, which stands for this one. */
  readonly duplicateOf: Int32Array;
  /** 3; or 2, 1, 0 where all points are coplanar, collinear, equal: then there are no tetrahedra. 0 for no points. */
  readonly dimension: 0 | 1 | 2 | 3;
  /** x, y, z, x, y, z, … as they were triangulated: a copy of the input, or its buffer if that was transferred. */
  readonly points: Float32Array | Float64Array;
  /** What the run did. */
  readonly stats: Stats;
  /** How the mesh came about, where `outputs` asked for it and the GPU engine made it. */
  readonly trace?: Trace;
  readonly #outputs: readonly Output[];

  /** @internal */
  constructor(arrays: Omit<Mesh3, `to${string}`>, outputs: readonly Output[]) {
    this.tetrahedra = arrays.tetrahedra;
    this.neighbors = arrays.neighbors;
    this.hull = arrays.hull;
    this.duplicateOf = arrays.duplicateOf;
    this.dimension = arrays.dimension;
    this.points = arrays.points;
    this.stats = arrays.stats;
    if (arrays.trace) this.trace = arrays.trace;
    this.#outputs = outputs;
  }

  /** The tetrahedra as VTK's XML unstructured grid (`.vtu`), which ParaView and PyVista read. */
  async toVTU(options: TaskOptions = {}): Promise<Uint8Array> {
    return (await this.#write('vtu', [], options)).vtu!;
  }

  /** The hull as Stanford PLY (`.ply`), binary. */
  async toPLY(options: TaskOptions = {}): Promise<Uint8Array> {
    return (await this.#write('ply', ['hull'], options)).ply!;
  }

  /** The hull as Wavefront OBJ (`.obj`). */
  async toOBJ(options: TaskOptions = {}): Promise<Uint8Array> {
    return (await this.#write('obj', ['hull'], options)).obj!;
  }

  /** The hull as binary STL (`.stl`), whose numbers are single precision. */
  async toSTL(options: TaskOptions = {}): Promise<Uint8Array> {
    return (await this.#write('stl', ['hull'], options)).stl!;
  }

  /** The hull as binary glTF 2.0 (`.glb`), whose numbers are single precision: relative to the node's translation where
   * that would lose something. Axes stay as they are, though glTF has y point up. */
  async toGLB(options: TaskOptions = {}): Promise<Uint8Array> {
    return (await this.#write('glb', ['hull'], options)).glb!;
  }

  /** TetGen's three files: points, tetrahedra and neighbours, counted from 0. */
  async toTetGen(
    options: TaskOptions = {},
  ): Promise<{ node: Uint8Array; ele: Uint8Array; neigh: Uint8Array }> {
    const { node, ele, neigh } = await this.#write('tetgen', ['neighbors'], options);
    return { node: node!, ele: ele!, neigh: neigh! };
  }

  /** NumPy's `.npz` with the arrays `points`, `tetrahedra` and `neighbors`. */
  async toNPZ(options: TaskOptions = {}): Promise<Uint8Array> {
    return (await this.#write('npz', ['neighbors'], options)).npz!;
  }

  /** Only what the format needs is copied to the writer. */
  #write(
    format: string,
    needs: readonly Output[],
    options: TaskOptions,
  ): Promise<Record<string, Uint8Array>> {
    const missing = needs.find((output) => !this.#outputs.includes(output));
    if (missing)
      throw new GdelError(
        'BAD_INPUT',
        `${format} files need '${missing}' among the outputs of the run`,
      );
    const isHull = needs.includes('hull');
    const mesh = {
      tetrahedra: isHull ? new Uint32Array(0) : this.tetrahedra,
      hull: isHull ? this.hull : undefined,
      neighbors: needs.includes('neighbors') ? this.neighbors : undefined,
    };
    return write(this.points, mesh, format, options);
  }
}
