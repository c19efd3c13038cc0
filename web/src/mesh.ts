import type { Bytes, Coordinates, Indices, SignedIndices } from './arrays.js';
import { GdelError } from './errors.js';
import type { Tasks } from './protocol.js';
import { write } from './tools.js';
import type { Output, Place, Stats, TaskOptions, Trace } from './types.js';

/**
 * A 3D Delaunay triangulation in typed arrays. All vertices are indices of the input points.
 */
export class Mesh3 {
  /**
   * Four vertices per tetrahedron, positively oriented: det(b − a, c − a, d − a) > 0. No
   * tetrahedron is flat.
   */
  readonly tetrahedra: Indices;
  /**
   * Four per tetrahedron: entry *k* is the tetrahedron across the facet opposite vertex *k*, or −1
   * on the hull.
   */
  readonly neighbors: SignedIndices;
  /** Three vertices per triangle of the convex hull, counter-clockwise as seen from outside. */
  readonly hull: Indices;
  /**
   * One per point: −1, or the lowest index of a point with the same coordinates, which represents
   * this one in the mesh.
   */
  readonly duplicateOf: SignedIndices;
  /**
   * The affine dimension of the points: 3, or 2, 1, 0 if they are coplanar, collinear, coincident;
   * 0 if there are none. Below 3 there are no tetrahedra.
   */
  readonly dimension: 0 | 1 | 2 | 3;
  /**
   * The coordinates x, y, z, x, y, z, …: a copy of the input, or its buffer if that was
   * transferred.
   */
  readonly points: Coordinates;
  /** Statistics of the run. */
  readonly stats: Stats;
  /** The intermediate triangulations, if `outputs` has `'trace'` and the GPU computed the mesh. */
  readonly trace?: Trace;
  readonly #outputs: readonly Output[];

  /** @internal */
  constructor(arrays: Tasks['delaunay3d']['result'], place: Place, outputs: readonly Output[]) {
    this.tetrahedra = arrays.tetrahedra;
    this.neighbors = arrays.neighbors;
    this.hull = arrays.hull;
    this.duplicateOf = arrays.duplicateOf;
    this.dimension = arrays.dimension;
    this.points = arrays.points;
    this.stats = { ...arrays.stats, ...place };
    if (arrays.trace) this.trace = arrays.trace;
    this.#outputs = outputs;
  }

  /**
   * Returns the tetrahedra as VTK's XML unstructured grid (`.vtu`), which ParaView and PyVista
   * read.
   */
  async toVTU(options?: TaskOptions): Promise<Bytes> {
    return (await this.#write('vtu', [], options)).vtu!;
  }

  /** Returns the hull as Stanford PLY (`.ply`), binary. */
  async toPLY(options?: TaskOptions): Promise<Bytes> {
    return (await this.#write('ply', ['hull'], options)).ply!;
  }

  /** Returns the hull as Wavefront OBJ (`.obj`). */
  async toOBJ(options?: TaskOptions): Promise<Bytes> {
    return (await this.#write('obj', ['hull'], options)).obj!;
  }

  /** Returns the hull as binary STL (`.stl`), which has single precision. */
  async toSTL(options?: TaskOptions): Promise<Bytes> {
    return (await this.#write('stl', ['hull'], options)).stl!;
  }

  /**
   * Returns the hull as binary glTF 2.0 (`.glb`), which has single precision. If that would lose
   * something, coordinates are relative to the node's translation. Axes stay as they are, though
   * glTF has *y* up.
   */
  async toGLB(options?: TaskOptions): Promise<Bytes> {
    return (await this.#write('glb', ['hull'], options)).glb!;
  }

  /** Returns TetGen's three files: points, tetrahedra and neighbors, counted from 0. */
  async toTetGen(options?: TaskOptions): Promise<{ node: Bytes; ele: Bytes; neigh: Bytes }> {
    const { node, ele, neigh } = await this.#write('tetgen', ['neighbors'], options);
    return { node: node!, ele: ele!, neigh: neigh! };
  }

  /** Returns NumPy's `.npz` with the arrays `points`, `tetrahedra` and `neighbors`. */
  async toNPZ(options?: TaskOptions): Promise<Bytes> {
    return (await this.#write('npz', ['neighbors'], options)).npz!;
  }

  /** Copies only what the format needs to the writer. */
  #write(
    format: string,
    needs: readonly Output[],
    options: TaskOptions | undefined,
  ): Promise<Record<string, Bytes>> {
    const missing = needs.find((output) => !this.#outputs.includes(output));
    if (missing)
      throw new GdelError(
        'BAD_INPUT',
        `${format} files need '${missing}', which was not among the outputs of the run`,
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
