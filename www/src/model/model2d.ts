import type { Mesh2, RunOptions2, Triangulator } from 'gdel-wasm';
import type { Measures } from '../geometry/measures';
import { type Frame, toFrame } from '../geometry/mesh';
import { firstHit, type Hit, placeOf, type Ray } from '../geometry/pick';
import { mapping, scaleFor } from '../geometry/scale';
import { flatSurface, measureTriangles, type Triangulation } from '../geometry/triangles';
import { type Box, type Voronoi, voronoiEdges } from '../geometry/voronoi';
import type { CameraPose } from '../view/viewer';
import type { About } from './about';
import { AlphaRadii, askerFor } from './alpha';
import {
  cornersOf,
  type Drawing,
  type DrawRequest,
  MAX_FACETS,
  type Model,
  type Picked,
  type Prepared,
  type Summary,
} from './model';

/** How far beyond the points the Voronoi diagram goes on, as a share of their extent. */
const MARGIN = 0.2;

const CIRCLE_STEPS = 128;

/** Above the middle. */
const HOME_2D: CameraPose = [0, 0, 2.9, 0, 0, 0];

/** The model of 2D points. */
export class Model2d implements Model {
  readonly positions: Float32Array;
  private readonly drawable: Triangulation;
  private readonly alphas: AlphaRadii;
  private measures: Measures | null = null;
  private diagram: Voronoi | null = null;
  private drawing: Drawing | null = null;
  /** Finds the diagram, with weights another one. */
  private edges = voronoiEdges;
  /** One per triangle: 0 where it is outside the polygons. Null where all are inside. */
  protected inside: Uint8Array | null = null;

  protected constructor(
    readonly points: Float32Array | Float64Array,
    readonly mesh: Mesh2,
    readonly frame: Frame,
    readonly about: About,
  ) {
    this.positions = toFrame(points, frame, 2);
    this.drawable = {
      positions: this.positions,
      triangles: mesh.triangles,
      halfedges: mesh.halfedges,
      hull: mesh.hull,
    };
    this.alphas = new AlphaRadii(
      points,
      mesh.triangles,
      mesh.halfedges.map((edge) => (edge < 0 ? -1 : Math.floor(edge / 3))),
      2,
      frame,
      () => this.measured,
      askerFor(mesh),
    );
  }

  static async make(
    triangulator: Triangulator,
    points: Float32Array | Float64Array,
    options: RunOptions2 & { edges?: typeof voronoiEdges },
    about: About,
    frame: Frame,
  ): Promise<Model2d> {
    const { edges, ...run } = options;
    const model = Model2d.of(await triangulator.delaunay2d(points, run), points, about, frame);
    if (edges) model.edges = edges;
    return model;
  }

  static of(mesh: Mesh2, points: Float32Array | Float64Array, about: About, frame: Frame): Model2d {
    return new Model2d(points, mesh, frame, about);
  }

  summary(): Summary {
    const { mesh } = this;
    let duplicates = 0;
    for (const stand of mesh.duplicateOf) if (stand >= 0) duplicates++;
    return {
      dimension: 2,
      affineDimension: mesh.dimension,
      points: this.points.length / 2,
      duplicates,
      onFaces: null,
      noReturn: this.about.noReturn,
      colorSource: this.about.colors?.source ?? null,
      simplices: mesh.triangles.length / 3,
      hullFacets: mesh.dimension === 2 ? mesh.hull.length : 0,
      stats: mesh.stats,
      frame: this.frame,
      up: 'y',
      home: HOME_2D,
      trace: null,
    };
  }

  prepare({ filter }: Prepared, signal?: AbortSignal): Promise<void> {
    return this.alphas.prepare(filter, signal);
  }

  draw({ filter, color, skin, voronoi }: DrawRequest): Drawing {
    const started = performance.now();
    const { measured } = this;
    const filtered = this.alphas.kept(filter);
    const kept = new Uint8Array(this.mesh.triangles.length / 3);
    const all = new Uint32Array(kept.length);
    let [count, total] = [0, 0];
    for (let t = 0; t < kept.length; t++) {
      if (this.inside?.[t] === 0) continue;
      total++;
      if (filtered?.[t] === 0) continue;
      kept[t] = 1;
      all[count++] = t;
    }
    const scale = scaleFor(color, { measured }, kept);
    this.drawing = {
      surface: flatSurface(
        this.drawable,
        all.slice(0, Math.min(count, MAX_FACETS)),
        mapping(scale, { measured }, null),
        skin ? (this.about.colors?.rgb ?? null) : null,
      ),
      pieces: null,
      voronoi: voronoi
        ? (this.diagram ??= this.edges(this.points, this.frame, this.drawable, this.surroundings()))
        : null,
      scale,
      shown: count,
      total,
      leftOut: Math.max(0, count - MAX_FACETS),
      keep: 1,
      half: 1,
      level: Infinity,
      alpha: this.alphas.of(filter),
      round: null,
      milliseconds: performance.now() - started,
    };
    return this.drawing;
  }

