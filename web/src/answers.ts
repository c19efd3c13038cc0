// What is derived from meshes: options and results.

import type { Coordinates, Doubles, Indices, SignedIndices } from './arrays.js';
import type { Points, TaskOptions } from './types.js';

/** How values are interpolated between the vertices. */
export type InterpolationMethod =
  /** Within each simplex: continuous, and the fastest. */
  | 'linear'
  /** Natural neighbours, weighted by the areas of facets of Voronoi cells and by distances. */
  | 'laplace'
  /** Natural neighbours, weighted by volumes of Voronoi cells: smooth except at the vertices. */
  | 'sibson'
  /** The same with gradients: smooth everywhere. */
  | 'sibson-c1'
  /**
   * A cubic in each third of a triangle, with gradients: smooth everywhere, and faster than natural neighbours. In 2D,
   * and for points in a plane or on a line.
   */
  | 'clough-tocher';

/** Options of `nearest`. */
export interface NearestOptions extends TaskOptions {
  /** How many vertices to find for each query, default 1. */
  k?: number | undefined;
}

/** Options of `locate`. */
export interface LocateOptions extends TaskOptions {
  /**
   * Whether queries outside the hull count as such, however near they are. Default false: those are inside
   * that are outside by no more than coordinates are rounded, which is along each axis four units in the
   * last place of the largest coordinate of the points (2⁻⁵⁰ of it; 2⁻²¹ if the points or the queries are a
   * `Float32Array`).
   */
  exact?: boolean | undefined;
}

/** Options of `interpolate`. */
export interface InterpolateOptions extends LocateOptions {
  /** Default `'linear'`. */
  method?: InterpolationMethod | undefined;
  /**
   * The value outside the hull, whatever the method: NaN, that of the nearest vertex, that at the nearest
   * place of the hull continued along the gradient there, or a number. Default `'nan'`.
   */
  outside?: 'nan' | 'nearest' | 'linear' | number | undefined;
  /**
   * The value of points with equal coordinates: that of the first, the mean of all, or an error of code
   * `BAD_INPUT` if they differ. Default `'first'`.
   */
  duplicates?: 'first' | 'mean' | 'error' | undefined;
}

/** Options of `interpolateGrid`. */
export interface GridOptions extends InterpolateOptions {
  /** The number of cells along *x*. */
  width: number;
  /** The number of cells along *y*. */
  height: number;
  /** The number of cells along *z*, in 3D. */
  depth?: number | undefined;
  /**
   * The lowest and the highest coordinates of the grid: [xmin, ymin, xmax, ymax], or [xmin, ymin, zmin, xmax, ymax,
   * zmax]. Default: the smallest box that contains all points.
   */
  bounds?: ArrayLike<number> | undefined;
}

/** The weights of the points at queries, as a sparse matrix in compressed rows. */
export interface InterpolationWeights {
  /** Where the entries of each query start, and one more that says where the last ones end. */
  readonly offsets: Indices;
  /** The point of each entry. */
  readonly points: Indices;
  /** The weight of each entry. Those of a query have the sum 1. */
  readonly weights: Doubles;
  /** How many queries were outside the hull. These have no entries where a constant is the value. */
  readonly outside: number;
}

/** The values at queries. */
export interface Interpolated {
  /** One per query. */
  readonly values: Doubles;
  /** How many queries were outside the hull. */
  readonly outside: number;
}

/** Options of `contours`. */
export interface ContourOptions extends TaskOptions {
  /**
   * Whether to close contours along the hull: they are then the boundary of where values are the level
   * or higher. Default false: they end at the hull.
   */
  closed?: boolean | undefined;
}

/** The contour lines of a level in 2D. */
export interface Contour2 {
  readonly level: number;
  /** 2 coordinates per vertex. */
  readonly vertices: Doubles;
  /** Where the vertices of each line start in `lines`; one more entry says where the last end. */
  readonly lineOffsets: Indices;
  /**
   * The vertices of each line; of a closed line, the first one comes again at the end. Lines around
   * higher values have the orientation of the triangles.
   */
  readonly lines: Indices;
}

/** The isosurface of a level in 3D. */
export interface Contour3 {
  readonly level: number;
  /** 3 coordinates per vertex. */
  readonly vertices: Doubles;
  /** 3 vertices per triangle, counter-clockwise as seen from where values are lower. */
  readonly triangles: Indices;
}

/** A box: the lowest coordinates, then the highest, as in `[xmin, ymin, zmin, xmax, ymax, zmax]`. */
export type Bounds = ArrayLike<number>;

/** Options of `voronoi`. */
export interface VoronoiOptions extends TaskOptions {
  /**
   * What the cells are clipped to: nothing, the smallest box that contains all points, their convex
   * hull, a box, or the convex polygon or polyhedron with some corners, in any order. Default `'none'`. With
   * constraints, cells end at the boundaries, and this is to be left out.
   */
  clip?: 'none' | 'box' | 'hull' | Bounds | { corners: Points } | undefined;
}

