import type { Filter } from './geometry/filter';
import type { ColorBy } from './geometry/scale';
import type { Engine } from './model/model';
import { type Distribution, DISTRIBUTIONS, type Sample, SAMPLES, type Source } from './model/source';
import { COLOR_MAPS, type ColorMapName } from './view/colormap';
import type { CameraPose } from './view/viewer';

export type Up = 'y' | 'z';

export const LAYERS = ['tetrahedra', 'edges', 'points', 'hull', 'facets'] as const;
export type Layer = (typeof LAYERS)[number];

/** Everything that makes up a view, and so a link. */
export interface Settings {
  source: Source;
  engine: Engine;
  color: ColorBy;
  map: ColorMapName;
  filter: Filter['kind'];
  /** In units of the input; null for one that suits the points. */
  alpha: number | null;
  normal: [number, number, number];
  keep: number;
  /** The axis that points up. */
  up: Up;
  /** How far the tetrahedra are pulled apart: 0 not at all, 1 to half their size. */
  apart: number;
  layers: Record<Layer, boolean>;
  camera: CameraPose;
}

/** What suits a source: the carved solid of a scan, all of a synthetic cloud. */
export function filterFor(source: Source): Filter['kind'] {
  return source.kind === 'generator' ? 'all' : 'carve';
}

/** What tells most: inside a scan sizes differ by orders of magnitude, in a synthetic cloud shapes do. */
export function colorFor(source: Source): ColorBy {
  return source.kind === 'generator' ? 'quality' : 'circumradius';
}

/** Scans of the land have z up, models y. */
export function upFor(source: Source): Up {
  return source.kind === 'file' && /\.(las|laz|pcd|pts|xyz|asc|txt|csv|tsv)$/i.test(source.file.name) ? 'z' : 'y';
}

export const HOME: CameraPose = [0.5, 0.24, 2.85, 0, 0, 0];

/** What a visitor sees first. */
export function defaults(): Settings {
  return {
    source: { kind: 'sample', sample: 'bunny' },
    engine: 'auto',
    color: 'circumradius',
    map: 'viridis',
    filter: 'carve',
    alpha: null,
    normal: [0, 0, 1],
    keep: 0.5,
    up: 'y',
    apart: 0,
    layers: { tetrahedra: true, edges: true, points: true, hull: false, facets: false },
    camera: HOME,
  };
}

/** The part of the address after '#'. Only what differs from the defaults is in it, and never a file. */
export function toHash(settings: Settings): string {
  const start = defaults();
  const hash = new URLSearchParams();
  const { source } = settings;
  if (source.kind === 'sample') hash.set('points', source.sample);
  if (source.kind === 'generator') hash.set('points', [source.distribution, source.count, source.seed].join('_'));
  start.filter = filterFor(source);
  start.up = upFor(source);
  start.color = colorFor(source);
  for (const key of ['engine', 'color', 'map', 'filter', 'up'] as const) {
    if (settings[key] !== start[key]) hash.set(key, settings[key]);
  }
  if (settings.alpha !== null) hash.set('alpha', String(Number(settings.alpha.toPrecision(4))));
  const cut = list([...settings.normal, settings.keep]);
  if (cut !== list([...start.normal, start.keep])) hash.set('cut', cut);
  if (settings.apart !== 0) hash.set('apart', short(settings.apart));
  const layers = LAYERS.filter((layer) => settings.layers[layer]).join('_');
  if (layers !== LAYERS.filter((layer) => start.layers[layer]).join('_')) hash.set('layers', layers);
  const camera = list(settings.camera);
  if (camera !== list(start.camera)) hash.set('camera', camera);
  return hash.toString();
}

/** The settings in a hash. What is missing or makes no sense is as in the defaults: a link may come from anywhere. */
export function fromHash(hash: string): Settings {
  const settings = defaults();
  const given = new URLSearchParams(hash.replace(/^#/, ''));
  const choice = <T extends string>(key: string, of: readonly T[], otherwise: T) =>
    of.find((option) => option === given.get(key)) ?? otherwise;

  settings.source = sourceFrom(given.get('points')) ?? settings.source;
  settings.engine = choice('engine', ['auto', 'gpu', 'cpu'], settings.engine);
  settings.color = choice('color', ['quality', 'volume', 'circumradius', 'phase'], colorFor(settings.source));
  settings.map = choice('map', Object.keys(COLOR_MAPS) as ColorMapName[], settings.map);
  settings.filter = choice('filter', ['all', 'alpha', 'carve'], filterFor(settings.source));
  settings.up = choice('up', ['y', 'z'], upFor(settings.source));
  const alpha = Number(given.get('alpha'));
  if (alpha > 0 && alpha < Infinity) settings.alpha = alpha;
  const [nx, ny, nz, keep] = numbers(given.get('cut'), 4) ?? [...settings.normal, settings.keep];
  const length = Math.hypot(nx, ny, nz);
  if (length > 0) settings.normal = [nx / length, ny / length, nz / length];
  settings.keep = clamp(keep);
  settings.apart = clamp(Number(given.get('apart')));
  const layers = given.get('layers')?.split('_');
  if (layers) for (const layer of LAYERS) settings.layers[layer] = layers.includes(layer);
  const camera = numbers(given.get('camera'), 6);
  if (camera && camera[2] > 0) settings.camera = camera as CameraPose;
  return settings;
}

function sourceFrom(text: string | null): Source | null {
  if (!text) return null;
  if (Object.hasOwn(SAMPLES, text)) return { kind: 'sample', sample: text as Sample };
  const [distribution, count, seed] = text.split('_');
  const points = Number(count);
  if (!Object.hasOwn(DISTRIBUTIONS, distribution) || !Number.isSafeInteger(points) || points < 1 || points > MOST_POINTS) return null;
  const start = Number(seed);
  return {
    kind: 'generator',
    distribution: distribution as Distribution,
    count: points,
    seed: Number.isSafeInteger(start) && start >= 0 ? start : 0,
  };
}

/** More points than this would be asking a browser for trouble. */
export const MOST_POINTS = 10_000_000;

function numbers(text: string | null, count: number): number[] | null {
  const values = text?.split('_').map(Number);
  return values?.length === count && values.every(Number.isFinite) ? values : null;
}

const clamp = (x: number) => Math.min(1, Math.max(0, Number.isFinite(x) ? x : 0));
const short = (x: number) => String(Number(x.toFixed(4)));
const list = (values: readonly number[]) => values.map(short).join('_');
