import type { Engine as Gdel, EngineName, Mesh3, RunOptions, Stats } from 'gdel-wasm';
import { applyFilter, type Filter, type Kept, typicalAlpha } from '../geometry/filter';
import { type Measures, measure } from '../geometry/measures';
import { type Frame, frameOf, type Tetrahedralisation, toFrame } from '../geometry/mesh';
import { firstHit, type Ray } from '../geometry/pick';
import { outermost, type Pieces, piecesOf, trianglesOf } from '../geometry/pieces';
import { heightsAlong, type Heights, levelOf, type Plane } from '../geometry/plane';
import { type ColorBy, type ColorScale, mapping, percentiles, scaleFor } from '../geometry/scale';
import { boundaryOf, type Surface, surfaceOf } from '../geometry/surface';

/** At most so many tetrahedra are drawn one by one when they are pulled apart. */
export const MOST_PIECES = 300_000;

/** At most so many facets are drawn: more would take gigabytes. */
const MOST_FACETS = 4_000_000;

/** Of up to so many points, a run can be recorded: the triangulation after each round, and what flipping left. */
export const MOST_POINTS_TO_RECORD = 40_000;

export type Engine = EngineName;

/** What a run gave, in numbers. */
export interface Summary {
  points: number;
  duplicates: number;
  tetrahedra: number;
  hullTriangles: number;
  dimension: number;
  stats: Stats;
  /** An alpha that suits these points, and the range that is worth a slider. */
  alpha: { typical: number; range: [number, number] };
  /** What was recorded of the run: null where nothing was. */
  trace: {
    /** The rounds whose triangulation can be looked at. */
    rounds: number;
    /** The facets that were not locally Delaunay after Phase 1. */
    nonDelaunayFacets: number;
    /** The tetrahedra that splaying made. */
    splayed: number;
  } | null;
}

/** What is to be drawn. */
export interface DrawRequest {
  filter: Filter;
  plane: Plane;
  color: ColorBy;
  /** Whether the tetrahedra are pulled apart. */
  pieces: boolean;
  /** The round to look at, or null for the result. */
  round: number | null;
}

/** What to draw, and what the legend says. */
export interface Drawing {
  surface: Surface | null;
  pieces: Pieces | null;
  scale: ColorScale;
  /** How many tetrahedra the filter and the plane leave, and of how many. */
  shown: number;
  total: number;
  /** Facets that are not drawn, because there are too many. */
  leftOut: number;
  /** How high the plane lies in the frame. Infinite where it cuts nothing. */
  level: number;
  /** How long this took. */
  milliseconds: number;
}

/** A tetrahedron under the pointer. */
export interface Picked {
  index: number;
  vertices: number[];
  neighbors: number[];
  volume: number;
  circumradius: number;
  radiusRatio: number;
  phase: 1 | 2 | null;
  /** Its corners as drawn, twelve coordinates. */
  corners: Float32Array;
}

/** One set of points, its mesh, and what has been worked out about it so far. */
export class Model {
  readonly positions: Float32Array;
  private readonly drawable: Tetrahedralisation;
  private readonly created: Uint8Array | null;
  private measures: Measures | null = null;
  private heights: Heights | null = null;
  private filtered: { filter: Filter; kept: Kept } | null = null;
  private drawing: Drawing | null = null;

  private constructor(
    readonly points: Float32Array | Float64Array,
    readonly mesh: Mesh3,
    frame: Frame,
  ) {
    this.positions = toFrame(points, frame);
    this.drawable = { positions: this.positions, tetrahedra: mesh.tetrahedra, neighbors: mesh.neighbors };
    this.created = mesh.trace?.created ?? null;
  }

  static async make(gdel: Gdel, points: Float32Array | Float64Array, options: RunOptions, frame?: Frame): Promise<Model> {
    const mesh = await gdel.delaunay3d(points, options);
    return new Model(points, mesh, frame ?? frameOf(points));
  }

  summary(): Summary {
    const { mesh } = this;
    const [low, high] = percentiles(this.measured.circumradius, 0.02, 1);
    let duplicates = 0;
    for (const stand of mesh.duplicateOf) if (stand >= 0) duplicates++;
    return {
      points: this.points.length / 3,
      duplicates,
      tetrahedra: mesh.tetrahedra.length / 4,
      hullTriangles: mesh.hull.length / 3,
      dimension: mesh.dimension,
      stats: mesh.stats,
      alpha: { typical: typicalAlpha(this.points, mesh.tetrahedra), range: [low, high] },
      trace: mesh.trace
        ? {
            rounds: mesh.trace.rounds.length,
            nonDelaunayFacets: mesh.trace.nonDelaunayFacets.length / 3,
            splayed: mesh.trace.created.reduce((sum, phase) => sum + phase, 0),
          }
        : null,
    };
  }

  draw(request: DrawRequest): Drawing {
    this.drawing = request.round === null ? this.drawResult(request) : this.drawRound(request, request.round);
    return this.drawing;
  }

