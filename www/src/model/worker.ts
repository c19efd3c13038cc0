import * as Comlink from 'comlink';
import {
  type Backend,
  createTriangulator,
  GdelError,
  type RunOptions2,
  type Triangulator,
  type TriangulatorInfo,
  verify,
  verify2d,
} from 'gdel-wasm';
import type { CutPart } from '../geometry/cut';
import type { Dimension } from '../geometry/dimension';
import type { Filter } from '../geometry/filter';
import { type Frame, frameOf } from '../geometry/mesh';
import type { Ray } from '../geometry/pick';
import type { Surface } from '../geometry/surface';
import type { Weighing } from '../settings';
import { type About, NOTHING_ABOUT } from './about';
import { applyEdits, colorsAfter, drawPolygons, type Edit } from './edits';
import { Live, type LiveFrame } from './live';
import type { Drawing, DrawRequest, Model, Picked, Summary } from './model';
import { Model2d } from './model2d';
import { Model3d } from './model3d';
import { type Format, type PrintFormat, printed, type SavedFile, save } from './save';
import type { Found } from './scanned';
import type { Constrained, FileShapes } from './shapes';
import { Shown } from './shown';
import { filterFor, load, type Source } from './source';
import type { Weights } from './weighted';

export type Progress = (progress: { phase: string; fraction: number }) => void;

/** What a change by hand gave. */
export interface Edited {
  summary: Summary;
  drawing: Drawing;
  positions: Float32Array;
  colors: Uint8Array | null;
  hull: Float32Array;
}

/** Points as they came, what is known about them, and what their weights are taken from. */
interface Start {
  points: Float32Array | Float64Array;
  about: About;
  shapes?: FileShapes | undefined;
  source: Source | null;
  weights: Weighing | null;
}

/** What all runs are told. */
type Options = Pick<RunOptions2, 'backend' | 'signal' | 'onProgress'>;

/** The points and the mesh live in this worker, so that the page never waits for them. */
class ModelWorker {
  private readonly triangulator = createTriangulator();
  private model: Model3d | Model2d | null = null;
  /** The 2D points before any change by hand, and what is known about them. */
  private start: Start = {
    points: new Float64Array(),
    about: NOTHING_ABOUT,
    source: null,
    weights: null,
  };
  private live: Live | null = null;
  private readonly shown = new Shown();
  private abort = new AbortController();

  /** Loads the points and triangulates them. The old mesh stays until the new one is ready. */
  run(
    source: Source,
    edits: readonly Edit[],
    weights: Weighing | null,
    backend: Backend,
    onProgress: Progress,
  ): Promise<Summary> {
    return named(async () => {
      const signal = this.begin();
      const loaded = await load(source, { signal, onProgress });
      const { points, about } = loaded;
      const start = { ...loaded, source, weights };
      const options = { backend, signal, onProgress };
      const triangulator = await this.triangulator;
      this.model =
        source.dimension === 3
          ? await Model3d.make(
              triangulator,
              points,
              { ...options, ...(await weighed(start, edits)) },
              about,
            )
          : await flat(triangulator, start, edits, options, frameOf(points, 2));
      this.start = start;
      // While the page shows the points.
      if (!weights && filterFor(source) === 'surface') void this.findSurface().catch(() => {});
      onProgress({ phase: 'Measuring', fraction: 1 });
      return this.model.summary();
    });
  }

  /** Finds the surface that the 3D points were taken from. */
  findSurface(): Promise<Found> {
    return named(async () => {
      if (!(this.current instanceof Model3d)) throw new Error('In 2D there is none.');
      return this.current.findSurface(this.abort.signal);
    });
  }

  /** Finds the radius that suits the filter `alpha`, for which drawings would wait else. */
  findRadius(): Promise<void> {
    const filter: Filter = { kind: 'alpha', alpha: null };
    return named(() => this.current.prepare({ filter }, this.abort.signal));
  }

  /** Triangulates the 2D points with other changes, in the same frame. */
  edit(edits: readonly Edit[], backend: Backend, request: DrawRequest): Promise<Edited> {
    return named(async () => {
      const options = { backend, signal: this.begin() };
      const { frame } = this.current;
      const model = await flat(await this.triangulator, this.start, edits, options, frame);
      await model.prepare(request, options.signal);
      this.model = model;
      this.shown.mesh(model);
      return {
        summary: model.summary(),
        drawing: model.draw(request),
        positions: model.positions,
        colors: this.colors(),
        hull: model.hull(),
      };
    });
  }

  /**
   * Triangulates the current 3D points again, on the GPU, and records the intermediate
   * triangulations.
   */
  record(onProgress: Progress): Promise<Summary> {
    return named(async () => {
      const options = {
        backend: 'gpu',
        signal: this.begin(),
        onProgress,
        outputs: [...ALL, 'trace'],
      } as const;
      const { points, about } = this.current;
      this.model = await Model3d.make(await this.triangulator, points, options, about);
      return this.model.summary();
    });
  }

  /** Triangulates the current points again, for the comparison. */
  time(backend: Backend): Promise<{ milliseconds: number; simplices: number }> {
    return named(async () => {
      const triangulator = await this.triangulator;
      const { points } = this.current;
      const options = { backend, signal: this.begin() };
      if (this.current instanceof Model2d) {
        const { stats, triangles } = await triangulator.delaunay2d(points, options);
        return { milliseconds: stats.milliseconds, simplices: triangles.length / 3 };
      }
      const { stats, tetrahedra } = await triangulator.delaunay3d(points, {
        ...options,
        outputs: [],
      });
      return { milliseconds: stats.milliseconds, simplices: tetrahedra.length / 4 };
    });
  }

