// What is derived from meshes: options and results.

import type { Coordinates, Doubles, Indices, SignedIndices } from './arrays.js';
import type { TaskOptions } from './types.js';

/** How values are interpolated between the vertices. */
export type InterpolationMethod =
  /** Within each simplex: continuous, and the fastest. */
  | 'linear'
  /** Natural neighbours, weighted by the areas of facets of Voronoi cells and by distances. */
  | 'laplace'
  /** Natural neighbours, weighted by volumes of Voronoi cells: smooth except at the vertices. */
  | 'sibson';

/** Options of `nearest`. */
export interface NearestOptions extends TaskOptions {
  /** How many vertices to find for each query, default 1. */
  k?: number | undefined;
}

/** Options of `interpolate`. */
export interface InterpolateOptions extends TaskOptions {
  /** Default `'linear'`. */
  method?: InterpolationMethod | undefined;
}

/** A box: the lowest coordinates, then the highest, as in `[xmin, ymin, zmin, xmax, ymax, zmax]`. */
export type Bounds = ArrayLike<number>;

/** Options of `voronoi`. */
export interface VoronoiOptions extends TaskOptions {
  /**
   * What the cells are clipped to: nothing, the smallest box that contains all points, their convex
   * hull, or a box. Default `'none'`.
   */
  clip?: 'none' | 'box' | 'hull' | Bounds | undefined;
}

/** Options of `alphaShape`. */
export interface AlphaOptions extends TaskOptions {
  /**
   * The radius, or `'auto'` for the smallest at which all points belong to the solid, and this has
   * no more than `components` components. Default `'auto'`.
   */
  alpha?: number | 'auto' | undefined;
  /** Default 1. */
  components?: number | undefined;
  /** Whether to return `criticalValues`, default false. */
  criticalValues?: boolean | undefined;
}

/** The alpha shape of the points of a mesh for one radius. */
export interface AlphaShape {
  /** The radius; 0 if that was `'auto'` and the points are flat. */
  readonly alpha: number;
  /** The simplices of the mesh that belong to the solid, ascending. */
  readonly solid: Indices;
  /**
   * The boundary of the solid, closed: 3 vertices per triangle, counter-clockwise as seen from
   * outside; in 2D 2 vertices per edge, in the direction in which it runs in its triangle.
   */
  readonly surface: Indices;
  /** The number of components of the solid, which hang together across facets. */
  readonly components: number;
  /** The component of each simplex of the mesh, −1 outside the solid. */
  readonly componentOf: Int32Array;
  /**
   * The circumradius of each simplex of the mesh: the radius from which on it belongs to the solid,
   * with a relative error below 10⁻¹⁰. For a slider, filter by this.
   */
  readonly radii: Doubles;
  /** The radii at which anything changes, ascending; empty unless requested. */
  readonly criticalValues: Doubles;
}

/** Options of `surface`. */
export interface SurfaceOptions extends TaskOptions {
  /**
   * Pieces of the solid and cavities in it are dropped if their volume is less than this share of the
   * largest piece's, from 0 to 1. Default 0.01.
   */
  minPart?: number | undefined;
  /**
   * Whether to drop points that are far from all others before the surface is found: the sixth nearest
   * one is more than four times as far away as is usual, and as it is around them. Default true.
   */
  dropIsolated?: boolean | undefined;
  /**
   * How often to move the points onto quadrics through their neighbours before the surface is found, up
   * to 100 times. Default `'auto'`: twice if there is noise, which is estimated, else never.
   */
  smooth?: number | 'auto' | undefined;
  /**
   * The normals of the points, which point outwards: 3 coordinates per point, 2 in 2D; 0 where one is
   * unknown. Their lengths do not matter. {@link PointCloud.normals} has those of a file.
   */
  normals?: Coordinates | undefined;
  /**
   * The positions of the sensor, one for each point or one for all, such as {@link PointCloud.sensors}.
   * What a point was seen through is outside.
   */
  sensors?: Coordinates | undefined;
  /**
   * The direction that is up, if what is below all points is inside, as in airborne scans of the ground.
   */
  up?: readonly number[] | undefined;
  /**
   * Whether triangles that only close gaps are left out: `'never'`, or `'auto'` where they are more than
   * a tenth of the area, as in terrain, a wall or a scan from one side. Default `'never'`.
   */
  open?: 'never' | 'auto' | undefined;
  /**
   * Whether to split each triangle into four, and each edge into two in 2D, with the new vertices on
   * quadrics through the points around them: closer to what is curved. Default false.
   */
  refine?: boolean | undefined;
  /** Whether to return `solid`, default false. */
  solid?: boolean | undefined;
}