  pick(ray: Ray): Picked | null {
    const surface = this.drawing?.surface;
    const hit = surface && firstHit(surface.positions, ray);
    return hit ? this.describe(surface.owners[hit.triangle], hit, surface.positions) : null;
  }

  /** Describes a triangle, which the pointer is at in a place of the drawing. */
  private describe(index: number, hit: Hit, drawn: Float32Array): Picked {
    const { triangles, halfedges } = this.mesh;
    const { volume, circumradius, radiusRatio } = this.measured;
    const vertices = [...triangles.subarray(3 * index, 3 * index + 3)];
    const { center, scale } = this.frame;
    const { heights } = this.about;
    return {
      index,
      vertices,
      place: placeOf(drawn, hit)
        .slice(0, 2)
        .map((x, axis) => center[axis] + x / scale),
      // Corners are drawn the other way round.
      height:
        heights &&
        hit.weights.reduce((sum, w, corner) => sum + w * heights[vertices[2 - corner]], 0),
      neighbors: [...halfedges.subarray(3 * index, 3 * index + 3)].map((e) =>
        e < 0 ? -1 : Math.floor(e / 3),
      ),
      volume: volume[index],
      circumradius: circumradius[index],
      radiusRatio: radiusRatio[index],
      phase: null,
      outline: outlineOf(cornersOf(this.positions, vertices)),
    };
  }

  /** Two ends an edge. Where all points are collinear, the way from the first to the last. */
  hull(): Float32Array {
    const { hull, dimension } = this.mesh;
    const edges = dimension === 2 ? hull.length : Math.max(0, hull.length - 1);
    const ends = new Uint32Array(2 * edges);
    for (let i = 0; i < edges; i++) {
      ends[2 * i] = hull[i];
      ends[2 * i + 1] = hull[(i + 1) % hull.length];
    }
    return cornersOf(this.positions, ends);
  }

  private surroundings(): Box {
    const low: [number, number] = [Infinity, Infinity];
    const high: [number, number] = [-Infinity, -Infinity];
    for (let i = 0; i < this.positions.length; i += 3) {
      for (const axis of [0, 1]) {
        low[axis] = Math.min(low[axis], this.positions[i + axis]);
        high[axis] = Math.max(high[axis], this.positions[i + axis]);
      }
    }
    const margin = MARGIN * Math.max(high[0] - low[0], high[1] - low[1]);
    return { low: [low[0] - margin, low[1] - margin], high: [high[0] + margin, high[1] + margin] };
  }

  private get measured(): Measures {
    return (this.measures ??= measureTriangles(this.points, this.mesh.triangles));
  }
}

/** A triangle's edges and its circumcircle. */
function outlineOf(corners: Float32Array): Float32Array {
  const [ax, ay, , bx, by, , cx, cy] = corners;
  const [ux, uy, vx, vy] = [bx - ax, by - ay, cx - ax, cy - ay];
  const twice = 2 * (ux * vy - uy * vx);
  const [uu, vv] = [ux * ux + uy * uy, vx * vx + vy * vy];
  const [x, y] = [(vy * uu - uy * vv) / twice, (ux * vv - vx * uu) / twice];
  const radius = Math.hypot(x, y);
  const around = Array.from({ length: CIRCLE_STEPS + 1 }, (_, i) => {
    const angle = (2 * Math.PI * i) / CIRCLE_STEPS;
    return [ax + x + radius * Math.cos(angle), ay + y + radius * Math.sin(angle), 0];
  });
  const circle = around.slice(1).flatMap((to, i) => [...around[i], ...to]);
  return Float32Array.from([
    ...cornersOf(corners, [0, 1, 1, 2, 2, 0]),
    ...(Number.isFinite(radius) ? circle : []),
  ]);
}
