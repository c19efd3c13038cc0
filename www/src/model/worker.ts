import * as Comlink from 'comlink';
import { verify } from 'gdel-wasm';
import type { Ray } from '../geometry/pick';
import { type DrawRequest, type Drawing, type Engine, Model, MOST_POINTS_TO_STEP, type Picked, type Summary } from './model';
import { load, type Source } from './source';

export type Progress = (progress: { phase: string; fraction: number }) => void;

/** The points and the mesh live in this worker, so that the page never waits for them. */
class ModelWorker {
  private model: Model | null = null;
  private abort = new AbortController();

  /** Gets the points and triangulates them. The old model stays until the new one is there. */
  async run(source: Source, engine: Engine, onProgress: Progress): Promise<Summary> {
    this.cancel();
    const { signal } = (this.abort = new AbortController());
    const points = await load(source, { signal, onProgress });
    this.model = await Model.make(points, { engine, signal, onProgress });
    return this.model.summary();
  }

  cancel(): void {
    this.abort.abort();
  }

  draw(request: DrawRequest): Drawing {
    const drawing = this.current.draw(request);
    return drawing;
  }

  pick(ray: Ray, apart: number): Picked | null {
    return this.model?.pick(ray, apart) ?? null;
  }

  positions(): Float32Array {
    return this.current.positions;
  }

  hull(): Float32Array {
    return this.current.hull();
  }

  nonDelaunayFacets(): Float32Array {
    return this.current.nonDelaunayFacets();
  }

  verify() {
    return verify(this.current.points, this.current.mesh);
  }

  private get current(): Model {
    if (!this.model) throw new Error('There is no mesh yet.');
    return this.model;
  }
}

export type { ModelWorker };
export const unused = MOST_POINTS_TO_STEP;
Comlink.expose(new ModelWorker());
