import { generate, generate2d, readPoints, type Shapes } from 'gdel-wasm';
import bunny from '../../samples/bunny.f32.gz?url';
import dragon from '../../samples/dragon.f32.gz?url';
import type { Dimension } from '../geometry/dimension';
import { MANY_CORNERS, pointsOnFaces } from '../geometry/faces';
import type { FilterKind } from '../geometry/filter';
import { type About, NOTHING_ABOUT } from './about';
import { facesOf } from './faceFiles';
import type { FileShapes } from './shapes';

/**
 * The synthetic distributions: in 3D those of section 5.1 of the paper, in 2D those of 5.6 and some
 * difficult ones.
 */
export const DISTRIBUTIONS = {
  3: {
    uniform: 'Uniform in a cube',
    gaussian: 'Gaussian',
    ball: 'Uniform in a ball',
    sphere: 'On a sphere',
    'thin-sphere': 'In a thin shell',
    grid: 'On a 512³ grid',
  },
  2: {
    uniform: 'Uniform in a square',
    gaussian: 'Gaussian',
    disk: 'Uniform in a disk',
    circle: 'On a circle',
    'thin-circle': 'In a thin ring',
    grid: 'On a 512² grid',
    'two-lines': 'On two lines',
    clusters: 'In 64 tiny clusters',
  },
} as const;

export type Distribution<D extends Dimension> = keyof (typeof DISTRIBUTIONS)[D];

/** What comes with the page: two scans that are fetched, and objects that are computed. */
export const SAMPLES = {
  bunny: { title: 'Stanford bunny', points: 35_947, url: bunny, up: 'y' },
  terrain: { title: 'Mountains', points: 60_000, url: null, up: 'z' },
  sponge: { title: 'Menger sponge', points: 98_688, url: null, up: 'y' },
  gear: { title: 'Gear', points: 50_000, url: null, up: 'y' },
  knot: { title: 'Trefoil knot', points: 40_000, url: null, up: 'z' },
  shell: { title: 'Sea shell', points: 45_000, url: null, up: 'y' },
  gyroid: { title: 'Gyroid', points: 60_000, url: null, up: 'y' },
  fullerene: { title: 'Fullerene', points: 54_000, url: null, up: 'y' },
  dragon: { title: 'Stanford dragon', points: 437_645, url: dragon, up: 'y' },
} as const;

export type Sample = keyof typeof SAMPLES;

type Generator<D extends Dimension> = {
  kind: 'generator';
  dimension: D;
  distribution: Distribution<D>;
  count: number;
  seed: number;
};

/** The formats of files that can be read, for people. */
export const EXTENSIONS =
  'PLY, OBJ, STL, GLB, XYZ, TXT, CSV, PTS, PCD, LAS, LAZ, NPY, E57; in 2D GeoJSON, SVG and POLY';

/** Whether a file of this name has shapes, which are in a plane. */
export const isShapes = (name: string): boolean => /\.((geo)?json|svg|poly)(\.gz)?$/i.test(name);

/**
 * Where points come from. In 2D, the z of a file is ignored. Of a coarse model, points on its faces
 * are taken besides its corners, unless these are to stay bare.
 */
export type Source =
  | { kind: 'sample'; dimension: 3; sample: Sample }
  | Generator<2>
  | Generator<3>
  | {
      kind: 'file';
      dimension: Dimension;
      /** One or more, of which all points are taken together. */
      files: readonly File[];
      bare?: true;
      /** The file as it is in the link, if there is one, small enough, and somebody shared it. */
      packed?: string;
    }
  /** A file on a server that lets pages of others read it. */
  | { kind: 'url'; dimension: Dimension; url: string; bare?: true };

/** The source of files that were opened together. */
export function filesSource(files: readonly File[], dimension: Dimension): Source {
  return {
    kind: 'file',
    dimension: files.some(({ name }) => isShapes(name)) ? 2 : dimension,
    files,
  };
}

/** What to call a source. */
export function titleOf(source: Source): string {
  if (source.kind === 'sample') return SAMPLES[source.sample].title;
  if (source.kind === 'file') {
    const [{ name }, ...others] = source.files;
    return others.length === 0 ? name : `${name} and ${others.length} more`;
  }
  if (source.kind === 'url') return nameIn(source.url);
  if (source.dimension === 3) return DISTRIBUTIONS[3][source.distribution];
  return source.count === 0 ? 'Drawn by hand' : DISTRIBUTIONS[2][source.distribution];
}

/** What downloads are called, before the dot. */
export function stemOf(source: Source): string {
  return titleOf(source)
    .replace(/\.[^.]*$/, '')
    .replace(/[^\w-]+/g, '-')
    .toLowerCase();
}

/** What suits a source: the surface of a scan, the carved solid of an object, all of a synthetic cloud. */
export function filterFor({ kind, dimension }: Pick<Source, 'kind' | 'dimension'>): FilterKind {
  if (kind === 'generator' || dimension === 2) return 'all';
  return kind === 'sample' ? 'carve' : 'surface';
}

