// The mesh of polygons, in a chunk of its own: most visitors have points.

import { GdelError, type Mesh2, type RunOptions2, type Triangulator } from 'gdel-wasm';
import type { Frame } from '../geometry/mesh';
import type { About } from './about';
import type { Edit } from './edits';
import { cornersOf, type Drawing, type DrawRequest, type Summary } from './model';
import { Model2d } from './model2d';
import {
  ANGLE_STEP,
  type Angles,
  type Constrained,
  type Constraints,
  constraintsAfter,
  type FileShapes,
  MOST_ADDED,
} from './shapes';

/** The points, and what is known about them. */
interface Given {
  points: Float32Array | Float64Array;
  about: About;
  frame: Frame;
}

/** The model of polygons and lines, of which the triangles inside are shown. */
export class Model2dOfPolygons extends Model2d {
  private angles: Angles | null = null;

  private constructor(
    given: Given,
    mesh: Mesh2,
    private readonly count: number,
    private readonly constraints: Constraints,
    private readonly rest: Pick<Constrained, 'start' | 'leftOut' | 'crossing' | 'atCrossings'>,
  ) {
    // Points that were added have no heights.
    super(mesh.coords as Float64Array, mesh, given.frame, { ...given.about, heights: null });
    this.inside = mesh.constraints?.inside ?? new Uint8Array(mesh.triangles.length / 3);
  }

  /** Makes it of points after changes by hand. Where segments cross that must not, it has no triangles. */
  static async from(
    triangulator: Triangulator,
    { points: before, shapes }: { points: ArrayLike<number>; shapes?: FileShapes | undefined },
    edits: readonly Edit[],
    options: Pick<RunOptions2, 'backend' | 'signal' | 'onProgress'>,
    given: Given,
  ): Promise<Model2dOfPolygons> {
    const { points } = given;
    const start = before.length / 2;
    const constraints = constraintsAfter(shapes ?? null, start, edits)!;
    const { edges, rings, holes, fill, meshing } = constraints;
    const crossings = meshing.split ? 'split' : 'error';
    const rest = { start, leftOut: shapes?.leftOut ?? [], crossing: [], atCrossings: 0 };
    const make = (mesh: Mesh2, more: Partial<typeof rest | Pick<Constrained, 'crossing'>> = {}) =>
      new Model2dOfPolygons(given, mesh, points.length / 2, constraints, { ...rest, ...more });
    let mesh: Mesh2;
    try {
      mesh = await triangulator.delaunay2d(points, {
        ...options,
        ...{ edges, rings, holes, fill, crossings },
      });
    } catch (error) {
      if (!(error instanceof GdelError) || !error.pairs) throw error;
      return make(await triangulator.delaunay2d(points, options), { crossing: error.pairs });
    }
    const atCrossings = mesh.constraints!.added;
    const { minAngle, maxArea } = meshing;
    if (minAngle === 0 && maxArea === 0) return make(mesh, { atCrossings });
    const { signal } = options;
    const size = { minAngle, maxArea: maxArea || undefined, maxPoints: MOST_ADDED };
    return make(await mesh.refine({ ...size, signal }), { atCrossings });
  }

  override summary(): Summary {
    const simplices = this.inside!.reduce((sum, inside) => sum + inside, 0);
    return { ...super.summary(), simplices, given: this.count };
  }

  /** The bounded Voronoi diagram of polygons is not drawn. */
  override draw(request: DrawRequest): Drawing {
    return super.draw({ ...request, voronoi: false });
  }

  /** The segments instead, two ends each. */
  override hull(): Float32Array {
    const { edges, rings } = this.constraints;
    const ends = this.mesh.constraints?.edges ?? [
      // They cross.
      ...edges,
      ...rings.flatMap((ring) => ring.flatMap((v, i) => [v, ring[(i + 1) % ring.length]])),
    ];
    return cornersOf(this.positions, ends);
  }

  constrained(): Constrained {
    const { holes, ...constraints } = this.constraints;
    const refinement = this.mesh.constraints?.refinement ?? null;
    this.angles ??= anglesOf(this.points, this.mesh.triangles, this.inside!);
    return { ...constraints, ...this.rest, refinement, angles: this.angles };
  }
}

/** Counts the angles of the triangles inside. */
export function anglesOf(
  points: ArrayLike<number>,
  triangles: ArrayLike<number>,
  inside: ArrayLike<number>,
): Angles {
  const counts: number[] = Array(180 / ANGLE_STEP).fill(0);
  let smallest = NaN;
  for (let e = 0; e < triangles.length; e++) {
    if (!inside[Math.floor(e / 3)]) continue;
    const first = e - (e % 3);
    const [p, q, r] = [0, 1, 2].map((k) => 2 * triangles[first + ((e + k) % 3)]);
    const [ux, uy] = [points[q] - points[p], points[q + 1] - points[p + 1]];
    const [vx, vy] = [points[r] - points[p], points[r + 1] - points[p + 1]];
    const angle = (Math.atan2(Math.abs(ux * vy - uy * vx), ux * vx + uy * vy) * 180) / Math.PI;
    counts[Math.min(counts.length - 1, Math.floor(angle / ANGLE_STEP))]++;
    if (!(angle >= smallest)) smallest = angle;
  }
  return { smallest, counts };
}
