import type { VoronoiArrays } from './answers.js';
import type { Doubles, Indices } from './arrays.js';
import { bad } from './options.js';

/** A closed polygon: its last point is the first one. */
export type Polygon = [number, number][];

/** The Voronoi diagram of a 2D mesh, as arrays and as polygons. */
export class Voronoi2 implements VoronoiArrays {
  readonly vertices: Doubles;
  readonly facetOffsets: Indices;
  readonly facets: Indices;
  readonly neighbors: Int32Array;
  readonly areas: Doubles;
  readonly cells: Indices;
  readonly volumes: Doubles;
  readonly centroids: Doubles;
  /** The coordinates of the circumcentre of each triangle, a part of `vertices`. */
  readonly circumcenters: Doubles;
  readonly #find: (x: number, y: number, start: number) => number;
  readonly #duplicateOf: Int32Array;

  /** @internal */
  constructor(
    arrays: VoronoiArrays,
    triangles: number,
    duplicateOf: Int32Array,
    find: (x: number, y: number, start: number) => number,
  ) {
    this.vertices = arrays.vertices;
    this.facetOffsets = arrays.facetOffsets;
    this.facets = arrays.facets;
    this.neighbors = arrays.neighbors;
    this.areas = arrays.areas;
    this.cells = arrays.cells;
    this.volumes = arrays.volumes;
    this.centroids = arrays.centroids;
    this.circumcenters = arrays.vertices.subarray(0, 2 * triangles) as Doubles;
    this.#duplicateOf = duplicateOf;
    this.#find = find;
  }

  /**
   * Returns the cell of point `i` as a closed polygon `[[x0, y0], [x1, y1], …, [x0, y0]]`, in the
   * orientation of the triangles. Null if the cell is empty, because it was clipped away or the point
   * is a duplicate, and if it is unbounded, since the diagram was not clipped.
   */
  cellPolygon(i: number): Polygon | null {
    this.#check(i);
    const [start, end] = [this.cells[i]!, this.cells[i + 1]!];
    if (start === end || this.volumes[i] === Infinity) return null;
    const polygon: Polygon = [];
    // Each edge begins where the one before ends.
    for (let f = start; f < end; f++) {
      const v = this.facets[this.facetOffsets[f]!]!;
      polygon.push([this.vertices[2 * v]!, this.vertices[2 * v + 1]!]);
    }
    polygon.push([...polygon[0]!]);
    return polygon;
  }

  /** Returns the polygons of all cells that have one, each with its point in the property `index`. */
  *cellPolygons(): Generator<Polygon & { index: number }> {
    for (let i = 0; i < this.volumes.length; i++) {
      const polygon = this.cellPolygon(i);
      if (polygon) yield Object.assign(polygon, { index: i });
    }
  }

  /** Returns the points whose cells share an edge with the cell of point `i`, as far as it is not clipped away. */
  neighborsOf(i: number): Indices {
    this.#check(i);
    const all = this.neighbors.subarray(this.cells[i]!, this.cells[i + 1]!);
    return Uint32Array.from(new Set(all.filter((v) => v !== -1)));
  }

  /**
   * Returns whether point `i` is nearest to the point (x, y), which so belongs to its cell. Clipping
   * does not matter.
   */
  contains(i: number, x: number, y: number): boolean {
    this.#check(i);
    if (!Number.isFinite(x) || !Number.isFinite(y)) return false;
    return this.#duplicateOf[i] === -1 && this.#find(x, y, i) === i;
  }

  #check(i: number): void {
    const count = this.volumes.length;
    if (!Number.isInteger(i) || i < 0 || i >= count)
      throw bad('the point', `an index below ${count}`, i);
  }
}