/** What surfaces of both dimensions have in common. */
export interface SurfaceArrays {
  /**
   * The coordinates of the vertices, in the precision of the points: 3 per vertex, 2 in 2D. They are
   * coordinates of points, except where points were moved or two sheets touch along an edge.
   */
  readonly vertices: Coordinates;
  /**
   * For each vertex the point that it is, ascending. A point where sheets of the surface touch comes
   * several times. −1 for a vertex in the middle of an edge along which two sheets touch, and
   * for those of a refined surface.
   */
  readonly sources: SignedIndices;
  /** Where each point lies: 0 outside or dropped, 1 on the surface, 2 inside the solid. */
  readonly sides: Uint8Array<ArrayBuffer>;
  /**
   * The volume of the solid in units of the input; its area in 2D. The solid of an open surface is closed
   * by what was left out.
   */
  readonly volume: number;
  /** The area of the surface; the length of the curves in 2D. */
  readonly area: number;
  /** The number of connected surfaces, or curves in 2D. A ball with a cavity has two. */
  readonly components: number;
  /**
   * The number of handles of all surfaces together: 0 for a sphere, 1 for a torus. 0 in 2D.
   */
  readonly genus: number;
  /**
   * Whether every edge belongs to exactly two triangles, in opposite directions; in 2D, every vertex to
   * two edges. It was counted; by construction it is true, unless the surface is open.
   */
  readonly closed: boolean;
  /** The number of closed curves that bound the surface; in 2D of curves with two ends. 0 if it is closed. */
  readonly boundaries: number;
  /**
   * How it is known which side is inside: by `'normals'`, by `'sensors'`, since what is `'below'` is, or
   * by the `'hull'`, beyond which is outside. `'guess'` if the points enclose little, as in a scan from
   * one side: the surface may be inside out.
   */
  readonly evidence: 'normals' | 'sensors' | 'below' | 'hull' | 'guess';
  /**
   * The median distance of the points from quadrics through their neighbours, in units of the distance
   * between points; 0 where it was not estimated.
   */
  readonly noise: number;
  /** How many points were dropped because they are far from all others. */
  readonly isolated: number;
  /** How many pieces of the solid were dropped because they are small. */
  readonly droppedPieces: number;
  /** How many cavities were filled because they are small. */
  readonly filledCavities: number;
  /** The coordinates of all points as they were moved; null if they were not. */
  readonly moved: Doubles | null;
  /**
   * If requested, the simplices inside by their vertices, which are points: 4 per tetrahedron, 3 per
   * triangle. They are those of the mesh, unless points were dropped or moved. Else null.
   */
  readonly solid: Indices | null;
}

/** Closed curves through the points of a 2D mesh. */
export interface Surface2 extends SurfaceArrays {
  /** 2 vertices per edge; the inside is on its left if the y axis points down. */
  readonly edges: Indices;
}

/** What is connected with what in a mesh. */
export interface Topology {
  /** 2 vertices per edge; each edge once. */
  readonly edges: Indices;
  /**
   * 3 vertices per facet, counter-clockwise as seen from outside the tetrahedron with the lower index;
   * each facet once. In 2D the facets are the edges.
   */
  readonly facets: Indices;
  /**
   * Where the neighbours of each point start in `neighbors`; one more entry says where the last end.
   * Duplicates have none.
   */
  readonly neighborOffsets: Indices;
  /** The points that each point has an edge to, ascending. */
  readonly neighbors: Indices;
  /** For each point the first simplex that has it; −1 for duplicates, and if there are no simplices. */
  readonly vertexSimplex: Int32Array;
}

/** What the simplices of a mesh are like. */
export interface Geometry {
  /** The coordinates of the centre of each simplex's circumsphere, infinite beyond the range of doubles. */
  readonly circumcenters: Doubles;
  /** The radii of the circumspheres. */
  readonly circumradii: Doubles;
  /** The volumes, in 2D the areas. */
  readonly volumes: Doubles;
  /**
   * The inradius divided by the circumradius, times the dimension: 1 for regular simplices, near 0 for
   * flat ones.
   */
  readonly radiusRatios: Doubles;
  /**
   * In radians: 6 dihedral angles per tetrahedron, at the edges between vertices 0 and 1, 0 and 2, 0
   * and 3, 1 and 2, 1 and 3, 2 and 3; in 2D 3 angles per triangle, at its vertices.
   */
  readonly angles: Doubles;
}

/** The Voronoi diagram of the points of a mesh, as arrays. */
export interface VoronoiArrays {
  /**
   * The coordinates of the vertices: first the circumcentre of each simplex of the mesh, then those
   * that clipping made.
   */
  readonly vertices: Doubles;
  /** Where the vertices of each facet start in `facets`; one more entry says where the last end. */
  readonly facetOffsets: Indices;
  /**
   * The vertices of each facet: counter-clockwise as seen from outside in 3D, the two ends of the
   * edge in 2D. Those of unbounded facets are an open chain. A facet between two cells is listed with
   * each of both.
   */
  readonly facets: Indices;
  /** For each facet, the point on the other side; −1 where the cell was clipped. */
  readonly neighbors: Int32Array;
  /** The area of each facet, its length in 2D; infinite for unbounded facets. */
  readonly areas: Doubles;
  /**
   * Where the facets of each point's cell start; one more entry says where the last end. Duplicates
   * have none.
   */
  readonly cells: Indices;
  /** The volume of each point's cell, its area in 2D; infinite for unbounded cells, 0 for empty ones. */
  readonly volumes: Doubles;
  /** The centre of mass of each point's cell; NaN for unbounded and empty cells. */
  readonly centroids: Doubles;
}
