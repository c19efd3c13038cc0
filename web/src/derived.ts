// What is derived from a mesh, in a WebAssembly module of its own.

import { moduleDerived } from '#assets';
import type {
  AlphaOptions,
  AlphaShape,
  InterpolateOptions,
  NearestOptions,
  SurfaceArrays,
  SurfaceOptions,
  VoronoiArrays,
  VoronoiOptions,
} from './answers.js';
import { type Bytes, type Coordinates, type Doubles, type Indices, kindOf } from './arrays.js';
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
import { copyOf } from './points.js';
import type { DerivedMesh, TaskName, Tasks } from './protocol.js';
import { runShared } from './shared.js';
import { write } from './tools.js';
import type { Points, TaskOptions } from './types.js';

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
  return runShared(moduleDerived, task, all, options);
}

export async function locate(source: Source, queries: Points, options: TaskOptions | undefined) {
  const task = taskOptions(optionsOf(options));
  return run('locate', source, { queries: await copyOf(queries, source.dimension, task) }, task);
}

export async function nearest(
  source: Source,
  queries: Points,
  options: NearestOptions | undefined,
) {
  const { k = 1 } = optionsOf(options);
  checkCount('the option k', k);
  const task = taskOptions(optionsOf(options));
  return run(
    'nearest',
    source,
    { queries: await copyOf(queries, source.dimension, task), k },
    task,
  );
}

/** Checks a number of things, of which there is one at least. */
const checkCount = (what: string, count: unknown) => checkInteger(what, count, 1, 2 ** 31);

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
  const args = { queries: await copyOf(queries, source.dimension, task), values: numbers, method };
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

/**
 * A closed, oriented surface through the points of a 3D mesh, and the solid that it encloses. Every
 * edge belongs to two triangles, and no two triangles intersect.
 */
export interface Surface3 extends SurfaceArrays {}
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
  return run('surface', source, { options: given }, taskOptions({ signal, onProgress }));
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
