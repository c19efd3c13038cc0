// What is derived from a mesh, in a WebAssembly module of its own.

import { wasmDerived } from '#assets';
import { type Coordinates, type Doubles, type Indices, kindOf } from './arrays.js';
import { bad, checkArrays, checkBoolean, checkOneOf, optionsOf, taskOptions } from './options.js';
import { coordinatesInSlices } from './points.js';
import type { DerivedMesh, TaskName, Tasks } from './protocol.js';
import { runShared } from './shared.js';
import { throwIfAborted } from './stop.js';
import type { Points, TaskOptions } from './types.js';

/** How values are interpolated between the vertices. */
export type InterpolationMethod =
  /** Within each simplex: continuous, and the fastest. */
  | 'linear'
  /** Natural neighbours, weighted by the areas of facets of Voronoi cells and by distances. */
  | 'laplace'
  /** Natural neighbours, weighted by volumes of Voronoi cells: smooth except at the vertices. */
  | 'sibson';

/** Options of `nearest`. */
export interface NearestOptions extends TaskOptions {
  /** How many vertices to find for each query, default 1. */
  k?: number | undefined;
}

/** Options of `interpolate`. */
export interface InterpolateOptions extends TaskOptions {
  /** Default `'linear'`. */
  method?: InterpolationMethod | undefined;
}

/** A box: the lowest coordinates, then the highest, as in `[xmin, ymin, zmin, xmax, ymax, zmax]`. */
export type Bounds = ArrayLike<number>;

/** Options of `voronoi`. */
export interface VoronoiOptions extends TaskOptions {
  /**
   * What the cells are clipped to: nothing, the smallest box that contains all points, their convex
   * hull, or a box. Default `'none'`.
   */
  clip?: 'none' | 'box' | 'hull' | Bounds | undefined;
}

/** Options of `alphaShape`. */
export interface AlphaOptions extends TaskOptions {
  /**
   * The radius, or `'auto'` for the smallest at which all points belong to the solid, and this has
   * no more than `components` components. Default `'auto'`.
   */
  alpha?: number | 'auto' | undefined;
  /** Default 1. */
  components?: number | undefined;
  /** Whether to return `criticalValues`, default false. */
  criticalValues?: boolean | undefined;
}

/** The alpha shape of the points of a mesh for one radius. */
export interface AlphaShape {
  /** The radius; 0 if that was `'auto'` and the points are flat. */
  readonly alpha: number;
  /** The simplices of the mesh that belong to the solid, ascending. */
  readonly solid: Indices;
  /**
   * The boundary of the solid, closed: 3 vertices per triangle, counter-clockwise as seen from
   * outside; in 2D 2 vertices per edge, in the direction in which it runs in its triangle.
   */
  readonly surface: Indices;
  /** The number of components of the solid, which hang together across facets. */
  readonly components: number;
  /** The component of each simplex of the mesh, −1 outside the solid. */
  readonly componentOf: Int32Array;
  /**
   * The circumradius of each simplex of the mesh: the radius from which on it belongs to the solid,
   * with a relative error below 10⁻¹⁰. For a slider, filter by this.
   */
  readonly radii: Doubles;
  /** The radii at which anything changes, ascending; empty unless requested. */
  readonly criticalValues: Doubles;
}

/** What is connected with what in a mesh. */
export interface Topology {
  /** 2 vertices per edge; each edge once. */
  readonly edges: Indices;
  /**
   * 3 vertices per facet, counter-clockwise as seen from outside the tetrahedron with the lower index;
   * each facet once. In 2D the facets are the edges.
   */
  readonly facets: Indices;
  /**
   * Where the neighbours of each point start in `neighbors`; one more entry says where the last end.
   * Duplicates have none.
   */
  readonly neighborOffsets: Indices;
  /** The points that each point has an edge to, ascending. */
  readonly neighbors: Indices;
  /** For each point the first simplex that has it; −1 for duplicates, and if there are no simplices. */
  readonly simplexOf: Int32Array;
}

/** What the simplices of a mesh are like. */
export interface Geometry {
  /** The coordinates of the centre of each simplex's circumsphere, infinite beyond the range of doubles. */
  readonly circumcenters: Doubles;
  /** The radii of the circumspheres. */
  readonly circumradii: Doubles;
  /** The volumes, in 2D the areas. */
  readonly volumes: Doubles;
  /**
   * The inradius divided by the circumradius, times the dimension: 1 for regular simplices, near 0 for
   * flat ones.
   */
  readonly radiusRatios: Doubles;
  /**
   * In radians: 6 dihedral angles per tetrahedron, at the edges between vertices 0 and 1, 0 and 2, 0
   * and 3, 1 and 2, 1 and 3, 2 and 3; in 2D 3 angles per triangle, at its vertices.
   */
  readonly angles: Doubles;
}