  /** Returns what the triangulator uses here. */
  info(): Promise<TriangulatorInfo> {
    return named(async () => (await this.triangulator).info);
  }

  cancel(): void {
    // What is asked for later may begin.
    this.begin();
  }

  draw(request: DrawRequest): Promise<Drawing> {
    return named(async () => {
      const model: Model = this.current;
      this.shown.mesh(model);
      await model.prepare(request, this.abort.signal);
      return model.draw(request);
    });
  }

  pick(ray: Ray, apart: number): Picked | null {
    return this.shown.model?.pick(ray, apart) ?? null;
  }

  /** The surface that is shown, where the GPU finds it by itself. */
  drawnSurface(): Surface | null {
    return this.shown.model?.drawnSurface?.() ?? null;
  }

  /** Some items of a part of the mesh for the GPU: see {@link Model.cutPart}. */
  cutPart(
    part: CutPart,
    contents: string,
    from: number,
    to: number,
  ): ArrayBufferView<ArrayBuffer> | null {
    const items = (this.model as Model | null)?.cutPart?.(part, contents, from, to);
    return items ? Comlink.transfer(items, [items.buffer]) : null;
  }

  /** The coordinates of a point as given. */
  place(point: number): number[] {
    const { points, mesh } = this.current;
    const size = 'tetrahedra' in mesh ? 3 : 2;
    return [...points.subarray(size * point, size * (point + 1))];
  }

  /** The points as drawn. */
  positions(): Float32Array {
    return this.current.positions;
  }

  /** The points' own colours: red, green and blue each; null if they have none. */
  colors(): Uint8Array | null {
    return this.current.about.colors?.rgb ?? null;
  }

  /** The points as given. */
  points(): Float32Array | Float64Array {
    return this.current.points;
  }

  /** What can be said about the weights of points: see {@link Weights}. */
  weights(): Promise<Weights> {
    return named(async () => {
      const { weightsOf } = await import('./weighted');
      return weightsOf(this.current.mesh, this.start.source);
    });
  }

  /** What became of polygons and lines; null where there are none. */
  constrained(): Constrained | null {
    return (this.model as Model | null)?.constrained?.() ?? null;
  }

  hull(): Float32Array {
    return this.current.hull();
  }

  /** The facets that were not locally Delaunay after Phase 1, where the run was recorded. */
  nonDelaunayFacets(): Float32Array | null {
    return this.current instanceof Model3d ? this.current.nonDelaunayFacets() : null;
  }

  verify() {
    return named(async () => {
      const { current } = this;
      const { checks } = await (current instanceof Model2d
        ? verify2d(current.points, current.mesh)
        : verify(current.points, current.mesh));
      return checks;
    });
  }

  save(format: Format, filter: Filter): Promise<SavedFile[]> {
    return named(() => save(this.current, filter, format));
  }

  /** The surface that was found, as a file for a printer. */
  print(format: PrintFormat): Promise<SavedFile> {
    return named(() => printed(this.current, format));
  }

  /** Moves the points of the live mode to a time in seconds, and triangulates them. */
  liveFrame(
    dimension: Dimension,
    count: number,
    backend: Backend,
    seconds: number,
    request: DrawRequest,
  ): Promise<LiveFrame> {
    const makeFrame = async () => {
      if (this.live?.dimension !== dimension || this.live.count !== count)
        this.live = await Live.make(dimension, count);
      return this.live.frame(await this.triangulator, backend, seconds, request);
    };
    return this.shown.frame(makeFrame());
  }

  private begin(): AbortSignal {
    this.abort.abort();
    this.abort = new AbortController();
    return this.abort.signal;
  }

  private get current(): Model3d | Model2d {
    if (!this.model) throw new Error('There is no mesh yet.');
    return this.model;
  }
}

/** Returns the weights of points, if they have some. */
async function weighed(
  { points, source, weights }: Start,
  edits: readonly Edit[],
): Promise<object> {
  if (!weights && !edits.some((edit) => edit.do === 'weigh')) return {};
  return (await import('./weighted')).weighed(points, source!, weights, edits);
}

/** Returns the model of 2D points after changes by hand. */
async function flat(
  triangulator: Triangulator,
  start: Start,
  edits: readonly Edit[],
  options: Options,
  frame: Frame,
): Promise<Model2d> {
  const points = applyEdits(start.points, edits);
  const about = edited(start.about, edits);
  if (start.shapes || drawPolygons(edits)) {
    const { Model2dOfPolygons } = await import('./constrained');
    return Model2dOfPolygons.from(triangulator, start, edits, options, { points, about, frame });
  }
  const all = { ...options, ...(await weighed(start, edits)) };
  return Model2d.make(triangulator, points, all, about, frame);
}

/** What is known about points after changes by hand. */
function edited(about: About, edits: readonly Edit[]): About {
  const { colors } = about;
  return {
    ...about,
    colors: colors && { ...colors, rgb: colorsAfter(colors.rgb, edits) },
    // Points that were added have none.
    heights: edits.length > 0 ? null : about.heights,
  };
}

const ALL = ['neighbors', 'hull', 'duplicateOf'] as const;

/** Errors lose all but name and message on their way to the page: the code becomes the name. */
async function named<T>(work: () => Promise<T>): Promise<T> {
  try {
    return await work();
  } catch (error) {
    throw error instanceof GdelError
      ? Object.assign(new Error(error.message), { name: error.code })
      : error;
  }
}

export type { ModelWorker };

Comlink.expose(new ModelWorker());