/** Options of `refine`. */
export interface RefineOptions extends TaskOptions {
  /** The smallest angle of triangles, in degrees, from 0 to 34. Default 20. */
  minAngle?: number | undefined;
  /** The largest area of triangles. By default any. */
  maxArea?: number | undefined;
  /** The longest edge of triangles: one length, or one for each point, linear between them. By default any. */
  size?: number | ArrayLike<number> | undefined;
  /** How many points are added at most. By default as many as are needed. */
  maxPoints?: number | undefined;
}

/** What `refine` has done, and which triangles are not as asked for. */
export interface Refinement {
  readonly pointsOnSegments: number;
  readonly pointsInside: number;
  /** The smallest angle of the triangles inside, in degrees. */
  readonly minAngle: number;
  /** Triangles with a smaller angle than asked for where segments meet under less than 60°. */
  readonly atInputAngles: number;
  /** Those with a smaller angle because coordinates are too coarse for more points there. */
  readonly tooFine: number;
  /** Those with a smaller angle because there were to be no more points. */
  readonly beyondLimit: number;
  /** Triangles that are larger than asked for, for either of the last two reasons. */
  readonly tooLarge: number;
  /** Whether more points were needed than allowed. */
  readonly limited: boolean;
}

/** Options of `transport`. */
export interface TransportOptions extends TaskOptions {
  /** What the cells are clipped to, as for `voronoi`, but not `'none'`. Default `'box'`. */
  clip?: 'box' | 'hull' | Bounds | { corners: Points } | undefined;
  /**
   * The mass of each point, which is the volume that its cell is to have, in 2D the area. By default all are
   * equal.
   */
  masses?: ArrayLike<number> | undefined;
  /**
   * Whether masses are only compared with each other, as the numbers of a treemap are. By default their sum
   * has to be the volume of what the cells are clipped to, within a millionth.
   */
  normalize?: boolean | undefined;
  /** The share of its mass by which the volume of a cell may differ from it. Default 0.001. */
  tolerance?: number | undefined;
}

/** Weights with which cells have given volumes. */
export interface Transport {
  /** The weight of each point, of which the least is 0. */
  readonly weights: Doubles;
  /** The volume of each point's cell; equal points share one by their masses. */
  readonly volumes: Doubles;
  /** The largest difference between the mass of a cell and its volume, as a share of the mass. */
  readonly error: number;
  /** The number of Newton's steps. */
  readonly steps: number;
}

/** The arrays and numbers of a terrain, which `gdel-wasm/tin` makes. */
export interface TinArrays {
  /** The coordinates of the vertices: x, y, z, x, y, z, … */
  readonly vertices: Coordinates;
  /** 3 vertices per triangle, counter-clockwise as seen from above if x points to the right and y up. */
  readonly triangles: Indices;
  /** The point that each vertex is; −1 for those that were put where `edges` and `rings` cross. */
  readonly sources: SignedIndices;
  /** The edges that pieces of `edges` and `rings` are: 2 vertices each, the lower one first, in ascending order. */
  readonly edges: Indices;
  /** How far from the surface the farthest point is that counts. */
  readonly maxError: number;
  /** How many points have the x and y of another one that counts in their place. */
  readonly duplicates: number;
  /** How many of these have another height than that one. */
  readonly otherHeights: number;
  /** How many places of points are outside the boundaries, so that their heights do not matter. */
  readonly outside: number;
  /** Whether more vertices were needed than `maxPoints`. */
  readonly limited: boolean;
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
  /**
   * Whether to return `singularFacets`, `singularEdges` and `singularVertices`, default false. They take
   * longer than all else.
   */
  singular?: boolean | undefined;
}

/** The alpha shape of the points of a mesh for one radius. */
export interface AlphaShape {
  /** The radius; 0 if that was `'auto'` and there are less than two vertices. */
  readonly alpha: number;
  /** The simplices of the mesh that belong to the solid, ascending. */
  readonly solid: Indices;
  /**
   * The boundary of the solid, closed: 3 vertices per triangle, counter-clockwise as seen from
   * outside; in 2D 2 vertices per edge, in the direction in which it runs in its triangle. Points in a
   * plane of 3D, which have no solid, have the triangles up to this radius, each from both sides, and
   * points on a line in 2D edges in both directions; on a line in 3D, `singularEdges` has them.
   */
  readonly surface: Indices;
  /** The number of components of the solid, or of what flat points have instead, which hang together across facets. */
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
  /**
   * The facets of the alpha complex that belong to no simplex in it, if requested: 3 vertices per
   * triangle, in 2D 2 per edge. An alpha complex has the simplices of the solid, and the faces that
   * have an empty sphere of this radius or less through their vertices.
   */
  readonly singularFacets: Indices;
  /**
   * The edges of the alpha complex that belong to nothing larger in it, if requested: 2 vertices per
   * edge. In 2D they are the facets.
   */
  readonly singularEdges: Indices;
  /** The vertices that belong to nothing larger in the alpha complex, if requested: isolated ones. */
  readonly singularVertices: Indices;
}