export interface LoadOptions {
  signal: AbortSignal;
  onProgress: (progress: { phase: string; fraction: number }) => void;
}

/**
 * Fetches, generates or reads the points: as many coordinates each as the source's dimension says.
 */
export async function load(
  source: Source,
  options: LoadOptions,
): Promise<{ points: Float32Array | Float64Array; about: About; shapes?: FileShapes }> {
  if (source.kind === 'generator') {
    const { count, seed } = source;
    options.onProgress({ phase: 'Generating points', fraction: 0 });
    const points = await (source.dimension === 3
      ? generate(source.distribution, count, { seed })
      : generate2d(source.distribution, count, { seed }));
    return { points, about: NOTHING_ABOUT };
  }
  if (source.kind === 'sample') {
    const { sample } = source;
    const about: About = { ...NOTHING_ABOUT, up: { axis: SAMPLES[sample].up, unless: 'never' } };
    if (sample === 'bunny' || sample === 'dragon') {
      options.onProgress({ phase: `Fetching the ${titleOf(source)}`, fraction: 0 });
      return { points: await fetchSample(sample, options.signal), about };
    }
    options.onProgress({ phase: 'Generating points', fraction: 0 });
    const { landColors, OBJECTS } = await import('./objects');
    const points = OBJECTS[sample]();
    if (sample === 'terrain') about.colors = { rgb: landColors(points), source: 'rgb' };
    return { points, about };
  }
  const files = source.kind === 'file' ? source.files : [await download(source.url, options)];
  const parts: Read[] = [];
  for (const file of files) {
    const phase = `Reading ${file.name}`;
    const onProgress = (fraction: number) => options.onProgress({ phase, fraction });
    onProgress(0);
    try {
      const part = await read(file, options.signal, onProgress);
      parts.push(source.dimension === 3 ? await withFaces(part, source.bare) : part);
    } catch (error) {
      // With one file, its name goes before the message anyway.
      if (files.length > 1 && error instanceof Error && error.name !== 'AbortError')
        error.message = `${file.name}: ${error.message}`;
      throw error;
    }
  }
  const all = joined(parts.map((part) => part.points));
  const { points, heights } = source.dimension === 3 ? { points: all, heights: null } : split(all);
  const hasShapes = source.dimension === 2 && parts.some((part) => part.shapes);
  return {
    points,
    ...(hasShapes && { shapes: (await import('./shapes')).together(parts) }),
    about: {
      heights,
      noReturn: parts.reduce((sum, part) => sum + part.about.noReturn, 0),
      onFaces: onFacesOf(parts),
      up: parts[0].about.up,
      colors: colorsOf(parts),
      // Of several files, they would have to be joined.
      normals: parts.length === 1 ? parts[0].about.normals : null,
      sensors: parts.length === 1 ? parts[0].about.sensors : null,
    },
  };
}

/** What a file holds: three coordinates per point. */
interface Read {
  points: Float32Array | Float64Array;
  about: About;
  /** Polygons and lines through the points, if the file has some. */
  shapes?: Shapes;
  /** The corners of the triangles that the points belong to, nine coordinates each; null without. */
  faces(): Promise<Float64Array | null> | Float64Array | null;
}

async function read(
  file: File,
  signal: AbortSignal,
  onProgress: (fraction: number) => void,
): Promise<Read> {
  const name = file.name.replace(/\.gz$/i, '');
  const content = await unpacked(file);
  if (/\.glb$/i.test(name)) {
    const bytes = content instanceof Blob ? await content.arrayBuffer() : content;
    const { points, colors, faces } = await (await import('./glb')).pointsOf(new Uint8Array(bytes));
    // That y is up, the format says.
    const about: About = { ...NOTHING_ABOUT, colors: colors && { rgb: colors, source: 'rgb' } };
    return { points, about, faces };
  }
  if (isShapes(name)) {
    const { readInSpace } = await import('./shapes');
    return {
      ...(await readInSpace(content, name, signal)),
      about: NOTHING_ABOUT,
      faces: () => null,
    };
  }
  const { points, noReturn, colors, colorSource, normals, sensors } = await readPoints(content, {
    name,
    signal,
    onProgress: ({ fraction }) => onProgress(fraction),
  });
  return {
    points,
    about: {
      ...NOTHING_ABOUT,
      noReturn,
      up: upOf(name),
      normals,
      sensors,
      colors: colors && { rgb: colors, source: colorSource! },
    },
    faces: async () =>
      facesOf(name, content instanceof Blob ? await content.arrayBuffer() : content),
  };
}

/** Adds points on the faces of a coarse model, of which the corners alone tell little. */
async function withFaces(part: Read, bare = false): Promise<Read> {
  const { points, about } = part;
  const corners = points.length / 3;
  // Colours are those of corners.
  if (corners >= MANY_CORNERS || about.colors) return part;
  const faces = await part.faces();
  const more = faces ? pointsOnFaces(faces, corners) : new Float64Array();
  if (more.length === 0) return part;
  return {
    ...part,
    points: bare
      ? points
      : joined([points, points instanceof Float32Array ? Float32Array.from(more) : more]),
    // Those on the faces have none.
    about: {
      ...about,
      normals: null,
      sensors: null,
      onFaces: { points: more.length / 3, taken: !bare },
    },
  };
}

