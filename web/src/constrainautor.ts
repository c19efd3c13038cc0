// The interface of the npm package @kninnug/constrainautor, on the CPU backend in the calling thread.

import { delaunay2dSync, GdelError, loadConstraints, type Mesh2 } from './index.js';

/** A triangulation of delaunator's form. */
export interface DelaunatorLike {
  coords: ArrayLike<number>;
  triangles: Uint32Array;
  halfedges: Int32Array;
}

type Pairs = ArrayLike<ArrayLike<number>>;

/**
 * Makes edges of a triangulation constrained, with the interface of the npm package `@kninnug/constrainautor`:
 * synchronous, in the calling thread. Points may be equal or lie on edges, which then are several. The points are
 * triangulated anew for each call, so that one call of `constrainAll` is better than many of `constrainOne`.
 *
 * ```js
 * import Delaunator from 'delaunator';
 * import Constrainautor from 'gdel-wasm/constrainautor';
 * await Constrainautor.load(); // once
 * const del = Delaunator.from(points);
 * new Constrainautor(del, edges); // del has the edges now
 * ```
 */
export class Constrainautor<T extends DelaunatorLike = DelaunatorLike> {
  /** The triangulation, whose arrays change. */
  readonly del: T;
  #edges: number[][] = [];
  #mesh!: Mesh2;

  /** Loads the WebAssembly module that the constructor needs. Later calls do nothing. */
  static load(): Promise<void> {
    return loadConstraints();
  }

  /**
   * Takes a triangulation, and constrains edges between its points.
   *
   * @throws `GdelError` `NOT_LOADED` before {@link Constrainautor.load} is done, `CROSSING_CONSTRAINTS`, `BAD_INPUT`.
   */
  constructor(del: T, edges: Pairs = []) {
    if (!del?.triangles?.length || !del.halfedges?.length || !del.coords?.length)
      throw new GdelError('BAD_INPUT', 'Expected an object with Delaunator output');
    this.del = del;
    this.constrainAll(edges);
  }

  /**
   * Constrains the edge between two points. Returns the half-edge from the first to the second; the negative of the
   * half-edge back if there is only that, on the hull; or `Infinity` if the edge leads through another point.
   */
  constrainOne(p1: number, p2: number): number {
    this.constrainAll([[p1, p2]]);
    return this.findEdge(p1, p2);
  }

  /** Constrains edges between pairs of points. */
  constrainAll(edges: Pairs): this {
    const all = [...this.#edges, ...Array.from(edges, (edge) => Array.from(edge))];
    const mesh = delaunay2dSync(this.del.coords as ArrayLike<number>, { edges: all });
    this.#edges = all;
    this.#mesh = mesh;
    const { del } = this;
    for (const name of ['triangles', 'halfedges'] as const) {
      if (del[name].length === mesh[name].length) del[name].set(mesh[name]);
      else Object.assign(del, { [name]: mesh[name] });
    }
    return this;
  }

  /** Does nothing: all edges that are not constrained are Delaunay. */
  delaunify(_deep = false): this {
    return this;
  }

  /** Returns whether a half-edge is constrained. */
  isConstrained(edg: number): boolean {
    const { triangles } = this.#mesh;
    return this.#mesh.constraints!.isEdge(triangles[edg]!, triangles[next(edg)]!);
  }

  /** Returns the half-edge from one point to another; the negative of that back on the hull; else `Infinity`. */
  findEdge(p1: number, p2: number): number {
    const { triangles, duplicateOf } = this.#mesh;
    const [a, b] = [p1, p2].map((p) => (duplicateOf[p]! < 0 ? p : duplicateOf[p]!));
    const from = (v: number, w: number) =>
      triangles.findIndex((start, e) => start === v && triangles[next(e)] === w);
    const forth = from(a!, b!);
    if (forth >= 0) return forth;
    const back = from(b!, a!);
    return back >= 0 ? -back : Infinity;
  }

  /** Returns the points that are no vertices, since they equal others. */
  untriangulatedPoints(): number[] {
    const found: number[] = [];
    this.#mesh.duplicateOf.forEach((of, i) => {
      if (of >= 0) found.push(i);
    });
    return found;
  }
}

const next = (e: number) => (e % 3 === 2 ? e - 2 : e + 1);

export default Constrainautor;
