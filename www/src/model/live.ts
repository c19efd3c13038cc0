import {
  type Backend,
  generate,
  generate2d,
  type Mesh2,
  Mesh3,
  type Triangulator,
  type UpdateStats,
} from 'gdel-wasm';
import type { Dimension } from '../geometry/dimension';
import { frameOf } from '../geometry/mesh';
import { NOTHING_ABOUT } from './about';
import type { Drawing, DrawRequest, Model } from './model';
import { Model2d } from './model2d';
import { Model3d } from './model3d';

/** One frame of the live mode. */
export interface LiveFrame {
  drawing: Drawing;
  /** The points as drawn, in 2D; in 3D they are inside the mesh. */
  positions: Float32Array | null;
  simplices: number;
  /** For the triangulation alone. */
  milliseconds: number;
  /** How it was made from the frame before; null for the first one. */
  update: UpdateStats | null;
}

/**
 * Points of a ball or a disk that turn at different speeds, so that no two frames have the same
 * triangulation. Each is an update of the one before.
 */
export class Live {
  private readonly moved: Float32Array;
  /** The mesh of the last frame, and what was asked to make it. */
  private last: { mesh: Mesh3 | Mesh2; backend: Backend } | null = null;

  private constructor(
    readonly dimension: Dimension,
    readonly count: number,
    private readonly start: Float64Array,
  ) {
    this.moved = new Float32Array(start.length);
  }

  static async make(dimension: Dimension, count: number): Promise<Live> {
    return new Live(
      dimension,
      count,
      await (dimension === 3 ? generate('ball', count) : generate2d('disk', count)),
    );
  }

  /** Moves the points, and the mesh of the last frame with them. */
  async frame(
    triangulator: Triangulator,
    backend: Backend,
    seconds: number,
    request: DrawRequest,
  ): Promise<{ model: Model; frame: LiveFrame }> {
    const is3d = this.dimension === 3;
    if (is3d) this.turnBall(seconds);
    else this.stirDisk(seconds);
    const mesh = await this.meshBy(triangulator, backend);
    const model =
      mesh instanceof Mesh3
        ? Model3d.of(mesh, this.moved, NOTHING_ABOUT, BALL)
        : Model2d.of(mesh, this.moved, NOTHING_ABOUT, DISK);
    const drawing = model.draw(request);
    const { milliseconds, update } = mesh.stats;
    return {
      model,
      frame: {
        drawing,
        positions: is3d ? null : model.positions,
        simplices: drawing.total,
        milliseconds,
        update,
      },
    };
  }

  /** The mesh of the moved points: that of the last frame, updated, if it is by the same backend. */
  private async meshBy(triangulator: Triangulator, backend: Backend): Promise<Mesh3 | Mesh2> {
    if (this.last?.backend === backend) {
      await this.last.mesh.update(this.moved);
      return this.last.mesh;
    }
    const mesh =
      this.dimension === 3
        ? await triangulator.delaunay3d(this.moved, {
            backend,
            outputs: ['neighbors', 'duplicateOf'],
          })
        : await triangulator.delaunay2d(this.moved, { backend });
    this.last = { mesh, backend };
    return mesh;
  }

  private turnBall(seconds: number): void {
    for (let i = 0; i < this.start.length; i += 3) {
      const [x, y, z] = [this.start[i], this.start[i + 1], this.start[i + 2]];
      const angle =
        seconds * (0.9 - 0.8 * Math.hypot(x, z)) + 0.35 * Math.sin(0.7 * seconds + 3 * y);
      const swell = 1 + 0.12 * Math.sin(1.1 * seconds + 4 * y);
      this.moved[i] = swell * (x * Math.cos(angle) + z * Math.sin(angle));
      this.moved[i + 1] = y;
      this.moved[i + 2] = swell * (z * Math.cos(angle) - x * Math.sin(angle));
    }
  }

  private stirDisk(seconds: number): void {
    for (let i = 0; i < this.start.length; i += 2) {
      const [x, y] = [this.start[i], this.start[i + 1]];
      const radius = Math.hypot(x, y);
      const angle = seconds * (0.55 - 0.5 * radius);
      const swell = 1 + 0.1 * Math.sin(1.3 * seconds + 6 * radius + 3 * Math.atan2(y, x));
      this.moved[i] = swell * (x * Math.cos(angle) - y * Math.sin(angle));
      this.moved[i + 1] = swell * (x * Math.sin(angle) + y * Math.cos(angle));
    }
  }
}

/** The frames stay the same, so that nothing seems to breathe. */
const BALL = frameOf([-0.8, -0.8, -0.8, 0.8, 0.8, 0.8]);
const DISK = frameOf([-0.9, -0.9, 0.9, 0.9], 2);
