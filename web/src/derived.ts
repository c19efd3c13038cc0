// What is derived from a mesh, in a WebAssembly module of its own.

import { codeEdit, moduleDerived, moduleSurface, moduleTransport } from '#assets';
import type {
  AlphaOptions,
  AlphaShape,
  BallComplex,
  BallOptions,
  ContourOptions,
  GridOptions,
  InterpolateOptions,
  LocateOptions,
  NearestOptions,
  SurfaceArrays,
  SurfaceOptions,
  Transport,
  TransportOptions,
  VoronoiArrays,
  VoronoiOptions,
} from './answers.js';
import { type Bytes, type Coordinates, type Doubles, type Indices, kindOf } from './arrays.js';
import { thrown } from './errors.js';
import { type TriangleFormat, Triangles } from './files.js';
import {
  bad,
  checkArrays,
  checkBoolean,
  checkInteger,
  checkOneOf,
  optionsOf,
  taskOptions,
} from './options.js';
import { copyOf, scaled } from './points.js';
import type { DerivedMesh, TaskName, Tasks } from './protocol.js';
import { loadCode } from './runtime.js';
import { runShared } from './shared.js';
import { write } from './tools.js';
import type { Points, TaskOptions } from './types.js';
import { checkAllUsed } from './weights.js';

/** What derives from a mesh: the same in both dimensions. */
export interface Source {
  dimension: 2 | 3;
  points: Coordinates;
  mesh: DerivedMesh;
  /** By which queries are multiplied, one per axis. */
  factors: readonly number[] | null;
}

async function run<T extends TaskName>(
  task: T,
  { dimension, points, mesh }: Source,
  args: Omit<Tasks[T]['args'], keyof Source>,
  options: TaskOptions,
  module = moduleDerived,
): Promise<Tasks[T]['result']> {
  checkArrays({ points, ...mesh });
  const all = { dimension, points, mesh, ...args } as Tasks[T]['args'];
  return runShared(module, task, all, options);
}

/** Returns a copy of queries, scaled as the points are. */
const queriesOf = async ({ dimension, factors }: Source, queries: Points, task: TaskOptions) =>
  scaled(await copyOf(queries, dimension, task), factors ?? undefined);

export async function locate(source: Source, queries: Points, options: LocateOptions | undefined) {
  const { exact } = optionsOf(options);
  checkBoolean('exact', exact);
  const task = taskOptions(optionsOf(options));
  const args = { queries: await queriesOf(source, queries, task), options: { exact } };
  return run('locate', source, args, task);
}

export async function nearest(
  source: Source,
  queries: Points,
  options: NearestOptions | undefined,
) {
  const { k = 1 } = optionsOf(options);
  checkCount('the option k', k);
  const task = taskOptions(optionsOf(options));
  return run('nearest', source, { queries: await queriesOf(source, queries, task), k }, task);
}

/** Checks a number of things, of which there is one at least. */
const checkCount = (what: string, count: unknown) => checkInteger(what, count, 1, 2 ** 31);

export async function interpolate(
  source: Source,
  values: ArrayLike<number>,
  queries: Points,
  options: InterpolateOptions | undefined,
) {
  const checked = checkInterpolation(options);
  const task = taskOptions(optionsOf(options));
  const numbers = valuesOf(source, values);
  const args = {
    queries: await queriesOf(source, queries, task),
    values: numbers,
    options: checked,
  };
  return run('interpolate', source, args, task);
}

/** Returns a copy of what says how to interpolate. */
function checkInterpolation(options: InterpolateOptions | undefined) {
  const { method = 'linear', outside = 'nan', duplicates = 'first', exact } = optionsOf(options);
  const methods = ['linear', 'laplace', 'sibson', 'sibson-c1', 'clough-tocher'];
  checkOneOf('the option method', method, methods);
  if (typeof outside !== 'number')
    checkOneOf('the option outside', outside, ['nan', 'nearest', 'linear', 'a number']);
  checkOneOf('the option duplicates', duplicates, ['first', 'mean', 'error']);
  checkBoolean('exact', exact);
  return { method, outside, duplicates, exact };
}