/** The Voronoi diagram of the points of a mesh, as arrays. */
export interface VoronoiArrays {
  /**
   * The coordinates of the vertices: first the circumcentre of each simplex of the mesh, then those
   * that clipping made.
   */
  readonly vertices: Doubles;
  /** Where the vertices of each facet start in `facets`; one more entry says where the last end. */
  readonly facetOffsets: Indices;
  /**
   * The vertices of each facet: counter-clockwise as seen from outside in 3D, the two ends of the
   * edge in 2D. Those of unbounded facets are an open chain. A facet between two cells is listed with
   * each of both.
   */
  readonly facets: Indices;
  /** For each facet, the point on the other side; −1 where the cell was clipped. */
  readonly neighbors: Int32Array;
  /** The area of each facet, its length in 2D; infinite for unbounded facets. */
  readonly areas: Doubles;
  /**
   * Where the facets of each point's cell start; one more entry says where the last end. Duplicates
   * have none.
   */
  readonly cells: Indices;
  /** The volume of each point's cell, its area in 2D; infinite for unbounded cells, 0 for empty ones. */
  readonly volumes: Doubles;
  /** The centre of mass of each point's cell; NaN for unbounded and empty cells. */
  readonly centroids: Doubles;
}

/** What derives from a mesh: the same in both dimensions. */
export interface Source {
  dimension: 2 | 3;
  points: Coordinates;
  mesh: DerivedMesh;
}

async function run<T extends TaskName>(
  task: T,
  { dimension, points, mesh }: Source,
  args: Omit<Tasks[T]['args'], keyof Source>,
  options: TaskOptions,
): Promise<Tasks[T]['result']> {
  checkArrays({ points, ...mesh });
  const all = { dimension, points, mesh, ...args } as Tasks[T]['args'];
  return runShared(wasmDerived, task, all, options);
}

/** Returns query points as one array that nobody else uses. */
function queriesOf(queries: Points, { dimension }: Source, { signal }: TaskOptions) {
  const conversion = { dimension, transfer: false, point: undefined };
  return coordinatesInSlices(queries, conversion, () => throwIfAborted(signal));
}

export async function locate(source: Source, queries: Points, options: TaskOptions | undefined) {
  const task = taskOptions(optionsOf(options));
  return run('locate', source, { queries: await queriesOf(queries, source, task) }, task);
}

export async function nearest(
  source: Source,
  queries: Points,
  options: NearestOptions | undefined,
) {
  const { k = 1 } = optionsOf(options);
  checkCount('the option k', k);
  const task = taskOptions(optionsOf(options));
  return run('nearest', source, { queries: await queriesOf(queries, source, task), k }, task);
}

/** Checks a number of things, of which there is one at least. */
function checkCount(what: string, count: unknown): void {
  if (!Number.isInteger(count) || (count as number) < 1 || (count as number) > 2 ** 31)
    throw bad(what, 'an integer from 1 on', count);
}

export async function interpolate(
  source: Source,
  values: ArrayLike<number>,
  queries: Points,
  options: InterpolateOptions | undefined,
) {
  const { method = 'linear' } = optionsOf(options);
  checkOneOf('the option method', method, ['linear', 'laplace', 'sibson']);
  const task = taskOptions(optionsOf(options));
  const count = source.points.length / source.dimension;
  const numbers = numbersOf('the values', values, count, 'one per point');
  const args = { queries: await queriesOf(queries, source, task), values: numbers, method };
  return run('interpolate', source, args, task);
}

/** Returns a copy of so many numbers. */
function numbersOf(what: string, values: unknown, length: number, why: string): Doubles {
  const isArray = Array.isArray(values) || kindOf(values) !== undefined;
  const numbers = values as ArrayLike<unknown>;
  if (!isArray || numbers.length !== length) throw bad(what, `${length} numbers, ${why}`, values);
  const copy = new Float64Array(length);
  for (let i = 0; i < length; i++) {
    const value = numbers[i];
    if (typeof value !== 'number') throw bad(`number ${i} of ${what}`, 'a number', value);
    copy[i] = value;
  }
  return copy;
}

