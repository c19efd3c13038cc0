import type { Filter, FilterKind } from '../geometry/filter';
import type { Measures } from '../geometry/measures';
import type { Frame } from '../geometry/mesh';
import { carvingRadii, criticalStops, solidRadius, spacingOf } from '../geometry/solid';
import type { Drawing } from './model';

/** As many stops of the slider as a hand can tell apart. */
const STOPS = 1000;

/** From which alpha on each simplex is shown, and which alpha suits: worked out when asked for. */
export class AlphaRadii {
  private carving: Float32Array | null = null;
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
  ) {}

  /** Returns the radii that a filter compares with alpha; null where it keeps everything. */
  radii(kind: FilterKind): Float32Array | null {
    if (kind === 'all' || kind === 'surface') return null;
    if (kind === 'alpha') return this.measured().circumradius;
    this.carving ??= carvingRadii(this.points, this.simplices, this.neighbors);
    return this.carving;
  }

  /** The alpha of a filter, and the critical ones from the spacing to everything. */
  of({ kind, alpha }: Filter): Drawing['alpha'] {
    const radii = this.radii(kind);
    if (!radii) return null;
    const { simplices, dimension } = this;
    const bounding = 1 / this.frame.scale;
    this.spacing ??= spacingOf(this.points, simplices, dimension);
    const suits = (this.suiting[kind] ??= Math.min(
      solidRadius(radii, this.measured().volume, simplices, dimension),
      bounding,
    ));
    const range: [number, number] = [
      Math.min(this.spacing || suits, suits),
      Math.max(bounding, suits),
    ];
    this.stops[kind] ??= criticalStops(radii, range, STOPS);
    return { value: alpha ?? suits, isAuto: alpha === null, stops: this.stops[kind] };
  }
}
