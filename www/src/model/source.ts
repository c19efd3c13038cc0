import { generate, generate2d, readPoints } from 'gdel-wasm';
import bunny from '../../samples/bunny.f32.gz?url';
import dragon from '../../samples/dragon.f32.gz?url';
import { type About, NOTHING_ABOUT } from './model';

/** 3D or 2D. */
export type Dimension = 2 | 3;

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

/** The bundled scans. */
export const SAMPLES = {
  bunny: { title: 'Stanford bunny', url: bunny, points: 35_947 },
  dragon: { title: 'Stanford dragon', url: dragon, points: 437_645 },
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
export const EXTENSIONS = 'PLY, OBJ, STL, XYZ, TXT, CSV, PTS, PCD, LAS, LAZ, NPY';

/** Where points come from. In 2D, the z of a file is ignored. */
export type Source =
  | { kind: 'sample'; dimension: 3; sample: Sample }
  | Generator<2>
  | Generator<3>
  | {
      kind: 'file';
      dimension: Dimension;
      file: File;
      /** The file as it is in the link, if it is small enough and somebody shared it. */
      packed?: string;
    }
  /** A file on a server that lets pages of others read it. */
  | { kind: 'url'; dimension: Dimension; url: string };

/** What to call a source. */
export function titleOf(source: Source): string {
  if (source.kind === 'sample') return SAMPLES[source.sample].title;
  if (source.kind === 'file') return source.file.name;
  if (source.kind === 'url') return nameIn(source.url);
  if (source.dimension === 3) return DISTRIBUTIONS[3][source.distribution];
  return source.count === 0 ? 'Drawn by hand' : DISTRIBUTIONS[2][source.distribution];
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
): Promise<{ points: Float32Array | Float64Array; about: About }> {
  if (source.kind === 'generator') {
    const { count, seed } = source;
    options.onProgress({ phase: 'Generating points', fraction: 0 });
    const points = await (source.dimension === 3
      ? generate(source.distribution, count, { seed })
      : generate2d(source.distribution, count, { seed }));
    return { points, about: NOTHING_ABOUT };
  }
  if (source.kind === 'sample') {
    options.onProgress({ phase: `Fetching the ${titleOf(source)}`, fraction: 0 });
    return { points: await fetchSample(source.sample, options.signal), about: NOTHING_ABOUT };
  }
  const file = source.kind === 'file' ? source.file : await download(source.url, options);
  const phase = `Reading ${file.name}`;
  options.onProgress({ phase, fraction: 0 });
  const name = file.name.replace(/\.gz$/i, '');
  const { points, noReturn } = await readPoints(await unpacked(file), {
    name,
    signal: options.signal,
    onProgress: ({ fraction }) => options.onProgress({ phase, fraction }),
  });
  return {
    points: source.dimension === 3 ? points : withoutZ(points),
    about: { noReturn, up: upOf(name) },
  };
}

/** Scans of the land have z up; models have y, and those for printing z, unless they stand otherwise. */
function upOf(name: string): About['up'] {
  const extension = name.replace(/^.*\./, '').toLowerCase();
  const model = ['ply', 'obj', 'stl', 'npy', 'f32', 'f64'].includes(extension);
  return { axis: model && extension !== 'stl' ? 'y' : 'z', sure: !model };
}

function withoutZ(points: Float32Array | Float64Array): Float32Array | Float64Array {
  const length = (points.length / 3) * 2;
  const flat = points instanceof Float32Array ? new Float32Array(length) : new Float64Array(length);
  for (let i = 0; i < length / 2; i++) {
    flat[2 * i] = points[3 * i];
    flat[2 * i + 1] = points[3 * i + 1];
  }
  return flat;
}

async function fetchSample(sample: Sample, signal: AbortSignal): Promise<Float32Array> {
  const { url, title } = SAMPLES[sample];
  const response = await fetch(url, { signal });
  if (!response.ok)
    throw new Error(`The ${title} could not be fetched: the server answered ${response.status}.`);
  const data = await response.arrayBuffer();
  return new Float32Array(isGzip(data) ? await gunzip(data) : data);
}

/** The name of the file that an address leads to. */
function nameIn(url: string): string {
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

/** The content of a file, which may be compressed. */
async function unpacked(file: File): Promise<Blob | ArrayBuffer> {
  if (!/\.gz$/i.test(file.name)) return file;
  try {
    return await gunzip(await file.arrayBuffer());
  } catch {
    throw new Error('the file is no gzip file, or it is damaged');
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
