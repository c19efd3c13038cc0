import type { CutOf } from '../geometry/cut';
import { type Measures, measure } from '../geometry/measures';
import type { Tetrahedralisation } from '../geometry/mesh';
import { type Heights, heightsAlong, type Plane } from '../geometry/plane';
import type { ColorScale } from '../geometry/scale';
import type { DrawRequest } from './model';

/** Counts the bodies, which tells what belongs to which. */
let bodies = 0;

/** Tetrahedra that can be drawn, and what has been worked out about them so far. */
export class Body implements Tetrahedralisation {
  readonly number = bodies++;
  private measures: Measures | null = null;
  private heights: Heights | null = null;

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

  heightsAlong(normal: Plane['normal']): Heights {
    if (this.heights?.normal.join() !== normal.join()) this.heights = heightsAlong(normal, this);
    return this.heights!;
  }
}

/** What the GPU needs to cut a body by itself. */
export function cutOf(
  { number, tetrahedra, positions }: Body,
  { filter, skin }: DrawRequest,
  scale: ColorScale,
  { normal, extent, middle }: Heights,
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
      heights: `${mesh} along ${normal}`,
      filtered: `${mesh} filtered ${JSON.stringify(filter)}`,
      values: `${mesh} on ${JSON.stringify(scale)}`,
    },
    heights: { normal, extent, middle },
    skin,
  };
}