const CLIPS = ['none', 'box', 'hull'];

export async function voronoi(
  source: Source,
  options: VoronoiOptions | undefined,
): Promise<VoronoiArrays> {
  const { clip = 'none' } = optionsOf(options);
  const length = 2 * source.dimension;
  if (typeof clip === 'string' && !CLIPS.includes(clip))
    throw bad('the option clip', `one of ${CLIPS.join(', ')}, or ${length} numbers`, clip);
  const args =
    typeof clip === 'string'
      ? { clip, bounds: new Float64Array(0) }
      : {
          clip: 'bounds',
          bounds: numbersOf('the option clip', clip, length, 'the lowest corner and the highest'),
        };
  return run('voronoi', source, args, taskOptions(optionsOf(options)));
}

export async function alphaShape(
  source: Source,
  options: AlphaOptions | undefined,
): Promise<AlphaShape> {
  const { alpha = 'auto', components = 1, criticalValues = false } = optionsOf(options);
  if (alpha !== 'auto' && !(typeof alpha === 'number' && alpha >= 0))
    throw bad('the option alpha', "'auto' or a number that is not negative", alpha);
  checkCount('the option components', components);
  checkBoolean('criticalValues', criticalValues);
  const args = { alpha: alpha === 'auto' ? undefined : alpha, components, criticalValues };
  return run('alphaShape', source, args, taskOptions(optionsOf(options)));
}

/** The Euclidean minimum spanning tree of the vertices of a mesh. */
export class SpanningTree {
  /** 2 vertices per edge, the lower one first, in the order of their lengths. */
  readonly edges: Indices;
  /** The length of each edge. */
  readonly lengths: Doubles;
  readonly #duplicateOf: Int32Array;

  /** @internal */
  constructor({ edges, lengths }: Tasks['spanningTree']['result'], duplicateOf: Int32Array) {
    this.edges = edges;
    this.lengths = lengths;
    this.#duplicateOf = duplicateOf;
  }

  /**
   * Returns for each point the number of its single-linkage cluster, if the longest edges are left
   * out so that there are `count` clusters, as far as there are points enough; 2³² − 1 for points
   * that were removed.
   */
  clusters(count: number): Indices {
    checkCount('the number of clusters', count);
    return this.#label(Math.max(0, this.lengths.length - (count - 1)));
  }

  /**
   * Returns for each point the number of its single-linkage cluster, if the edges that are longer
   * than `distance` are left out; 2³² − 1 for points that were removed.
   */
  clustersWithin(distance: number): Indices {
    if (typeof distance !== 'number' || Number.isNaN(distance))
      throw bad('the distance', 'a number', distance);
    const first = this.lengths.findIndex((length) => length > distance);
    return this.#label(first < 0 ? this.lengths.length : first);
  }

  /** Numbers the components of the first edges. */
  #label(edges: number): Indices {
    const duplicateOf = this.#duplicateOf;
    const parent = Uint32Array.from(duplicateOf, (of, i) => (of < 0 ? i : of));
    const find = (i: number) => {
      while (parent[i] !== i) {
        parent[i] = parent[parent[i]!]!;
        i = parent[i]!;
      }
      return i;
    };
    for (let e = 0; e < edges; e++) {
      const [a, b] = [find(this.edges[2 * e]!), find(this.edges[2 * e + 1]!)];
      // The lowest stands for all.
      parent[Math.max(a, b)] = Math.min(a, b);
    }
    const labels = new Uint32Array(parent.length);
    let count = 0;
    for (let i = 0; i < parent.length; i++) {
      const first = find(i);
      // A point that was removed is its own duplicate, and has no cluster.
      labels[i] = duplicateOf[i] === i ? -1 : first === i ? count++ : labels[first]!;
    }
    return labels;
  }
}

export async function spanningTree(
  source: Source,
  options: TaskOptions | undefined,
): Promise<SpanningTree> {
  const { duplicateOf } = source.mesh;
  const tree = await run('spanningTree', source, {}, taskOptions(optionsOf(options)));
  return new SpanningTree(tree, duplicateOf);
}

export async function topology(source: Source, options: TaskOptions | undefined) {
  return run('topology', source, {}, taskOptions(optionsOf(options)));
}

export async function geometry(source: Source, options: TaskOptions | undefined) {
  return run('geometry', source, {}, taskOptions(optionsOf(options)));
}
