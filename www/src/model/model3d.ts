import type { Mesh3, RunOptions, Triangulator, VoronoiArrays } from 'gdel-wasm';
import { surfaceOfCells } from '../geometry/cells';
import { type CutOf, type CutPart, colorBytes, filterBytes, inOrder } from '../geometry/cut';
import { type Filter, type Kept, keep } from '../geometry/filter';
import { circumcenter, measure } from '../geometry/measures';
import { FACETS, type Frame, frameOf, toFrame } from '../geometry/mesh';
import { firstHit, placeOf, type Ray } from '../geometry/pick';
import { outermost, piecesOf, trianglesOf } from '../geometry/pieces';
import { heightsAlong, keepOf, levelOf, type Plane, spreadAlong } from '../geometry/plane';
import { mapping, positionOn, QUALITY, scaleFor, scaleOf } from '../geometry/scale';
import { boundaryOf, type Surface, surfaceOf } from '../geometry/surface';
import { detectUp, poseFor } from '../geometry/up';
import type { About } from './about';
import { AlphaRadii, askerFor } from './alpha';
import { Body, cutOf } from './body';
import {
  cornersOf,
  type Drawing,
  type DrawRequest,
  MAX_CELLS,
  MAX_FACETS,
  MAX_PIECES,
  type Model,
  type Picked,
  type Prepared,
  type Summary,
} from './model';
import { type Found, Scanned } from './scanned';
import type { SurfaceMesh } from './surfaceFiles';

/** The corners of a tetrahedron's edges. */
const EDGES = [0, 1, 0, 2, 0, 3, 1, 2, 1, 3, 2, 3];

/** The model of 3D points. */
export class Model3d implements Model {
  readonly positions: Float32Array;
  /** The tetrahedra of the mesh. */
  private readonly whole: Body;
  private readonly created: Uint8Array | null;
  private scanned: Scanned | null = null;
  private finding: Promise<Found> | null = null;
  private readonly alphas: AlphaRadii;
  /** What the last drawing is of. */
  private drawn: Body;
  private filtered: { filter: Filter; kept: Kept } | null = null;
  private drawing: Drawing | null = null;
  /** What the last drawing consists of, where that is a cut mesh. */
  private last: {
    cut: CutOf;
    body: Body;
    kept: Kept;
    normal: Plane['normal'];
    value: (t: number) => number;
    /** Makes the surface. */
    surface: () => Surface;
  } | null = null;
  private diagram: VoronoiArrays | null = null;

  private constructor(
    readonly points: Float32Array | Float64Array,
    readonly mesh: Mesh3,
    readonly frame: Frame,
    readonly about: About,
  ) {
    this.positions = toFrame(points, frame);
    this.whole = new Body(points, this.positions, mesh.tetrahedra, mesh.neighbors);
    this.drawn = this.whole;
    this.created = mesh.trace?.created ?? null;
    this.alphas = new AlphaRadii(
      points,
      mesh.tetrahedra,
      mesh.neighbors,
      3,
      frame,
      () => this.whole.measured,
      askerFor(mesh),
    );
  }

  static async make(
    triangulator: Triangulator,
    points: Float32Array | Float64Array,
    options: RunOptions,
    about: About,
    frame?: Frame,
  ): Promise<Model3d> {
    const mesh = await triangulator.delaunay3d(points, options);
    return Model3d.of(mesh, points, about, frame ?? frameOf(points));
  }

  static of(mesh: Mesh3, points: Float32Array | Float64Array, about: About, frame: Frame): Model3d {
    return new Model3d(points, mesh, frame, about);
  }

  summary(): Summary {
    const { mesh, points, frame, about } = this;
    const up = detectUp(points, about.up);
    let duplicates = 0;
    for (const stand of mesh.duplicateOf) if (stand >= 0) duplicates++;
    return {
      dimension: 3,
      affineDimension: mesh.dimension,
      points: points.length / 3,
      duplicates,
      noReturn: about.noReturn,
      onFaces: about.onFaces,
      colorSource: about.colors?.source ?? null,
      simplices: mesh.tetrahedra.length / 4,
      hullFacets: mesh.hull.length / 3,
      stats: mesh.stats,
      frame,
      up,
      home: poseFor(this.positions, up),
      trace: mesh.trace
        ? {
            rounds: mesh.trace.rounds.length,
            nonDelaunayFacets: mesh.trace.nonDelaunayFacets.length / 3,
            repaired: missing(mesh.trace.nonDelaunayFacets, mesh.tetrahedra),
            splayed: mesh.trace.created.reduce((sum, phase) => sum + phase, 0),
          }
        : null,
    };
  }

