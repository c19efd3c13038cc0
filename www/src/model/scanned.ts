import type { Mesh3, Surface3 } from 'gdel-wasm';
import { type Frame, toFrame } from '../geometry/mesh';
import { cornersOf, neighborsOf, Triples } from '../geometry/neighbors';
import { detectUp, type Up } from '../geometry/up';
import type { About } from './about';
import { Body } from './body';
import type { SurfaceMesh } from './surfaceFiles';

/** What the page says of the surface of a scan. */
export interface Found {
  triangles: number;
  volume: number;
  area: number;
  components: number;
  genus: number;
  /** How many points were left out because they are far from all others. */
  isolated: number;
  /** Whether points were moved because they are noisy. */
  smoothed: boolean;
  /** Whether it has no boundary; without, it is a scan from one side, or terrain. */
  closed: boolean;
  /** Whether the points seem to be a scan of it. */
  suits: boolean;
}

/** At least so many of the points lie on the surface that they were taken from. */
const ON_SURFACE = 0.8;

/** If more of a surface closes gaps, the points are no scan of something closed. */
const GAPS = 0.25;

/** Triangles whose edges are so many times as long as is usual close gaps. */
const WIDE = 8;

/** The surface of a scan, and its solid. */
export class Scanned {
  readonly found: Found;
  /** The tetrahedra of the solid. */
  readonly body: Body;
  /** Of an open surface, the facets of the body that belong to it: 1. All that bound it of a closed one: null. */
  readonly facets: Uint8Array | null;

  private constructor(
    readonly surface: Surface3,
    suits: boolean,
    points: Float32Array | Float64Array,
    positions: Float32Array,
    frame: Frame,
  ) {
    const { triangles, volume, area, components, genus, isolated, moved, closed } = surface;
    const solid = surface.solid!;
    this.found = {
      ...{ triangles: triangles.length / 3, volume, area, components, genus, isolated },
      smoothed: moved !== null,
      closed,
      suits,
    };
    this.body = new Body(
      moved ?? points,
      moved ? toFrame(moved, frame) : positions,
      solid,
      neighborsOf(solid),
    );
    this.facets = closed ? null : facetsOf(surface, this.body);
  }

  static async of(
    mesh: Mesh3,
    points: Float32Array | Float64Array,
    positions: Float32Array,
    frame: Frame,
    about: About,
    signal: AbortSignal,
  ): Promise<Scanned> {
    const { normals, sensors } = about;
    const evidence = { normals: normals ?? undefined, sensors: sensors ?? undefined };
    const find = (up?: number[]) =>
      mesh.surface({ ...evidence, up, open: 'auto', solid: true, signal });
    let surface = await find();
    let isScan = isOn(surface) && !(surface.closed && closesGaps(surface));
    if (isOn(surface) && (!isScan || surface.evidence === 'guess')) {
      // Of the ground as seen from above or from a tripod, what is below is solid.
      const open = await find(vectorOf(detectUp(points, about.up)));
      if (isOn(open) && !open.closed && (isScan || !closesGaps(open)))
        [surface, isScan] = [open, true];
    }
    return new Scanned(surface, isScan, points, positions, frame);
  }

  /** Triangles of the vertices, in the colours of their points. */
  triangles(rgb: Uint8Array | null): SurfaceMesh {
    const { vertices, sources, triangles } = this.surface;
    const colors = rgb && new Uint8Array(3 * sources.length);
    if (rgb && colors) {
      // A vertex in the middle of an edge is no point: it takes the colour of the one before it.
      let point = 0;
      for (const [v, source] of sources.entries()) {
        if (source >= 0) point = source;
        colors.set(rgb.subarray(3 * point, 3 * point + 3), 3 * v);
      }
    }
    return { points: vertices, colors, triangles };
  }
}

/** Whether points were taken from the surface: of those that fill a volume, hardly any are on it. */
function isOn({ sides, triangles }: Surface3): boolean {
  let on = 0;
  for (const side of sides) if (side === 1) on++;
  return triangles.length > 0 && on >= ON_SURFACE * sides.length;
}

/** Whether much of the surface is of triangles that are far larger than most. */
function closesGaps({ triangles, vertices }: Surface3): boolean {
  const count = triangles.length / 3;
  const [longest, areas] = [new Float64Array(count), new Float64Array(count)];
  const edge = (from: number, to: number) =>
    [0, 1, 2].map((axis) => vertices[3 * to + axis] - vertices[3 * from + axis]);
  for (let t = 0; t < count; t++) {
    const [a, b, c] = triangles.subarray(3 * t, 3 * t + 3);
    const [u, v, w] = [edge(a, b), edge(a, c), edge(b, c)];
    longest[t] = Math.max(...[u, v, w].map((edge) => Math.hypot(...edge)));
    areas[t] = Math.hypot(
      u[1] * v[2] - u[2] * v[1],
      u[2] * v[0] - u[0] * v[2],
      u[0] * v[1] - u[1] * v[0],
    );
  }
  const usual = longest.slice().sort()[count >> 1];
  let [wide, all] = [0, 0];
  for (let t = 0; t < count; t++) {
    all += areas[t];
    if (longest[t] > WIDE * usual) wide += areas[t];
  }
  return wide > GAPS * all;
}

/** The direction of an axis. */
function vectorOf(axis: Up): number[] {
  const sign = axis.startsWith('-') ? -1 : 1;
  return ['x', 'y', 'z'].map((each) => (axis.endsWith(each) ? sign : 0));
}

/** Finds the facets of a body that are triangles of an open surface. */
function facetsOf({ triangles, sources }: Surface3, { tetrahedra, neighbors }: Body): Uint8Array {
  const there = new Triples(triangles.length / 3);
  for (let t = 0; t < triangles.length; t += 3)
    there.add(sources[triangles[t]], sources[triangles[t + 1]], sources[triangles[t + 2]]);
  return Uint8Array.from(neighbors, (across, facet) =>
    across < 0 && there.has(...cornersOf(tetrahedra, facet)) ? 1 : 0,
  );
}