/** Returns a copy of one value per point. */
const valuesOf = ({ points, dimension }: Source, values: ArrayLike<number>) =>
  numbersOf('the values', values, points.length / dimension, 'one per point');

export async function interpolateGrid(
  source: Source,
  values: ArrayLike<number>,
  options: GridOptions,
) {
  const { points, dimension, factors } = source;
  const { width, height, depth, bounds } = optionsOf(options);
  const size = dimension === 2 ? [width, height] : [width, height, depth];
  ['width', 'height', 'depth'].slice(0, dimension).forEach((name, axis) => {
    checkCount(`the option ${name}`, size[axis]);
  });
  const corners = bounds
    ? numbersOf(
        'the option bounds',
        bounds,
        2 * dimension,
        'the lowest and the highest coordinates',
      )
    : boundsOf(points, dimension);
  const grid = Float64Array.from([...(size as number[]), ...corners]);
  if (bounds && factors)
    for (let i = 0; i < 2 * dimension; i++) grid[dimension + i]! *= factors[i % dimension]!;
  const args = {
    values: valuesOf(source, values),
    grid,
    options: checkInterpolation(options),
  };
  return run('interpolateGrid', source, args, taskOptions(optionsOf(options)));
}

/** Returns the lowest and the highest coordinates; those of a unit box without points. */
function boundsOf(points: Coordinates, dimension: number): number[] {
  if (points.length === 0) return [0, 0, 0, 1, 1, 1].slice(3 - dimension, 3 + dimension);
  const low = Array.from(points.subarray(0, dimension));
  const high = [...low];
  points.forEach((x, i) => {
    const axis = i % dimension;
    low[axis] = Math.min(low[axis]!, x);
    high[axis] = Math.max(high[axis]!, x);
  });
  return [...low, ...high];
}

export async function interpolationWeights(
  source: Source,
  queries: Points,
  options: InterpolateOptions | undefined,
) {
  const checked = checkInterpolation(options);
  const task = taskOptions(optionsOf(options));
  const args = { queries: await queriesOf(source, queries, task), options: checked };
  return run('interpolationWeights', source, args, task);
}

export async function gradients(
  source: Source,
  values: ArrayLike<number>,
  options: InterpolateOptions | undefined,
) {
  const args = { values: valuesOf(source, values), options: checkInterpolation(options) };
  const found = await run('gradients', source, args, taskOptions(optionsOf(options)));
  // Per unit of the given coordinates.
  const { factors, dimension } = source;
  if (factors) for (let i = 0; i < found.length; i++) found[i]! *= factors[i % dimension]!;
  return found;
}