  /** Finds the surface that the points were taken from. */
  findSurface(signal: AbortSignal): Promise<Found> {
    const { mesh, points, positions, frame, about } = this;
    const making = () => Scanned.of(mesh, points, positions, frame, about, signal);
    const finding = (this.finding ??= making().then((scanned) => (this.scanned = scanned).found));
    // After an abort, it may be asked for again.
    finding.catch(() => (this.finding = null));
    return finding;
  }

  /** The surface that {@link findSurface} has found. */
  get foundSurface(): Scanned | null {
    return this.scanned;
  }

  async prepare({ filter, cells = null }: Prepared, signal?: AbortSignal): Promise<void> {
    await this.alphas.prepare(filter, signal);
    if (cells !== null && this.points.length / 3 <= MAX_CELLS)
      this.diagram ??= await this.mesh.voronoi({ clip: 'hull' });
  }

  draw(request: DrawRequest): Drawing {
    const { round, cells = null } = request;
    this.last = null;
    this.drawn = this.whole;
    this.drawing =
      round !== null
        ? this.drawRound(request, round)
        : cells !== null && this.diagram
          ? this.drawCells(request, this.diagram, cells)
          : request.pointsOnly
            ? this.drawPoints(request)
            : this.drawResult(request);
    return this.drawing;
  }

  /** The cells of the points below the cutting plane, coloured by their volume. */
  private drawCells({ plane }: DrawRequest, diagram: VoronoiArrays, apart: number): Drawing {
    const started = performance.now();
    const { positions, frame } = this;
    const spread = this.whole.spreadAlong(plane.normal);
    const level = levelOf(plane, spread);
    const [nx, ny, nz] = plane.normal;
    const kept = new Uint8Array(positions.length / 3);
    let [shown, total] = [0, 0];
    for (let v = 0, p = 0; v < kept.length; v++, p += 3) {
      if (diagram.cells[v] === diagram.cells[v + 1]) continue;
      total++;
      if (nx * positions[p] + ny * positions[p + 1] + nz * positions[p + 2] > level) continue;
      kept[v] = 1;
      shown++;
    }
    const volumes = Float32Array.from(diagram.volumes);
    const scale = scaleOf('volume', volumes, kept);
    const value = positionOn(scale, volumes);
    return {
      surface: surfaceOfCells({ diagram, frame, positions, kept, apart }, value),
      pieces: null,
      voronoi: null,
      scale,
      shown,
      total,
      leftOut: 0,
      keep: keepOf(plane, spread),
      half: keepOf({ ...plane, keep: null }, spread),
      level,
      alpha: null,
      cells: true,
      round: null,
      milliseconds: performance.now() - started,
    };
  }

  /** The points, until the surface that they were taken from is found. */
  private drawPoints({ plane }: DrawRequest): Drawing {
    const started = performance.now();
    const spread = this.whole.spreadAlong(plane.normal);
    return {
      surface: null,
      pieces: null,
      voronoi: null,
      scale: QUALITY,
      shown: 0,
      total: this.mesh.tetrahedra.length / 4,
      leftOut: 0,
      keep: keepOf(plane, spread),
      half: keepOf({ ...plane, keep: null }, spread),
      level: -Infinity,
      alpha: null,
      round: null,
      milliseconds: performance.now() - started,
    };
  }

  private drawResult(request: DrawRequest): Drawing {
    const { filter, plane, color, skin, pieces, onGpu = false } = request;
    const started = performance.now();
    const body = (this.drawn = this.bodyOf(filter));
    const kept = this.keptBy(filter);
    const spread = body.spreadAlong(plane.normal);
    const level = levelOf(plane, spread);
    // Of what is not cut, nobody has to know how high it is.
    const heights = level < Infinity ? body.heightsAlong(plane.normal) : null;
    const boundary = boundaryOf(body, kept, heights, level);
    const open = body === this.whole ? null : this.scanned!.facets;
    if (open) boundary.facets = boundary.facets.filter((facet) => open[facet] === 1);
    const created = body === this.whole ? this.created : null;
    const by = color === 'phase' && !created ? 'quality' : color;
    const scale = scaleFor(by, body, kept.kept);
    const value = mapping(scale, body, created);
    const outside = skin ? { kept: kept.kept, colors: this.about.colors?.rgb ?? null } : null;
    const surface = () => {
      const facets = boundary.facets.subarray(0, MAX_FACETS);
      const isEarly = by === 'quality' && !body.isMeasured;
      return surfaceOf(body, facets, isEarly ? qualitiesAt(facets, body) : value, outside);
    };
    const cut = cutOf(body, request, scale, spread);
    if (!pieces) this.last = { cut, body, kept, normal: plane.normal, value, surface };
    return {
      surface: pieces || (onGpu && !open) ? null : surface(),
      // The GPU would list what an open surface is closed by.
      ...(pieces || open ? {} : { cut }),
      open: open !== null,
      pieces: pieces
        ? piecesOf(
            body,
            outermost(body, kept, heights, level, boundary, MAX_PIECES),
            value,
            outside,
          )
        : null,
      voronoi: null,
      scale,
      shown: boundary.shown,
      total: this.mesh.tetrahedra.length / 4,
      leftOut: pieces ? 0 : Math.max(0, boundary.facets.length - MAX_FACETS),
      keep: keepOf(plane, spread),
      half: keepOf({ ...plane, keep: null }, spread),
      level,
      alpha: this.alphas.of(filter),
      round: null,
      milliseconds: performance.now() - started,
    };
  }

