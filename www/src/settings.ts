import type { Backend } from 'gdel-wasm';
import type { Dimension } from './geometry/dimension';
import type { FilterKind } from './geometry/filter';
import type { ColorBy } from './geometry/scale';
import { AZIMUTH, axisFacing, UPS, type Up } from './geometry/up';
import { type Edit, editsFromText, editsToText } from './model/edits';
import type { Summary } from './model/model';
import {
  DISTRIBUTIONS,
  type Distribution,
  filterFor,
  isShapes,
  nameIn,
  SAMPLES,
  type Sample,
  type Source,
  titleOf,
} from './model/source';
import { COLOR_MAPS, type ColorMapName } from './view/colormap';
import type { CameraPose } from './view/viewer';

export const LAYERS = [
  'simplices',
  'edges',
  'points',
  'hull',
  'facets',
  'voronoi',
  'skin',
] as const;
export type Layer = (typeof LAYERS)[number];

/** What a click does to 2D points. */
export const TOOLS = ['move', 'add', 'remove'] as const;
export type Tool = (typeof TOOLS)[number] | 'weigh' | 'draw';

/**
 * Everything that makes up a view, and so a link. Null stands for what suits the points: a new
 * object begins with it.
 */
export interface Settings {
  source: Source;
  /** The changes by hand, in 2D only. */
  edits: readonly Edit[];
  /** Whether points have weights; null if all are the same. */
  weights: Weighing | null;
  backend: Backend;
  color: ColorBy;
  map: ColorMapName;
  filter: FilterKind;
  /** In units of the input. */
  alpha: number | null;
  /** Of the cutting plane, in the input's axes. */
  normal: Vector | null;
  /** How much of the points' extent along the normal stays. */
  keep: number | null;
  /** The axis that points up. */
  up: Up | null;
  /** How far the tetrahedra are pulled apart: 0 not at all, 1 to half their size. */
  apart: number;
  layers: Record<Layer, boolean>;
  camera: CameraPose | null;
  /** Whether only the drawing and its dock are shown, in a frame of another page. */
  embed: boolean;
}

/** What the radii of points are taken from: a column of the file, or `random`. */
export interface Weighing {
  by: string;
  /** By which they are multiplied; those at random are parts of the distance between points. */
  scale: number;
}

type Vector = [number, number, number];

/** What depends on the shape of the points, and what each new object begins with. */
export const FRESH = {
  weights: null,
  alpha: null,
  normal: null,
  keep: null,
  up: null,
  apart: 0,
  camera: null,
} as const;

/**
 * What tells most: inside a scan sizes differ by orders of magnitude, in a synthetic cloud and in
 * polygons shapes do.
 */
export function colorFor(source: Source): ColorBy {
  return source.kind === 'generator' || isShapes(titleOf(source)) ? 'quality' : 'circumradius';
}

/** How the points are looked at and cut: what was chosen, else what suits them. */
export function viewOf(
  { up, normal, camera }: Settings,
  summary: Pick<Summary, 'up' | 'home'> | null,
): { up: Up; normal: Vector; camera: CameraPose } {
  const upwards = up ?? summary?.up ?? 'y';
  return {
    up: upwards,
    normal: normal ?? axisFacing(upwards, [Math.sin(AZIMUTH), 0, Math.cos(AZIMUTH)]),
    camera: camera ?? summary?.home ?? [0, 0, 2.7, 0, 0, 0],
  };
}

/** What a visitor sees first in 3D or 2D. */
export function defaults(dimension: Dimension = 3): Settings {
  const source: Source =
    dimension === 3
      ? { kind: 'sample', dimension, sample: 'bunny' }
      : { kind: 'generator', dimension, distribution: 'disk', count: 200, seed: 1 };
  return {
    source,
    edits: [],
    backend: 'auto',
    color: colorFor(source),
    map: 'viridis',
    filter: filterFor(source),
    ...FRESH,
    embed: false,
    layers: {
      simplices: true,
      edges: true,
      points: true,
      hull: dimension === 2,
      facets: false,
      voronoi: dimension === 2,
      skin: true,
    },
  };
}

/**
 * The part of the address after '#'. Only what differs from the defaults is in it, and of a file
 * only the name.
 */
export function toHash(settings: Settings): string {
  const { source, edits } = settings;
  const start = defaults(source.dimension);
  const hash = new URLSearchParams();
  if (source.dimension === 2) hash.set('dim', '2');
  if (source.kind === 'sample') hash.set('points', source.sample);
  if (source.kind === 'file') hash.set('file', titleOf(source));
  if (source.kind === 'file' && source.packed) hash.set('data', source.packed);
  if (source.kind === 'url') hash.set('url', source.url);
  if ('bare' in source) hash.set('bare', '1');
  if (settings.embed) hash.set('embed', '1');
  if (source.kind === 'generator')
    hash.set('points', [source.distribution, source.count, source.seed].join('_'));
  if (edits.length > 0) hash.set('edits', editsToText(edits));
  if (settings.weights) hash.set('weights', `${settings.weights.scale}_${settings.weights.by}`);
  start.filter = filterFor(source);
  start.color = colorFor(source);
  for (const key of ['backend', 'color', 'map', 'filter'] as const) {
    if (settings[key] !== start[key]) hash.set(key, settings[key]);
  }
  if (settings.alpha !== null) hash.set('alpha', String(Number(settings.alpha.toPrecision(9))));
  if (settings.up) hash.set('up', settings.up);
  if (settings.normal) hash.set('normal', list(settings.normal));
  if (settings.keep !== null) hash.set('keep', short(settings.keep));
  if (settings.apart !== 0) hash.set('apart', short(settings.apart));
  const layers = LAYERS.filter((layer) => settings.layers[layer]).join('_');
  if (layers !== LAYERS.filter((layer) => start.layers[layer]).join('_'))
    hash.set('layers', layers);
  if (settings.camera) hash.set('camera', list(settings.camera));
  return hash.toString();
}

