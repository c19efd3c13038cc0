import type { CutOf } from '../geometry/cut';
import { type Measures, measure } from '../geometry/measures';
import type { Tetrahedralisation } from '../geometry/mesh';
import {
  type Heights,
  heightsAlong,
  type Plane,
  type Spread,
  spreadAlong,
} from '../geometry/plane';
import type { ColorScale } from '../geometry/scale';
import type { DrawRequest } from './model';

/** Counts the bodies, which tells what belongs to which. */
let bodies = 0;

/** Tetrahedra that can be drawn, and what has been worked out about them so far. */
export class Body implements Tetrahedralisation {
  readonly number = bodies++;
  private measures: Measures | null = null;
  private spread: Spread | null = null;
  private heights: { normal: string; of: Heights } | null = null;

  constructor(
    /** Three coordinates a point, in the units of the input. */
    readonly points: Float32Array | Float64Array,
    readonly positions: Float32Array,
    readonly tetrahedra: Uint32Array,
    readonly neighbors: Int32Array,
  ) {}

  get measured(): Measures {
    return (this.measures ??= measure(this.points, this.tetrahedra));
  }

  /** Whether {@link measured} is worked out. */
  get isMeasured(): boolean {
    return this.measures !== null;
  }

  spreadAlong(normal: Plane['normal']): Spread {
    if (this.spread?.normal.join() !== normal.join())
      this.spread = spreadAlong(normal, this.positions);
    return this.spread!;
  }

  heightsAlong(normal: Plane['normal']): Heights {
    if (this.heights?.normal !== normal.join())
      this.heights = { normal: normal.join(), of: heightsAlong(normal, this) };
    return this.heights.of;
  }
}

/** What the GPU needs to cut a body by itself. */
export function cutOf(
  { number, tetrahedra, positions }: Body,
  { filter, skin }: DrawRequest,
  scale: ColorScale,
  spread: Spread,
): CutOf {
  const mesh = `mesh ${number}`;
  return {
    tetrahedra: tetrahedra.length / 4,
    points: positions.length / 3,
    parts: {
      tetrahedra: mesh,
      neighbors: mesh,
      positions: mesh,
      colors: mesh,
      heights: `${mesh} along ${spread.normal}`,
      filtered: `${mesh} filtered ${JSON.stringify(filter)}`,
      values: `${mesh} on ${JSON.stringify(scale)}`,
    },
    heights: spread,
    skin,
  };
}