  /** A round of the trace: whole tetrahedra, for it has no neighbours. */
  private drawRound({ plane, color }: DrawRequest, round: number): Drawing {
    const started = performance.now();
    const { tetrahedra } = this.mesh.trace!.rounds[round];
    const measured = measure(this.points, tetrahedra);
    const mesh = {
      positions: this.positions,
      tetrahedra,
      neighbors: new Int32Array(tetrahedra.length).fill(-1),
    };
    const spread = spreadAlong(plane.normal, this.positions);
    const level = levelOf(plane, spread);
    const heights = heightsAlong(plane.normal, mesh);
    const owners = Uint32Array.from(heights.height.keys())
      .filter((t) => heights.height[t] <= level)
      .slice(0, MAX_PIECES);
    const scale = scaleFor(
      color === 'phase' ? 'quality' : color,
      { measured },
      new Uint8Array(tetrahedra.length / 4).fill(1),
    );
    return {
      surface: null,
      pieces: piecesOf(mesh, owners, mapping(scale, { measured }, null), null),
      voronoi: null,
      scale,
      shown: owners.length,
      total: tetrahedra.length / 4,
      leftOut: 0,
      keep: keepOf(plane, spread),
      half: keepOf({ ...plane, keep: null }, spread),
      level,
      alpha: null,
      round,
      milliseconds: performance.now() - started,
    };
  }

  pick(ray: Ray, apart: number): Picked | null {
    // The owners of cells are points.
    if (!this.drawing || this.drawing.cells) return null;
    const { pieces } = this.drawing;
    const surface = this.drawnSurface();
    const triangles = surface?.positions ?? (pieces && trianglesOf(pieces, apart));
    const hit = triangles && firstHit(triangles, ray);
    if (!hit) return null;
    const place = placeOf(triangles, hit);
    return surface
      ? this.describe(surface.owners[hit.triangle], 0, place)
      : this.describe(pieces!.owners[hit.triangle >> 2], apart, place);
  }

  /** Describes a tetrahedron, which the pointer is at in a place of the drawing. */
  private describe(index: number, apart: number, drawn: number[]): Picked {
    const { tetrahedra, neighbors, positions, measured } = this.drawn;
    const vertices = [...tetrahedra.subarray(4 * index, 4 * index + 4)];
    const corners = cornersOf(positions, vertices);
    const { center, scale } = this.frame;
    const place = [0, 0, 0];
    for (let axis = 0; axis < 3; axis++) {
      const move =
        (apart * (corners[axis] + corners[3 + axis] + corners[6 + axis] + corners[9 + axis])) / 4;
      for (let k = 0; k < 4; k++)
        corners[3 * k + axis] = (corners[3 * k + axis] + move) / (1 + apart);
      place[axis] = center[axis] + (drawn[axis] * (1 + apart) - move) / scale;
    }
    return {
      index,
      vertices,
      place,
      height: null,
      neighbors: [...neighbors.subarray(4 * index, 4 * index + 4)],
      volume: measured.volume[index],
      circumradius: measured.circumradius[index],
      radiusRatio: measured.radiusRatio[index],
      phase: this.created && this.drawn === this.whole ? (this.created[index] ? 2 : 1) : null,
      outline: withSphere(cornersOf(corners, EDGES), corners),
    };
  }

  hull(): Float32Array {
    return cornersOf(this.positions, this.mesh.hull);
  }

  drawnSurface(): Surface | null {
    const { drawing, last } = this;
    if (drawing && last) drawing.surface ??= last.surface();
    return drawing?.surface ?? null;
  }

  cutPart(
    part: CutPart,
    contents: string,
    from: number,
    to: number,
  ): ArrayBufferView<ArrayBuffer> | null {
    const { last } = this;
    if (last?.cut.parts[part] !== contents) return null;
    const { body, kept, normal, value } = last;
    const { positions } = body;
    switch (part) {
      case 'tetrahedra':
        return body.tetrahedra.slice(4 * from, 4 * to);
      case 'neighbors':
        return body.neighbors.slice(4 * from, 4 * to);
      case 'heights':
        return inOrder(body.heightsAlong(normal).height.subarray(from, to));
      case 'filtered':
        return filterBytes(kept.kept.subarray(from, to), kept.rim.subarray(from, to));
      case 'values':
        return valuesOf(value, from, to);
      case 'positions':
        return positions.slice(3 * from, 3 * to);
      case 'colors':
        return colorBytes(this.about.colors?.rgb ?? null, from, to);
    }
  }