/** Returns a copy of so many numbers. */
export function numbersOf(what: string, values: unknown, length: number, why: string): Doubles {
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

export async function contours(
  source: Source,
  values: ArrayLike<number>,
  levels: ArrayLike<number>,
  options: ContourOptions | undefined,
) {
  const { closed = false } = optionsOf(options);
  checkBoolean('closed', closed);
  const args = {
    values: valuesOf(source, values),
    levels: numbersOf('the levels', levels, levels?.length, 'one per contour'),
    closed,
  };
  return run('contours', source, args, taskOptions(optionsOf(options)));
}

const CLIPS = ['none', 'box', 'hull'];

export async function voronoi(
  source: Source,
  options: VoronoiOptions | undefined,
): Promise<VoronoiArrays> {
  const { clip = 'none' } = optionsOf(options);
  const task = taskOptions(optionsOf(options));
  return run('voronoi', source, await clipOf(source, clip, task), task);
}

/** Checks and copies what cells are clipped to. */
async function clipOf(
  { dimension }: Source,
  clip: NonNullable<VoronoiOptions['clip']>,
  task: TaskOptions,
): Promise<{ clip: string; bounds: Doubles }> {
  const length = 2 * dimension;
  if (typeof clip === 'string') {
    if (!CLIPS.includes(clip))
      throw bad('the option clip', `one of ${CLIPS.join(', ')}, or ${length} numbers`, clip);
    return { clip, bounds: new Float64Array(0) };
  }
  if (clip !== null && typeof clip === 'object' && 'corners' in clip) {
    const bounds = Float64Array.from(await copyOf(clip.corners, dimension, task));
    return { clip: 'corners', bounds };
  }
  const why = 'the lowest corner and the highest';
  return { clip: 'bounds', bounds: numbersOf('the option clip', clip, length, why) };
}

export async function transport(
  source: Source,
  options: TransportOptions | undefined,
): Promise<Transport> {
  const { clip = 'box', masses, normalize = false, tolerance = 1e-3 } = optionsOf(options);
  checkBoolean('normalize', normalize);
  if (!(typeof tolerance === 'number' && tolerance > 0 && tolerance < 1))
    throw bad('the option tolerance', 'a number between 0 and 1', tolerance);
  checkAllUsed(source.mesh);
  const task = taskOptions(optionsOf(options));
  const { dimension, points } = source;
  const count = points.length / dimension;
  const args = {
    dimension,
    points,
    ...(await clipOf(source, clip, task)),
    masses: masses && numbersOf('the option masses', masses, count, 'one per point'),
    options: { normalize, tolerance },
  };
  checkArrays({ points });
  return runShared(moduleTransport, 'transport', args, task);
}

export async function alphaShape(
  source: Source,
  options: AlphaOptions | undefined,
): Promise<AlphaShape> {
  const {
    alpha = 'auto',
    components = 1,
    criticalValues = false,
    singular = false,
  } = optionsOf(options);
  if (alpha !== 'auto' && !(typeof alpha === 'number' && alpha >= 0))
    throw bad('the option alpha', "'auto' or a number that is not negative", alpha);
  checkCount('the option components', components);
  checkBoolean('criticalValues', criticalValues);
  checkBoolean('singular', singular);
  const args = { options: { alpha, components, criticalValues, singular } };
  return run('alphaShape', source, args, taskOptions(optionsOf(options)));
}

export async function ballComplex(
  source: Source,
  options: BallOptions | undefined,
): Promise<BallComplex> {
  const task = taskOptions(optionsOf(options));
  const { ballArgs } = await loadCode(codeEdit);
  const args = thrown(() => ballArgs(source, options));
  return run('ballComplex', source, args, task, moduleTransport);
}

export interface Surface3 extends SurfaceArrays {}
/**
 * A closed, oriented surface through the points of a 3D mesh, and the solid that it encloses. Every
 * edge belongs to two triangles, and no two triangles intersect.
 */
// biome-ignore lint/suspicious/noUnsafeDeclarationMerging: the constructor assigns what the interface has.
export class Surface3 extends Triangles {
  /** 3 vertices per triangle, counter-clockwise as seen from outside. */
  declare readonly triangles: Indices;

  /** @internal */
  constructor({ edges, ...arrays }: Tasks['surface']['result']) {
    super();
    Object.assign(this, arrays);
  }

  /** @internal */
  async _write(format: TriangleFormat, options: TaskOptions | undefined): Promise<Bytes> {
    const mesh = { tetrahedra: new Uint32Array(0), hull: this.triangles };
    return (await write('write', { points: this.vertices, mesh, format }, options))[format]!;
  }
}

/** WebAssembly checks the options, all but what cannot be sent to it. */
export async function surface(source: Source, options: SurfaceOptions | undefined) {
  const { signal, onProgress, ...given } = optionsOf(options);
  for (const [name, value] of Object.entries(given))
    if (/function|symbol/.test(typeof value)) throw bad(`the option ${name}`, 'a value', value);
  const task = taskOptions({ signal, onProgress });
  return run('surface', source, { options: given }, task, moduleSurface);
}

/** The Euclidean minimum spanning tree of the points of a mesh; duplicates have edges of length 0. */
export class SpanningTree {
  /** 2 points per edge, the lower one first, in the order of their lengths. */
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