  private drawResult({ filter, plane, color, pieces }: DrawRequest): Drawing {
    const started = performance.now();
    const kept = this.keptBy(filter);
    const heights = this.heightsAlong(plane.normal);
    const level = levelOf(plane, heights);
    const boundary = boundaryOf(this.drawable, kept, heights, level);
    const scale = scaleFor(color, this.measured, kept.kept);
    const value = mapping(scale, this.measured, this.created);
    const { tetrahedra } = this.drawable;
    return {
      surface: pieces ? null : surfaceOf(this.drawable, boundary.facets.subarray(0, MOST_FACETS), value),
      pieces: pieces
        ? piecesOf(this.positions, tetrahedra, outermost(this.drawable, kept, heights, level, boundary, MOST_PIECES), value)
        : null,
      scale,
      shown: boundary.shown,
      total: tetrahedra.length / 4,
      leftOut: pieces ? 0 : Math.max(0, boundary.facets.length - MOST_FACETS),
      level,
      milliseconds: performance.now() - started,
    };
  }

  /** A round of the trace: whole tetrahedra, for it has no neighbours. */
  private drawRound({ plane, color }: DrawRequest, round: number): Drawing {
    const started = performance.now();
    const { tetrahedra } = this.mesh.trace!.rounds[round];
    const measures = measure(this.points, tetrahedra);
    const heights = heightsAlong(plane.normal, {
      positions: this.positions,
      tetrahedra,
      neighbors: new Int32Array(tetrahedra.length).fill(-1),
    });
    const level = levelOf(plane, heights);
    const owners = Uint32Array.from(heights.height.keys())
      .filter((t) => heights.height[t] <= level)
      .slice(0, MOST_PIECES);
    const scale = scaleFor(color === 'phase' ? 'quality' : color, measures, new Uint8Array(tetrahedra.length / 4).fill(1));
    return {
      surface: null,
      pieces: piecesOf(this.positions, tetrahedra, owners, mapping(scale, measures, null)),
      scale,
      shown: owners.length,
      total: tetrahedra.length / 4,
      leftOut: 0,
      level,
      milliseconds: performance.now() - started,
    };
  }

  /** The tetrahedron of the result that a ray meets first in the last drawing. */
  pick(ray: Ray, apart: number): Picked | null {
    if (!this.drawing) return null;
    const { surface, pieces } = this.drawing;
    let index = -1;
    if (surface) {
      const hit = firstHit(surface.positions, ray);
      if (hit >= 0) index = surface.owners[hit];
    } else if (pieces) {
      const hit = firstHit(trianglesOf(pieces, apart), ray);
      if (hit >= 0) index = pieces.owners[hit >> 2];
    }
    return index < 0 ? null : this.describe(index, surface ? 0 : apart);
  }

  private describe(index: number, apart: number): Picked {
    const { tetrahedra, neighbors } = this.mesh;
    const vertices = [...tetrahedra.subarray(4 * index, 4 * index + 4)];
    const corners = Float32Array.from(vertices.flatMap((v) => [...this.positions.subarray(3 * v, 3 * v + 3)]));
    for (let axis = 0; axis < 3; axis++) {
      const move = (apart * (corners[axis] + corners[3 + axis] + corners[6 + axis] + corners[9 + axis])) / 4;
      for (let k = 0; k < 4; k++) corners[3 * k + axis] = (corners[3 * k + axis] + move) / (1 + apart);
    }
    return {
      index,
      vertices,
      neighbors: [...neighbors.subarray(4 * index, 4 * index + 4)],
      volume: this.measured.volume[index],
      circumradius: this.measured.circumradius[index],
      radiusRatio: this.measured.radiusRatio[index],
      phase: this.created ? (this.created[index] ? 2 : 1) : null,
      corners,
    };
  }

  /** The triangles of the hull as drawn, nine coordinates each. */
  hull(): Float32Array {
    return corners(this.positions, this.mesh.hull);
  }

  /** The facets that were not locally Delaunay after Phase 1, nine coordinates each. */
  nonDelaunayFacets(): Float32Array {
    return corners(this.positions, this.mesh.trace?.nonDelaunayFacets ?? new Uint32Array());
  }

  private get measured(): Measures {
    return (this.measures ??= measure(this.points, this.mesh.tetrahedra));
  }

  private keptBy(filter: Filter): Kept {
    if (JSON.stringify(this.filtered?.filter) !== JSON.stringify(filter)) {
      const { tetrahedra, neighbors } = this.mesh;
      this.filtered = { filter, kept: applyFilter(filter, this.points, tetrahedra, neighbors, this.measured.circumradius) };
    }
    return this.filtered!.kept;
  }

  private heightsAlong(normal: Plane['normal']): Heights {
    if (this.heights?.normal.join() !== normal.join()) this.heights = heightsAlong(normal, this.drawable);
    return this.heights!;
  }
}

function corners(positions: Float32Array, triangles: Uint32Array): Float32Array {
  const out = new Float32Array(3 * triangles.length);
  triangles.forEach((v, i) => {
    for (let axis = 0; axis < 3; axis++) out[3 * i + axis] = positions[3 * v + axis];
  });
  return out;
}