/** Options of `ballComplex`. */
export interface BallOptions extends TaskOptions {
  /** Its square is added to all weights: 0 or more, in units of the points. Default 0: the balls are what they are. */
  alpha?: number | undefined;
  /**
   * One weight per point, any finite number: the square of the radius of its ball, which is none if it is
   * negative. Default: those of the mesh. A mesh of equal weights has none, and without weights all are 0.
   */
  weights?: ArrayLike<number> | undefined;
  /** One radius per point instead of `weights`, finite and not negative. */
  radii?: ArrayLike<number> | undefined;
}

/**
 * The alpha complex of balls. Hidden points, duplicates and removed points are no part of it. In 2D, the facets
 * are the edges.
 */
export interface BallComplex {
  /** That of the options. */
  readonly alpha: number;
  /** The simplices of the mesh that are part of the complex, ascending. */
  readonly solid: Indices;
  /**
   * The boundary of these simplices, closed: 3 vertices per triangle, counter-clockwise as seen from outside;
   * in 2D 2 vertices per edge, in the direction in which it runs in its triangle. For points in a plane of 3D,
   * or on a line in 2D, the facets from both sides.
   */
  readonly surface: Indices;
  /**
   * All facets that are part of the complex: 3 vertices per triangle, counter-clockwise as seen from outside the
   * tetrahedron with the lower index; in 2D 2 per edge, as it runs in the triangle with the lower index.
   */
  readonly facets: Indices;
  /** All edges that are part of the complex: 2 vertices each, the lower one first, in ascending order. */
  readonly edges: Indices;
  /** All vertices that are part of the complex, ascending. */
  readonly vertices: Indices;
  /** The facets that belong to no simplex of the complex. */
  readonly singularFacets: Indices;
  /** The edges that belong to nothing larger in the complex. */
  readonly singularEdges: Indices;
  /** The vertices that belong to nothing larger in the complex: balls that meet no other one. */
  readonly singularVertices: Indices;
  /** The number of components, which is that of the union of the balls. */
  readonly components: number;
  /** The component of each point, in the order of their lowest points; −1 for points that are no part of the complex. */
  readonly componentOf: Int32Array;
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
   * one is more than four times as far away as is usual, and as it is around them unless those around them
   * lie on no surface either. Default true.
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
   * The coordinates of the vertices: first the circumcentre, with weights the power centre, of each
   * simplex of the mesh, then those that clipping made.
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
   * and hidden points have none.
   */
  readonly cells: Indices;
  /** The volume of each point's cell, its area in 2D; infinite for unbounded cells, 0 for empty ones. */
  readonly volumes: Doubles;
  /** The centre of mass of each point's cell; NaN for unbounded and empty cells. */
  readonly centroids: Doubles;
}

/** The Delaunay triangulation of points on the unit sphere, as arrays. */
export interface SphereArrays {
  /**
   * 3 points per triangle, counter-clockwise as seen from outside. They cover the sphere once: where all
   * points are within a half of it, the other half, too. One or two points have none.
   */
  readonly triangles: Indices;
  /** 3 per triangle: the opposite of the half-edge from vertex *k* to the next one. */
  readonly halfedges: SignedIndices;
  /**
   * One per triangle: 1 if it is outside the spherical convex hull, where it only closes the sphere, else
   * 0. Its circumcircle is larger than a half of the sphere.
   */
  readonly outer: Uint8Array<ArrayBuffer>;
  /**
   * If all points are inside one half of the sphere, the vertices of their spherical convex hull:
   * counter-clockwise as seen from outside, from the lowest on. Otherwise empty.
   */
  readonly hull: Indices;
  /**
   * One per point: −1, or the point that represents this one: the first at the same place, or the nearest
   * one if they are nearer to each other than about 10⁻⁸ of the radius.
   */
  readonly duplicateOf: SignedIndices;
}

/** Where places are on a sphere. */
export interface LocationsOnSphere {
  /** For each query the triangle that contains it, −1 outside the spherical convex hull. */
  readonly triangles: SignedIndices;
  /** How many queries are outside. */
  readonly outside: number;
}

/** The Voronoi cells of points on the unit sphere, as arrays. */
export interface SphereVoronoiArrays {
  /**
   * The longitudes and latitudes of the corners of cells: first those of the centre of each triangle, then
   * of those in the middle of edges that are longer than a quarter of a great circle.
   */
  readonly vertices: Doubles;
  /** Where the corners of each point's cell start; one more entry says where the last end. */
  readonly cells: Indices;
  /** The corners of each cell, counter-clockwise as seen from outside. */
  readonly corners: Indices;
  /** The area of each cell in steradians; 0 for duplicates. The sum of all is 4π. */
  readonly areas: Doubles;
}

/** The edges of a sphere. */
export interface SphereEdges {
  /** 2 points per edge, the lower one first; without those that are outside the hull only. */
  readonly edges: Indices;
  /** The length of each edge in radians. */
  readonly lengths: Doubles;
  /** 1 for edges of the Urquhart graph: those that are not the longest one of a triangle. */
  readonly urquhart: Uint8Array<ArrayBuffer>;
}
