import * as Comlink from 'comlink';
import { createEngine, type EngineInfo, GdelError, verify, verify2d } from 'gdel-wasm';
import { frameOf } from '../geometry/mesh';
import type { Ray } from '../geometry/pick';
import { applyEdits, type Edit } from './edits';
import { Live, type LiveFrame } from './live';
import type { Drawing, DrawRequest, Engine, Model, Picked, Summary } from './model';
import { PlaneModel } from './planeModel';
import { type Format, type SavedFile, save } from './save';
import { type Dimension, load, type Source } from './source';
import { SpaceModel } from './spaceModel';

export type Progress = (progress: { phase: string; fraction: number }) => void;

/** What a change by hand gave. */
export interface Edited {
  summary: Summary;
  drawing: Drawing;
  positions: Float32Array;
  hull: Float32Array;
}

/** The points and the mesh live in this worker, so that the page never waits for them. */
class ModelWorker {
  private readonly gdel = createEngine();
  private model: SpaceModel | PlaneModel | null = null;
  /** The points of the plane before any change by hand. */
  private start: Float32Array | Float64Array = new Float64Array();
  private live: Live | null = null;
  /** What the page shows: the mesh, or the last frame of the live mode. */
  private shown: Model | null = null;
  private abort = new AbortController();

  /** Gets the points and triangulates them. The old mesh stays until the new one is there. */
  run(
    source: Source,
    edits: readonly Edit[],
    engine: Engine,
    onProgress: Progress,
  ): Promise<Summary> {
    return named(async () => {
      const signal = this.begin();
      const points = await load(source, { signal, onProgress });
      const options = { engine, signal, onProgress };
      const gdel = await this.gdel;
      this.model =
        source.dimension === 3
          ? await SpaceModel.make(gdel, points, options)
          : await PlaneModel.make(gdel, applyEdits(points, edits), options, frameOf(points, 2));
      this.start = points;
      onProgress({ phase: 'Measuring', fraction: 1 });
      return this.model.summary();
    });
  }

  /** Triangulates the points of the plane with other changes, in the same frame. */
  edit(edits: readonly Edit[], engine: Engine, request: DrawRequest): Promise<Edited> {
    return named(async () => {
      const options = { engine, signal: this.begin() };
      const model = await PlaneModel.make(
        await this.gdel,
        applyEdits(this.start, edits),
        options,
        this.current.frame,
      );
      this.model = this.shown = model;
      return {
        summary: model.summary(),
        drawing: model.draw(request),
        positions: model.positions,
        hull: model.hull(),
      };
    });
  }

  /** Triangulates the present points of space once more, on the GPU, and keeps what happened on the way. */
  record(onProgress: Progress): Promise<Summary> {
    return named(async () => {
      const options = {
        engine: 'gpu',
        signal: this.begin(),
        onProgress,
        outputs: [...ALL, 'trace'],
      } as const;
      this.model = await SpaceModel.make(await this.gdel, this.current.points, options);
      return this.model.summary();
    });
  }

  /** Triangulates the present points once more, for the comparison. */
  time(engine: Engine): Promise<{ milliseconds: number; simplices: number }> {
    return named(async () => {
      const gdel = await this.gdel;
      const { points } = this.current;
      const options = { engine, signal: this.begin() };
      if (this.current instanceof PlaneModel) {
        const { stats, triangles } = await gdel.delaunay2d(points, options);
        return { milliseconds: stats.milliseconds, simplices: triangles.length / 3 };
      }
      const { stats, tetrahedra } = await gdel.delaunay3d(points, { ...options, outputs: [] });
      return { milliseconds: stats.milliseconds, simplices: tetrahedra.length / 4 };
    });
  }

  /** What the engines work with here. */
  info(): Promise<EngineInfo> {
    return named(async () => (await this.gdel).info);
  }

  cancel(): void {
    this.abort.abort();
  }

  draw(request: DrawRequest): Drawing {
    this.shown = this.current;
    return this.current.draw(request);
  }

  pick(ray: Ray, apart: number): Picked | null {
    return this.shown?.pick(ray, apart) ?? null;
  }

  /** The points as drawn. */
  positions(): Float32Array {
    return this.current.positions;
  }

  /** The points as given. */
  points(): Float32Array | Float64Array {
    return this.current.points;
  }

  hull(): Float32Array {
    return this.current.hull();
  }

  /** The facets that were not locally Delaunay after Phase 1, where the run was recorded. */
  nonDelaunayFacets(): Float32Array | null {
    return this.current instanceof SpaceModel ? this.current.nonDelaunayFacets() : null;
  }

  verify() {
    return named(async () => {
      const { current } = this;
      const { checks } = await (current instanceof PlaneModel
        ? verify2d(current.points, current.mesh)
        : verify(current.points, current.mesh));
      return checks;
    });
  }

  save(format: Format): Promise<SavedFile[]> {
    return named(() => save(this.current.mesh, format));
  }

  /** Moves the points of the live mode to a moment, in seconds, and triangulates them. */
  async liveFrame(
    dimension: Dimension,
    count: number,
    engine: Engine,
    seconds: number,
    request: DrawRequest,
  ): Promise<LiveFrame> {
    if (this.live?.dimension !== dimension || this.live.count !== count)
      this.live = await Live.make(dimension, count);
    const { model, frame } = await this.live.frame(await this.gdel, engine, seconds, request);
    this.shown = model;
    return frame;
  }

  private begin(): AbortSignal {
    this.abort.abort();
    this.abort = new AbortController();
    return this.abort.signal;
  }

  private get current(): SpaceModel | PlaneModel {
    if (!this.model) throw new Error('There is no mesh yet.');
    return this.model;
  }
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
