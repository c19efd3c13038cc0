import type { Mesh3, Surface3 } from 'gdel-wasm';
import { type Frame, toFrame } from '../geometry/mesh';
import { neighborsOf } from '../geometry/neighbors';
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
  /** Whether the points seem to be a scan of it. */
  suits: boolean;
}

/** At least so many of the points lie on the surface that they were taken from. */
const ON_SURFACE = 0.8;

/** At most so much of the surface closes gaps. */
const GAPS = 0.25;

/** Triangles whose edges are so many times as long as is usual close gaps. */
const WIDE = 8;

/** The closed surface of a scan, and its solid. */
export class Scanned {
  readonly found: Found;
  /** The tetrahedra of the solid. */
  readonly body: Body;

  private constructor(
    readonly surface: Surface3,
    points: Float32Array | Float64Array,
    positions: Float32Array,
    frame: Frame,
  ) {
    const { triangles, volume, area, components, genus, isolated, moved } = surface;
    const solid = surface.solid!;
    this.found = {
      ...{ triangles: triangles.length / 3, volume, area, components, genus, isolated },
      smoothed: moved !== null,
      suits: suits(surface),
    };
    this.body = new Body(
      moved ?? points,
      moved ? toFrame(moved, frame) : positions,
      solid,
      neighborsOf(solid),
    );
  }

  static async of(
    mesh: Mesh3,
    points: Float32Array | Float64Array,
    positions: Float32Array,
    frame: Frame,
    signal: AbortSignal,
  ): Promise<Scanned> {
    const surface = await mesh.surface({ solid: true, signal });
    return new Scanned(surface, points, positions, frame);
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

/**
 * Whether points were taken from a surface: nearly all are on it, and little of it closes gaps.
 * Points that fill a volume have hardly any on the surface; of a scan from one side, half of it
 * closes the other.
 */
function suits({ sides, triangles, vertices }: Surface3): boolean {
  let on = 0;
  for (const side of sides) if (side === 1) on++;
  if (triangles.length === 0 || on < ON_SURFACE * sides.length) return false;
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
  return wide <= GAPS * all;
}
