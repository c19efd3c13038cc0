import * as Comlink from 'comlink';
import { createEngine, type EngineInfo, GdelError, verify } from 'gdel-wasm';
import type { Ray } from '../geometry/pick';
import { Live, type LiveFrame } from './live';
import { type DrawRequest, type Drawing, type Engine, Model, type Picked, type Summary } from './model';
import { type Format, type SavedFile, save } from './save';
import { load, type Source } from './source';

export type Progress = (progress: { phase: string; fraction: number }) => void;

/** The points and the mesh live in this worker, so that the page never waits for them. */
class ModelWorker {
  private readonly gdel = createEngine();
  private model: Model | null = null;
  private live: Live | null = null;
  /** What the page shows: the mesh, or the last frame of the live mode. */
  private shown: Model | null = null;
  private abort = new AbortController();

  /** Gets the points and triangulates them. The old mesh stays until the new one is there. */
  run(source: Source, engine: Engine, onProgress: Progress): Promise<Summary> {
    return named(async () => {
      const signal = this.begin();
      const points = await load(source, { signal, onProgress });
      this.model = await Model.make(await this.gdel, points, { engine, signal, onProgress });
      onProgress({ phase: 'Measuring tetrahedra', fraction: 1 });
      return this.model.summary();
    });
  }

  /** Triangulates the present points once more, on the GPU, and keeps what happened on the way. */
  record(onProgress: Progress): Promise<Summary> {
    return named(async () => {
      const options = { engine: 'gpu', signal: this.begin(), onProgress, outputs: [...ALL, 'trace'] } as const;
      this.model = await Model.make(await this.gdel, this.current.points, options);
      return this.model.summary();
    });
  }

  /** Triangulates the present points once more, for the comparison. */
  time(engine: Engine): Promise<{ milliseconds: number; tetrahedra: number }> {
    return named(async () => {
      const again = await Model.make(await this.gdel, this.current.points, { engine, signal: this.begin(), outputs: [] });
      return { milliseconds: again.mesh.stats.milliseconds, tetrahedra: again.mesh.tetrahedra.length / 4 };
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

  nonDelaunayFacets(): Float32Array {
    return this.current.nonDelaunayFacets();
  }

  verify() {
    return named(async () => verify(this.current.points, this.current.mesh));
  }

  save(format: Format): Promise<SavedFile[]> {
    return named(() => save(this.current.mesh, format));
  }

  /** Moves the points of the live mode to a moment, in seconds, and triangulates them. */
  async liveFrame(count: number, engine: Engine, seconds: number, request: DrawRequest): Promise<LiveFrame> {
    if (this.live?.count !== count) this.live = await Live.make(count);
    const { model, frame } = await this.live.frame(await this.gdel, engine, seconds, request);
    this.shown = model;
    return frame;
  }

  private begin(): AbortSignal {
    this.abort.abort();
    this.abort = new AbortController();
    return this.abort.signal;
  }

  private get current(): Model {
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
    throw error instanceof GdelError ? Object.assign(new Error(error.message), { name: error.code }) : error;
  }
}

export type { ModelWorker };
Comlink.expose(new ModelWorker());