  /** The surface of what a filter keeps, uncut, in the units of the input. */
  surface(filter: Filter): SurfaceMesh {
    const colors = this.about.colors?.rgb ?? null;
    if (filter.kind === 'surface' && this.scanned) return this.scanned.triangles(colors);
    const { facets } = boundaryOf(this.whole, this.keptBy(filter), null, Infinity);
    const { tetrahedra } = this.mesh;
    const triangles = new Uint32Array(3 * facets.length);
    for (let i = 0; i < facets.length; i++) {
      const [t, k] = [facets[i] >>> 2, facets[i] & 3];
      for (let j = 0; j < 3; j++) triangles[3 * i + j] = tetrahedra[4 * t + FACETS[3 * k + j]];
    }
    return { points: this.points, colors, triangles };
  }

  /** The facets that were not locally Delaunay after Phase 1, nine coordinates each. */
  nonDelaunayFacets(): Float32Array {
    return cornersOf(this.positions, this.mesh.trace?.nonDelaunayFacets ?? new Uint32Array());
  }

  /** The tetrahedra that a filter chooses from. */
  private bodyOf({ kind }: Filter): Body {
    return (kind === 'surface' && this.scanned?.body) || this.whole;
  }

  private keptBy(filter: Filter): Kept {
    if (JSON.stringify(this.filtered?.filter) !== JSON.stringify(filter)) {
      const kept = keep(this.alphas.kept(filter), this.bodyOf(filter).neighbors);
      this.filtered = { filter, kept };
    }
    return this.filtered!.kept;
  }
}

/** The positions of some tetrahedra on the colour scale. */
function valuesOf(
  value: (t: number) => number,
  from: number,
  to: number,
): Float32Array<ArrayBuffer> {
  const values = new Float32Array(to - from);
  for (let i = 0; i < values.length; i++) values[i] = value(from + i);
  return values;
}

/**
 * The quality of the tetrahedra of some facets, by the numbers of these: it is there long before all
 * tetrahedra of a large mesh are measured.
 */
function qualitiesAt(
  facets: Uint32Array,
  { points, tetrahedra }: Body,
): (t: number, i: number) => number {
  const corners = new Uint32Array(4 * facets.length);
  for (let i = 0; i < facets.length; i++) {
    const t = 4 * (facets[i] >>> 2);
    for (let k = 0; k < 4; k++) corners[4 * i + k] = tetrahedra[t + k];
  }
  const { radiusRatio } = measure(points, corners);
  return (_, i) => radiusRatio[i];
}

/** How large a sphere may be, in units of the frame, to be drawn with its tetrahedron. */
const MAX_SPHERE = 1.2;

/** Adds three great circles of the sphere through four corners: no point is inside it. */
function withSphere(lines: Float32Array, corners: Float32Array): Float32Array {
  const center = circumcenter(corners);
  const radius = Math.hypot(...center.map((x, axis) => x - corners[axis]));
  if (!(radius < MAX_SPHERE)) return lines;
  const steps = 64;
  const all = new Float32Array(lines.length + 3 * steps * 6);
  all.set(lines);
  let at = lines.length;
  for (let axis = 0; axis < 3; axis++) {
    for (let step = 0; step < steps; step++) {
      for (const end of [step, step + 1]) {
        const angle = (2 * Math.PI * end) / steps;
        all[at + axis] = center[axis];
        all[at + ((axis + 1) % 3)] = center[(axis + 1) % 3] + radius * Math.cos(angle);
        all[at + ((axis + 2) % 3)] = center[(axis + 2) % 3] + radius * Math.sin(angle);
        at += 3;
      }
    }
  }
  return all;
}

/** How many of some triangles are facets of no tetrahedron. */
function missing(triangles: Uint32Array, tetrahedra: Uint32Array): number {
  const key = (a: number, b: number, c: number) => [a, b, c].sort((p, q) => p - q).join();
  const corners = new Set(triangles);
  const left = new Set<string>();
  for (let i = 0; i < triangles.length; i += 3)
    left.add(key(triangles[i], triangles[i + 1], triangles[i + 2]));
  for (let t = 0; t < tetrahedra.length; t += 4) {
    for (let k = 0; k < 12; k += 3) {
      const [a, b, c] = [
        tetrahedra[t + FACETS[k]],
        tetrahedra[t + FACETS[k + 1]],
        tetrahedra[t + FACETS[k + 2]],
      ];
      if (corners.has(a) && corners.has(b) && corners.has(c)) left.delete(key(a, b, c));
    }
  }
  return left.size;
}
