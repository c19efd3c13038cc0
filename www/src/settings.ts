import type { Filter } from './geometry/filter';
import type { ColorBy } from './geometry/scale';
import { type Edit, editsFromText, editsToText } from './model/edits';
import type { Engine } from './model/model';
import {
  DISTRIBUTIONS,
  type Dimension,
  type Distribution,
  SAMPLES,
  type Sample,
  type Source,
} from './model/source';
import { COLOR_MAPS, type ColorMapName } from './view/colormap';
import type { CameraPose } from './view/viewer';

export type Up = 'y' | 'z';

export const LAYERS = ['simplices', 'edges', 'points', 'hull', 'facets', 'voronoi'] as const;
export type Layer = (typeof LAYERS)[number];

/** What a click on the plane does to points. */
export const TOOLS = ['move', 'add', 'remove'] as const;
export type Tool = (typeof TOOLS)[number];

/** Everything that makes up a view, and so a link. */
export interface Settings {
  source: Source;
  /** What was changed by hand, in the plane only. */
  edits: readonly Edit[];
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
export function filterFor({ kind, dimension }: Source): Filter['kind'] {
  return kind === 'generator' || dimension === 2 ? 'all' : 'carve';
}

/** What tells most: inside a scan sizes differ by orders of magnitude, in a synthetic cloud shapes do. */
export function colorFor(source: Source): ColorBy {
  return source.kind === 'generator' ? 'quality' : 'circumradius';
}

/** Scans of the land have z up, models y. */
export function upFor(source: Source): Up {
  const land = /\.(las|laz|pcd|pts|xyz|asc|txt|csv|tsv)$/i;
  return source.kind === 'file' && source.dimension === 3 && land.test(source.file.name)
    ? 'z'
    : 'y';
}

/** Where the camera is at first: beside a model, above the plane. */
export const HOME: Record<Dimension, CameraPose> = {
  3: [0.5, 0.24, 2.85, 0, 0, 0],
  2: [0, 0, 2.7, 0, 0, 0],
};

/** What a visitor sees first, in space or in the plane. */
export function defaults(dimension: Dimension = 3): Settings {
  const source: Source =
    dimension === 3
      ? { kind: 'sample', dimension, sample: 'bunny' }
      : { kind: 'generator', dimension, distribution: 'disk', count: 200, seed: 1 };
  return {
    source,
    edits: [],
    engine: 'auto',
    color: colorFor(source),
    map: 'viridis',
    filter: filterFor(source),
    alpha: null,
    normal: [0, 0, 1],
    keep: 0.5,
    up: 'y',
    apart: 0,
    layers: {
      simplices: true,
      edges: true,
      points: true,
      hull: dimension === 2,
      facets: false,
      voronoi: dimension === 2,
    },
    camera: [...HOME[dimension]],
  };
}

/** The part of the address after '#'. Only what differs from the defaults is in it, and never a file. */
export function toHash(settings: Settings): string {
  const { source, edits } = settings;
  const start = defaults(source.dimension);
  const hash = new URLSearchParams();
  if (source.dimension === 2) hash.set('dim', '2');
  if (source.kind === 'sample') hash.set('points', source.sample);
  if (source.kind === 'generator')
    hash.set('points', [source.distribution, source.count, source.seed].join('_'));
  if (source.kind === 'generator' && edits.length > 0) hash.set('edits', editsToText(edits));
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
  if (layers !== LAYERS.filter((layer) => start.layers[layer]).join('_'))
    hash.set('layers', layers);
  const camera = list(settings.camera);
  if (camera !== list(start.camera)) hash.set('camera', camera);
  return hash.toString();
}

/** The settings in a hash. What is missing or makes no sense is as in the defaults: a link may come from anywhere. */
export function fromHash(hash: string): Settings {
  const given = new URLSearchParams(hash.replace(/^#/, ''));
  const dimension = given.get('dim') === '2' ? 2 : 3;
  const settings = defaults(dimension);
  const choice = <T extends string>(key: string, of: readonly T[], otherwise: T) =>
    of.find((option) => option === given.get(key)) ?? otherwise;

  settings.source = sourceFrom(given.get('points'), dimension) ?? settings.source;
  if (dimension === 2) settings.edits = editsFromText(given.get('edits') ?? '') ?? [];
  settings.engine = choice('engine', ['auto', 'gpu', 'cpu'], settings.engine);
  settings.color = choice('color', colorsIn(dimension), colorFor(settings.source));
  settings.map = choice('map', Object.keys(COLOR_MAPS) as ColorMapName[], settings.map);
  settings.filter = choice(
    'filter',
    dimension === 2 ? ['all', 'alpha'] : ['all', 'alpha', 'carve'],
    filterFor(settings.source),
  );
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
  // Straight down.
  if (dimension === 2) settings.camera[0] = settings.camera[1] = settings.camera[5] = 0;
  return settings;
}

/** The quantities that there are in space or in the plane. */
export function colorsIn(dimension: Dimension): ColorBy[] {
  return dimension === 3
    ? ['quality', 'volume', 'circumradius', 'phase']
    : ['quality', 'volume', 'circumradius'];
}

function sourceFrom(text: string | null, dimension: Dimension): Source | null {
  if (!text) return null;
  if (dimension === 3 && Object.hasOwn(SAMPLES, text))
    return { kind: 'sample', dimension, sample: text as Sample };
  const [distribution, count, seed] = text.split('_');
  const points = Number(count);
  const least = dimension === 3 ? 1 : 0;
  if (!Object.hasOwn(DISTRIBUTIONS[dimension], distribution) || !count) return null;
  if (!Number.isSafeInteger(points) || points < least || points > MOST_POINTS) return null;
  const start = Number(seed);
  return generator(
    dimension,
    distribution,
    points,
    Number.isSafeInteger(start) && start >= 0 ? start : 0,
  );
}

/** The source with a distribution that the dimension has. */
export function generator(
  dimension: Dimension,
  distribution: string,
  count: number,
  seed: number,
): Source {
  return dimension === 3
    ? { kind: 'generator', dimension, distribution: distribution as Distribution<3>, count, seed }
    : { kind: 'generator', dimension, distribution: distribution as Distribution<2>, count, seed };
}

/** More points than this would be asking a browser for trouble. */
export const MOST_POINTS = 10_000_000;

function numbers(text: string | null, count: number): number[] | null {
  const values = text?.split('_').map(Number);
  return values?.length === count && values.every(Number.isFinite) ? values : null;
}

const clamp = (x: number) => Math.min(1, Math.max(0, Number.isFinite(x) ? x : 0));
const short = (x: number) => String(Number(x.toFixed(5)));
const list = (values: readonly number[]) => values.map(short).join('_');
