import { type Engine as Gdel, generate } from 'gdel-wasm';
import { frameOf } from '../geometry/mesh';
import { type DrawRequest, type Drawing, type Engine, Model } from './model';

/** One frame of the live mode. */
export interface LiveFrame {
  drawing: Drawing;
  tetrahedra: number;
  /** For the triangulation alone. */
  milliseconds: number;
}

/** Points of a ball that turn at different speeds, so that no two frames have the same triangulation. */
export class Live {
  private readonly moved: Float32Array;
  private constructor(
    readonly count: number,
    private readonly start: Float64Array,
  ) {
    this.moved = new Float32Array(start.length);
  }

  static async make(count: number): Promise<Live> {
    return new Live(count, await generate('ball', count, { seed: 1 }));
  }

  async frame(gdel: Gdel, engine: Engine, seconds: number, request: DrawRequest): Promise<{ model: Model; frame: LiveFrame }> {
    this.moveTo(seconds);
    const model = await Model.make(gdel, this.moved, { engine, outputs: ['neighbors'] }, UNIT);
    const { tetrahedra, stats } = model.mesh;
    return { model, frame: { drawing: model.draw(request), tetrahedra: tetrahedra.length / 4, milliseconds: stats.milliseconds } };
  }

  private moveTo(seconds: number): void {
    for (let i = 0; i < this.start.length; i += 3) {
      const [x, y, z] = [this.start[i], this.start[i + 1], this.start[i + 2]];
      const angle = seconds * (0.9 - 0.8 * Math.hypot(x, z)) + 0.35 * Math.sin(0.7 * seconds + 3 * y);
      const swell = 1 + 0.12 * Math.sin(1.1 * seconds + 4 * y);
      this.moved[i] = swell * (x * Math.cos(angle) + z * Math.sin(angle));
      this.moved[i + 1] = y;
      this.moved[i + 2] = swell * (z * Math.cos(angle) - x * Math.sin(angle));
    }
  }
}

/** The frame stays the same, so that the ball does not seem to breathe. */
const UNIT = frameOf([-0.8, -0.8, -0.8, 0.8, 0.8, 0.8]);