function onFacesOf(parts: readonly Read[]): About['onFaces'] {
  const coarse = parts.flatMap(({ about }) => about.onFaces ?? []);
  const points = coarse.reduce((sum, { points }) => sum + points, 0);
  return coarse.length > 0 ? { points, taken: coarse[0].taken } : null;
}

/** Arrays one after the other, in the precision of the most precise. */
function joined(parts: readonly (Float32Array | Float64Array)[]): Float32Array | Float64Array {
  if (parts.length === 1) return parts[0];
  const length = parts.reduce((sum, part) => sum + part.length, 0);
  const isSingle = parts.every((part) => part instanceof Float32Array);
  const all = isSingle ? new Float32Array(length) : new Float64Array(length);
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

/** The colours of several files: those of all if all have some, of the same kind; else none. */
function colorsOf(parts: readonly Read[]): About['colors'] {
  const first = parts[0].about.colors;
  if (parts.length === 1 || !first) return first;
  const rgb = new Uint8Array(parts.reduce((sum, { points }) => sum + points.length, 0));
  let at = 0;
  for (const { about } of parts) {
    const { colors } = about;
    if (!colors || colors.source !== first.source) return null;
    rgb.set(colors.rgb, at);
    at += colors.rgb.length;
  }
  return { rgb, source: first.source };
}

/** By custom, models have y up, and those for printing z; surveys have z, also as text. */
const CUSTOMS: Readonly<Record<string, About['up']>> = {
  ...Object.fromEntries(
    ['ply', 'obj', 'off', 'npy'].map((each) => [each, { axis: 'y', unless: 'it stands or lies' }]),
  ),
  stl: { axis: 'z', unless: 'it stands or lies' },
  ...Object.fromEntries(
    ['xyz', 'txt', 'asc', 'pts', 'csv'].map((each) => [each, { axis: 'z', unless: 'it stands' }]),
  ),
};

function upOf(name: string): About['up'] {
  const extension = name.replace(/^.*\./, '').toLowerCase();
  return Object.hasOwn(CUSTOMS, extension) ? CUSTOMS[extension] : { axis: 'z', unless: 'never' };
}

/** Points as seen from above, and their heights, unless all are the same. */
function split(all: Float32Array | Float64Array) {
  const count = all.length / 3;
  const isSingle = all instanceof Float32Array;
  const points = isSingle ? new Float32Array(2 * count) : new Float64Array(2 * count);
  const heights = isSingle ? new Float32Array(count) : new Float64Array(count);
  for (let i = 0; i < count; i++) {
    points[2 * i] = all[3 * i];
    points[2 * i + 1] = all[3 * i + 1];
    heights[i] = all[3 * i + 2];
  }
  return { points, heights: heights.some((z) => z !== heights[0]) ? heights : null };
}

async function fetchSample(sample: 'bunny' | 'dragon', signal: AbortSignal): Promise<Float32Array> {
  const { url, title } = SAMPLES[sample];
  const response = await fetch(url, { signal });
  if (!response.ok)
    throw new Error(`The ${title} could not be fetched: the server answered ${response.status}.`);
  const data = await response.arrayBuffer();
  return new Float32Array(isGzip(data) ? await gunzip(data) : data);
}

/** The name of the file that an address leads to. */
export function nameIn(url: string): string {
  const last = new URL(url).pathname.split('/').at(-1) ?? '';
  try {
    return decodeURIComponent(last) || url;
  } catch {
    return last;
  }
}

async function download(url: string, { signal, onProgress }: LoadOptions): Promise<File> {
  const name = nameIn(url);
  onProgress({ phase: `Fetching ${name}`, fraction: 0 });
  const response = await fetch(url, { signal });
  if (!response.ok) throw new Error(`The server answered ${response.status}`);
  return new File([await response.blob()], name);
}

/** Whether a file of this name is compressed. */
export const isGzipName = (name: string): boolean => /\.gz$/i.test(name);

/** The content of a file, which may be compressed. */
async function unpacked(file: File): Promise<Blob | ArrayBuffer> {
  if (!isGzipName(file.name)) return file;
  try {
    return await gunzip(await file.arrayBuffer());
  } catch {
    throw new Error('the file is not a gzip file, or it is damaged');
  }
}

// Some servers unpack such files themselves.
function isGzip(data: ArrayBuffer): boolean {
  const [first, second] = new Uint8Array(data, 0, Math.min(2, data.byteLength));
  return first === 0x1f && second === 0x8b;
}

function gunzip(data: ArrayBuffer): Promise<ArrayBuffer> {
  return new Response(
    new Blob([data]).stream().pipeThrough(new DecompressionStream('gzip')),
  ).arrayBuffer();
}
