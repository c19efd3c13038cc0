import type { ColorSource, Stats } from 'gdel-wasm';
import type { CutOf, CutPart } from '../geometry/cut';
import type { Dimension } from '../geometry/dimension';
import type { Filter } from '../geometry/filter';
import type { Frame } from '../geometry/mesh';
import type { Ray } from '../geometry/pick';
import type { Pieces } from '../geometry/pieces';
import type { Plane } from '../geometry/plane';
import type { ColorBy, ColorScale } from '../geometry/scale';
import type { Surface } from '../geometry/surface';
import type { Up } from '../geometry/up';
import type { Voronoi } from '../geometry/voronoi';
import type { CameraPose } from '../view/viewer';
import type { About } from './about';
import type { Constrained } from './shapes';

/** At most so many tetrahedra are drawn one by one when they are pulled apart. */
export const MAX_PIECES = 300_000;

/** Of at most so many points, Voronoi cells are drawn in 3D. */
export const MAX_CELLS = 50_000;

/** At most so many facets are drawn: more would take gigabytes. */
export const MAX_FACETS = 4_000_000;

/**
 * Of up to so many points, a run can be recorded: the triangulation after each round, and what
 * flipping left.
 */
export const MAX_POINTS_TO_RECORD = 40_000;

/** The result of a run in numbers. */
export interface Summary {
  /** In 2D the simplices are triangles, and the hull's facets are edges. */
  dimension: Dimension;
  /** The dimension of the points' affine hull. If it is smaller, there are no simplices. */
  affineDimension: number;
  points: number;
  /** How many of them were given, where others were added to a mesh of polygons. */
  given?: number;
  duplicates: number;
  /** How many points the file has besides, which hold no measurement. */
  noReturn: number;
  /** How many points there are on the faces of a coarse model, and whether they are among these. */
  onFaces: About['onFaces'];
  /** Where the points' own colours come from; null if they have none. */
  colorSource: ColorSource | null;
  simplices: number;
  hullFacets: number;
  stats: Stats;
  frame: Frame;
  /** Which axis seems to point up; in 2D that is y. */
  up: Up;
  /** Where the camera is at first. */
  home: CameraPose;
  /** What was recorded of the run: null where nothing was. */
  trace: {
    /** The rounds whose triangulation can be looked at. */
    rounds: number;
    /** The facets that were not locally Delaunay after Phase 1. */
    nonDelaunayFacets: number;
    /** Those of them that the result has no more. */
    repaired: number;
    /** The tetrahedra that splaying made. */
    splayed: number;
  } | null;
}

/** What is to be drawn. */
export interface DrawRequest {
  filter: Filter;
  /** The cutting plane, in 3D only. */
  plane: Plane;
  color: ColorBy;
  /** Whether the outside has the points' own colours, or is plain where they have none. */
  skin: boolean;
  /** Whether the tetrahedra are pulled apart. */
  pieces: boolean;
  /** The round to look at, or null for the result. */
  round: number | null;
  /** Whether the Voronoi diagram is wanted; in 2D only. */
  voronoi: boolean;
  /** In 3D how far apart Voronoi cells are drawn instead of tetrahedra; null or missing for these. */
  cells?: number | null;
  /** Whether the GPU that draws finds the surface of a cut mesh by itself, so that none is made. */
  onGpu?: boolean;
  /** Whether the points alone are drawn, in 3D. */
  pointsOnly?: boolean;
}

/** What of a drawing may take long. */
export type Prepared = Pick<DrawRequest, 'filter' | 'cells'>;

/** What to draw, and what the legend says. */
export interface Drawing {
  /** Null where the GPU finds it, too: see {@link DrawRequest.onGpu}. */
  surface: Surface | null;
  /** What the GPU needs to find the surface by itself; missing where it cannot. */
  cut?: CutOf;
  pieces: Pieces | null;
  voronoi: Voronoi | null;
  scale: ColorScale;
  /** How many simplices the filter and the cutting plane keep, and of how many. */
  shown: number;
  total: number;
  /** Facets that are not drawn, because there are too many. */
  leftOut: number;
  /** How much of the points' extent the cutting plane leaves. */
  keep: number;
  /** How much it would leave to halve the points. */
  half: number;
  /** The height of the cutting plane in the frame. Infinite if it cuts nothing. */
  level: number;
  /**
   * The filter's alpha, infinite until it is found, whether it is the one that suits, and the
   * critical values that are worth a slider, ascending; null where the filter has none.
   */
  alpha: { value: number; isAuto: boolean; stops: Float32Array } | null;
  /** Whether this is an open surface, which has no inside. */
  open?: boolean;
  /** Whether these are Voronoi cells, in 3D; what is counted then are cells. */
  cells?: boolean;
  /** The round that this is the triangulation of; null for the result. */
  round: number | null;
  /** How long this took. */
  milliseconds: number;
}

/** A simplex under the pointer. */
export interface Picked {
  index: number;
  vertices: number[];
  /** What the pointer is at, in the coordinates of the input. */
  place: number[];
  /** In 2D the height there, between those of the corners, where the points have heights. */
  height: number | null;
  neighbors: number[];
  volume: number;
  circumradius: number;
  radiusRatio: number;
  phase: 1 | 2 | null;
  /** Its edges as drawn, in 2D with its circumcircle: two ends of three coordinates per line. */
  outline: Float32Array;
}

/** One set of points, its mesh, and what has been worked out about it so far. */
export interface Model {
  readonly points: Float32Array | Float64Array;
  /** The points as drawn, three coordinates each. */
  readonly positions: Float32Array;
  readonly about: About;
  summary(): Summary;
  /** Makes what a drawing needs and takes long. */
  prepare(request: Prepared, signal?: AbortSignal): Promise<void>;
  draw(request: DrawRequest): Drawing;
  /** The simplex that a ray meets first in the last drawing. */
  pick(ray: Ray, apart: number): Picked | null;
  /** The corners of the hull's facets as drawn, three coordinates each. */
  hull(): Float32Array;
  /** What became of polygons and lines, if there are some. */
  constrained?(): Constrained;
  /** The surface of the last drawing, also where the GPU finds it by itself. */
  drawnSurface?(): Surface | null;
  /**
   * Some items of a part of the mesh for the GPU, in memory of their own; null if something else is
   * in that part by now.
   */
  cutPart?(
    part: CutPart,
    contents: string,
    from: number,
    to: number,
  ): ArrayBufferView<ArrayBuffer> | null;
}

/** The points with these indices, three coordinates each. */
export function cornersOf(positions: Float32Array, indices: ArrayLike<number>): Float32Array {
  const corners = new Float32Array(3 * indices.length);
  for (let i = 0; i < indices.length; i++) {
    for (let axis = 0; axis < 3; axis++) corners[3 * i + axis] = positions[3 * indices[i] + axis];
  }
  return corners;
}
