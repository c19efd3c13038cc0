import type { Measures } from './measures';

export type ColorBy = 'quality' | 'volume' | 'circumradius' | 'phase';

/** What has measures, which are worked out when they are asked for. */
export interface Measured {
  readonly measured: Measures;
}

/** How a quantity is laid out on the colour map. */
export interface ColorScale {
  by: ColorBy;
  /** The values at the two ends of the map; what lies beyond has the end's colour. */
  domain: [number, number];
  kind: 'linear' | 'log' | 'phases';
}

/** The scale for quality. */
export const QUALITY: ColorScale = { by: 'quality', domain: [0, 1], kind: 'linear' };

/**
 * The scale for a quantity of the tetrahedra that a filter keeps: quality from 0 to 1, lengths and
 * volumes from the 1st to the 99th percentile, by logarithm.
 */
export function scaleFor(by: ColorBy, of: Measured, kept: Uint8Array): ColorScale {
  if (by === 'quality') return QUALITY;
  if (by === 'phase') return { by, domain: [0, 1], kind: 'phases' };
  return scaleOf(by, of.measured[by], kept);
}

/** The scale for lengths and volumes of what is kept: from the 1st to the 99th percentile. */
export function scaleOf(
  by: 'volume' | 'circumradius',
  values: Float32Array,
  kept: Uint8Array,
): ColorScale {
  return { by, domain: percentiles(values, 0.01, 0.99, kept), kind: 'log' };
}

/**
 * From a tetrahedron to its position on the map, 0 to 1. `created`: 1 for those that Phase 2 made.
 */
export function mapping(
  scale: ColorScale,
  of: Measured,
  created: Uint8Array | null,
): (t: number) => number {
  const { by, kind } = scale;
  if (kind === 'phases') return (t) => (created?.[t] ? 1 : 0);
  if (by === 'quality') {
    let ratios: Float32Array | null = null;
    return (t) => (ratios ??= of.measured.radiusRatio)[t];
  }
  return positionOn(scale, of.measured[by === 'volume' ? 'volume' : 'circumradius']);
}

/** From an index of lengths or volumes to its position on the map, 0 to 1. */
export function positionOn(
  { domain: [low, high] }: ColorScale,
  values: Float32Array,
): (i: number) => number {
  // All are equal: in the middle, where shading shows.
  if (!(high > low)) return () => 0.5;
  const start = Math.log(low);
  const perStep = 1 / (Math.log(high) - start);
  return (i) => Math.min(1, Math.max(0, (Math.log(values[i]) - start) * perStep));
}

/** Two percentiles of the positive, finite values of a sample of those kept. */
export function percentiles(
  values: Float32Array,
  low: number,
  high: number,
  kept?: Uint8Array,
): [number, number] {
  const step = Math.max(1, Math.floor(values.length / 20_000));
  const sample: number[] = [];
  for (let i = 0; i < values.length; i += step) {
    if (values[i] > 0 && values[i] < Infinity && kept?.[i] !== 0) sample.push(values[i]);
  }
  if (sample.length === 0) return [1, 1];
  const sorted = Float32Array.from(sample).sort();
  const at = (share: number) =>
    sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
  return [at(low), at(high)];
}