/**
 * The settings in a hash. What is missing or makes no sense is as in the defaults: a link may come
 * from anywhere.
 */
export function fromHash(hash: string): Settings {
  const given = new URLSearchParams(hash.replace(/^#/, ''));
  const url = addressFrom(given.get('url'));
  const dimension = given.get('dim') === '2' || (url && isShapes(nameIn(url))) ? 2 : 3;
  const settings = defaults(dimension);
  const choice = <T extends string>(key: string, of: readonly T[], otherwise: T) =>
    of.find((option) => option === given.get(key)) ?? otherwise;

  settings.source = url
    ? { kind: 'url', dimension, url, ...bareIn(given) }
    : (sourceFrom(given.get('points'), dimension) ?? settings.source);
  settings.embed = given.has('embed');
  if (dimension === 2) settings.edits = editsFromText(given.get('edits') ?? '') ?? [];
  const [, scale, by] = /^([\d.]+)_(.+)$/s.exec(given.get('weights') ?? '') ?? [];
  if (by && Number(scale) <= 100) settings.weights = { by, scale: Number(scale) };
  settings.backend = choice('backend', ['auto', 'gpu', 'cpu'], settings.backend);
  settings.color = choice('color', colorsIn(dimension), colorFor(settings.source));
  settings.map = choice('map', Object.keys(COLOR_MAPS) as ColorMapName[], settings.map);
  settings.filter = choice(
    'filter',
    dimension === 2 ? ['all', 'alpha'] : ['all', 'surface', 'alpha', 'carve'],
    filterFor(given.has('file') ? { kind: 'file', dimension } : settings.source),
  );
  settings.up = UPS.find((up) => up === given.get('up')) ?? null;
  const alpha = Number(given.get('alpha'));
  if (alpha > 0 && alpha < Infinity) settings.alpha = alpha;
  const normal = numbers(given.get('normal'), 3) as Vector | null;
  const length = Math.hypot(...(normal ?? []));
  if (normal && length > 0) settings.normal = normal.map((x) => x / length) as Vector;
  const keep = numbers(given.get('keep'), 1);
  if (keep) settings.keep = clamp(keep[0]);
  settings.apart = clamp(Number(given.get('apart')));
  const layers = given.get('layers')?.split('_');
  if (layers) for (const layer of LAYERS) settings.layers[layer] = layers.includes(layer);
  const camera = numbers(given.get('camera'), 6);
  if (camera && camera[2] > 0) settings.camera = camera as CameraPose;
  // Straight down.
  if (dimension === 2 && settings.camera)
    settings.camera[0] = settings.camera[1] = settings.camera[5] = 0;
  return settings;
}

/** The file that a link was made from. */
export interface LinkedFile {
  name: string;
  /** Its content, if that is in the link. */
  packed: string | null;
  bare?: true;
}

export function fileIn(hash: string): LinkedFile | null {
  const given = new URLSearchParams(hash.replace(/^#/, ''));
  const name = given.get('file');
  return name === null ? null : { name, packed: given.get('data'), ...bareIn(given) };
}

/** Whether a link asks for a model without points on its faces. */
const bareIn = (given: URLSearchParams): { bare?: true } =>
  given.has('bare') ? { bare: true } : {};

/** Returns the quantities that exist in a dimension. */
export function colorsIn(dimension: Dimension): ColorBy[] {
  return dimension === 3
    ? ['quality', 'volume', 'circumradius', 'phase']
    : ['quality', 'volume', 'circumradius'];
}

/** An address of the web in a link. */
function addressFrom(text: string | null): string | null {
  try {
    const url = new URL(text ?? '');
    return /^https?:$/.test(url.protocol) ? url.href : null;
  } catch {
    return null;
  }
}

function sourceFrom(text: string | null, dimension: Dimension): Source | null {
  if (!text) return null;
  if (dimension === 3 && Object.hasOwn(SAMPLES, text))
    return { kind: 'sample', dimension, sample: text as Sample };
  const [distribution, count, seed] = text.split('_');
  const points = Number(count);
  const min = dimension === 3 ? 1 : 0;
  if (!Object.hasOwn(DISTRIBUTIONS[dimension], distribution) || !count) return null;
  if (!Number.isSafeInteger(points) || points < min || points > MAX_POINTS) return null;
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
export const MAX_POINTS = 10_000_000;

function numbers(text: string | null, count: number): number[] | null {
  const values = text?.split('_').map((part) => (part === '' ? NaN : Number(part)));
  return values?.length === count && values.every(Number.isFinite) ? values : null;
}

const clamp = (x: number) => Math.min(1, Math.max(0, Number.isFinite(x) ? x : 0));
const short = (x: number) => String(Number(x.toFixed(5)));
const list = (values: readonly number[]) => values.map(short).join('_');
