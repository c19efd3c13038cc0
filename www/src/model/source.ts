import { generate, readPoints } from 'gdel-wasm';
import bunny from '../../samples/bunny.f32.gz?url';
import dragon from '../../samples/dragon.f32.gz?url';

/** The synthetic distributions of the paper's section 5.1. */
export const DISTRIBUTIONS = {
  uniform: 'Uniform in a cube',
  gaussian: 'Gaussian',
  ball: 'Uniform in a ball',
  sphere: 'On a sphere',
  'thin-sphere': 'In a thin shell',
  grid: 'On a 512³ grid',
} as const;

export type Distribution = keyof typeof DISTRIBUTIONS;

/** The bundled scans. */
export const SAMPLES = {
  bunny: { title: 'Stanford bunny', url: bunny, points: 35_947 },
  dragon: { title: 'Stanford dragon', url: dragon, points: 437_645 },
} as const;

export type Sample = keyof typeof SAMPLES;

/** Where points come from. */
export type Source =
  | { kind: 'sample'; sample: Sample }
  | { kind: 'generator'; distribution: Distribution; count: number; seed: number }
  | { kind: 'file'; file: File };

/** What to call a source. */
export function titleOf(source: Source): string {
  if (source.kind === 'sample') return SAMPLES[source.sample].title;
  if (source.kind === 'file') return source.file.name;
  return DISTRIBUTIONS[source.distribution];
}

export interface LoadOptions {
  signal: AbortSignal;
  onProgress: (progress: { phase: string; fraction: number }) => void;
}

/** Fetches, generates or reads the points. */
export async function load(source: Source, options: LoadOptions): Promise<Float32Array | Float64Array> {
  if (source.kind === 'generator') {
    const { distribution, count, seed } = source;
    options.onProgress({ phase: 'Generating points', fraction: 0 });
    return generate(distribution, count, { seed });
  }
  if (source.kind === 'sample') {
    options.onProgress({ phase: `Fetching the ${titleOf(source)}`, fraction: 0 });
    return fetchSample(source.sample, options.signal);
  }
  const { file } = source;
  const phase = `Reading ${file.name}`;
  options.onProgress({ phase, fraction: 0 });
  const { points } = await readPoints(file, {
    name: file.name,
    signal: options.signal,
    onProgress: ({ fraction }) => options.onProgress({ phase, fraction }),
  });
  return points;
}

async function fetchSample(sample: Sample, signal: AbortSignal): Promise<Float32Array> {
  const { url, title } = SAMPLES[sample];
  const response = await fetch(url, { signal });
  if (!response.ok) throw new Error(`The ${title} could not be fetched: the server answered ${response.status}.`);
  const data = await response.arrayBuffer();
  return new Float32Array(isGzip(data) ? await gunzip(data) : data);
}

// Some servers unpack such files themselves.
function isGzip(data: ArrayBuffer): boolean {
  const [first, second] = new Uint8Array(data, 0, Math.min(2, data.byteLength));
  return first === 0x1f && second === 0x8b;
}

function gunzip(data: ArrayBuffer): Promise<ArrayBuffer> {
  return new Response(new Blob([data]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
}
