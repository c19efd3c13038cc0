import type { AlphaShape, Mesh2, Mesh3 } from 'gdel-wasm';
import { type Filter, type FilterKind, upTo } from '../geometry/filter';
import type { Measures } from '../geometry/measures';
import type { Frame } from '../geometry/mesh';
import { carvingRadii, criticalStops, solidRadius, spacingOf } from '../geometry/solid';
import type { Drawing } from './model';

/** As many stops of the slider as a hand can tell apart. */
const STOPS = 1000;

/** Asks the package for the radius that suits a mesh, and for the simplices up to it. */
type Asker = (signal?: AbortSignal) => Promise<Pick<AlphaShape, 'alpha' | 'solid'>>;

/** Returns what asks the package about a mesh; null of weighted points and polygons, which have no alpha shape there. */
export function askerFor(mesh: Mesh2 | Mesh3): Asker | null {
  if (mesh.weights || ('constraints' in mesh && mesh.constraints)) return null;
  return (signal) => mesh.alphaShape({ alpha: 'auto', signal });
}

/** From which alpha on each simplex is shown, and which alpha suits: worked out when asked for. */
export class AlphaRadii {
  private carving: Float32Array | null = null;
  /** What the package says of the filter `alpha`: the radius, and one byte a simplex, 1 up to it. */
  private found: { alpha: number; kept: Uint8Array } | null = null;
  private finding: Promise<void> | null = null;
  private readonly suiting: Partial<Record<FilterKind, number>> = {};
  private readonly stops: Partial<Record<FilterKind, Float32Array>> = {};
  private spacing: number | null = null;

  constructor(
    private readonly points: ArrayLike<number>,
    private readonly simplices: Uint32Array,
    /** The simplex across the facet opposite, or after, each vertex; -1 is outside. */
    private readonly neighbors: Int32Array,
    private readonly dimension: 2 | 3,
    private readonly frame: Frame,
    private readonly measured: () => Measures,
    private readonly ask: Asker | null,
  ) {}

  /** Finds the alpha that suits a filter, if that is wanted and takes the package. */
  async prepare({ kind, alpha }: Filter, signal?: AbortSignal): Promise<void> {
    if (kind !== 'alpha' || alpha !== null || !this.ask || this.found) return;
    this.finding ??= this.find(this.ask, signal);
    try {
      await this.finding;
    } finally {
      // After an abort, it may be asked for again.
      this.finding = null;
    }
  }

  private async find(ask: Asker, signal?: AbortSignal): Promise<void> {
    const { alpha, solid } = await ask(signal);
    const kept = new Uint8Array(this.simplices.length / (this.dimension + 1));
    for (const t of solid) kept[t] = 1;
    this.found = { alpha, kept };
    // They may reach further now.
    delete this.stops.alpha;
  }

  /** Returns the radii that a filter compares with alpha; null where it keeps everything. */
  radii(kind: FilterKind): Float32Array | null {
    if (kind === 'all' || kind === 'surface') return null;
    if (kind === 'alpha') return this.measured().circumradius;
    this.carving ??= carvingRadii(this.points, this.simplices, this.neighbors);
    return this.carving;
  }

  /** One byte a simplex: 1 for those that a filter keeps. Null where it keeps every one. */
  kept(filter: Filter): Uint8Array | null {
    const { kind, alpha } = filter;
    const radii = this.radii(kind);
    if (!radii || alpha === 'any') return null;
    // The package compares exactly, also flat simplices, whose radii cannot be measured well.
    if (kind === 'alpha' && alpha === null && this.found) return this.found.kept;
    return upTo(radii, this.of(filter)!.value);
  }

  /** The alpha of a filter, and the critical ones from the spacing to everything. */
  of({ kind, alpha }: Filter): Drawing['alpha'] {
    const radii = this.radii(kind);
    if (!radii) return null;
    const bounding = 1 / this.frame.scale;
    const suits = this.suits(kind, radii, bounding);
    this.spacing ??= spacingOf(this.points, this.simplices, this.dimension);
    // Rounded as radii are, so that those that are equal to it are in the range.
    const end = Math.fround(suits ?? bounding);
    const range: [number, number] = [Math.min(this.spacing || end, end), Math.max(bounding, end)];
    this.stops[kind] ??= criticalStops(radii, range, STOPS);
    const value = alpha === 'any' ? Infinity : (alpha ?? suits ?? Infinity);
    return { value, isAuto: typeof alpha !== 'number', stops: this.stops[kind] };
  }

  /** The alpha that suits a filter: what the package found, else a rule of the page. Null until it is found. */
  private suits(kind: FilterKind, radii: Float32Array, bounding: number): number | null {
    if (kind === 'alpha' && this.ask) return this.found?.alpha ?? null;
    return (this.suiting[kind] ??= Math.min(
      solidRadius(radii, this.measured().volume, this.simplices, this.dimension),
      bounding,
    ));
  }
}
