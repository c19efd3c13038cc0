// What the report measures: meshes of both backends, which have to be the same.

import {
  createTriangulator,
  delaunay2d,
  delaunay3d,
  GdelError,
  generate,
  generate2d,
  type Triangulator,
} from 'gdel-wasm';
import { browserName, type Outcome, shown, systemName, worse } from './block';
import { fingerprint } from './fingerprint';

/** The runs of which the fastest counts; two if they take longer than this, since the first one may compile kernels. */
const RUNS = 3;
const ENOUGH_MILLISECONDS = 2000;
/** Inputs are left out for which a run is expected to take longer than this. */
const PATIENCE_MILLISECONDS = 30_000;
const SEED = 1;
/** The points along an axis of the grid. */
const SIDE = 12;

type Dimension = 2 | 3;

/** What is small and hard, as `gdel adapters --test` has it. */
const TESTS = [
  { name: 'few', kind: 'uniform', count: 1000 },
  { name: 'grid', kind: 'grid', count: 1000 },
  { name: 'sphere', kind: 'sphere', count: 400 },
  { name: 'uniform', kind: 'uniform', count: 30_000 },
] as const;

export interface Settings {
  /** The numbers of points, ascending. The tests have no more than the last one. */
  counts: number[];
  signal: AbortSignal;
  /** Called with a line of the report. */
  onLine(line: string): void;
  /** Called before each input, with what is done so far, from 0 to 1. */
  onStep(what: string, fraction: number): void;
}

/** A mesh that was made: its fingerprint, why the CPU made it if it was to be the GPU, and how long that took. */
interface Run {
  fingerprint: number;
  fallback: string | null;
  milliseconds: number;
}

/** Writes the report, line by line. Rejects with the reason of the signal. */
export async function measure({ counts, signal, onLine, onStep }: Settings): Promise<Outcome> {
  const { gpu, why } = await openGpu();
  try {
    const adapter = gpu?.info.adapter;
    const names = adapter && [
      adapter.description || adapter.device,
      adapter.vendor,
      adapter.architecture,
    ];
    const software = adapter?.software ? ' (software)' : '';
    onLine('gdel report 1');
    onLine(`version: ${import.meta.env.VITE_VERSION}`);
    onLine(
      `device: ${names ? `${names.filter(Boolean).join(' ') || 'unnamed'}${software}` : 'none'}`,
    );
    onLine(`driver: webgpu, ${browserName(navigator.userAgent)}`);
    onLine(`system: ${systemName(navigator)}`);
    const report = new Report(gpu, signal, counts.at(-1)!);
    const steps = [
      ...dimensions.map((D) => () => report.selfTest(D, why)),
      ...dimensions.flatMap((D) => counts.map((count) => () => report.compare(D, count))),
    ];
    const whats = [
      ...dimensions.map((D) => `Self-test in ${D}D`),
      ...dimensions.flatMap((D) =>
        counts.map((count) => `${count.toLocaleString('en')} points in ${D}D`),
      ),
    ];
    for (const [i, step] of steps.entries()) {
      onStep(whats[i], i / steps.length);
      onLine(await step());
    }
    return report.outcome;
  } finally {
    gpu?.dispose();
  }
}

const dimensions: readonly Dimension[] = [3, 2];

/** Opens the GPU, or says why there is none. The comparisons are the test. */
async function openGpu(): Promise<{ gpu: Triangulator | null; why: string }> {
  try {
    return { gpu: await createTriangulator({ backend: 'gpu', selfTest: false }), why: '' };
  } catch (error) {
    return { gpu: null, why: messageOf(error) };
  }
}

class Report {
  outcome: Outcome = 'right';
  readonly #gpu: Triangulator | null;
  readonly #signal: AbortSignal;
  readonly #most: number;
  /** The milliseconds that the slower backend took for a point of the last input of each dimension. */
  readonly #paces = { 2: 0, 3: 0 };

  constructor(gpu: Triangulator | null, signal: AbortSignal, most: number) {
    this.#gpu = gpu;
    this.#signal = signal;
    this.#most = most;
  }

  /** Returns the line of the self-test. */
  async selfTest(D: Dimension, why: string): Promise<string> {
    const title = `self-test ${D}D`;
    if (!this.#gpu) return this.#line('incomplete', `${title}: none, ${why}`);
    const times = [];
    const began = performance.now();
    for (const { name, kind, count } of TESTS) {
      const points = await pointsOf(D, kind, Math.min(count, this.#most));
      try {
        const cpu = await this.#fastest(D, points, null);
        const gpu = await this.#fastest(D, points, this.#gpu);
        const what = gpu.fallback ? `left to the CPU: ${gpu.fallback}` : 'another mesh';
        if (gpu.fallback || gpu.fingerprint !== cpu.fingerprint)
          return this.#line('WRONG', `${title}: FAILED at ${name}, ${what}`);
        times.push(`${name} ${shown(gpu.milliseconds)}`);
      } catch (error) {
        const { outcome, what } = this.#trouble(error);
        return this.#line(outcome, `${title}: FAILED at ${name}, ${what}`);
      }
    }
    return `${title}: passed in ${shown(performance.now() - began)} (${times.join(', ')})`;
  }

  /** Returns the line that compares both backends. */
  async compare(D: Dimension, count: number): Promise<string> {
    const title = `${D}D ${count}`;
    const expected = this.#paces[D] * count;
    if (expected > PATIENCE_MILLISECONDS) {
      const seconds = Math.round(expected / 1000);
      return this.#line('incomplete', `${title}: left out, a run would take ${seconds} s`);
    }
    let text = `${title}: CPU `;
    try {
      const points = await pointsOf(D, 'uniform', count);
      const cpu = await this.#fastest(D, points, null);
      text += `${shown(cpu.milliseconds)}, GPU `;
      this.#paces[D] = cpu.milliseconds / count;
      if (!this.#gpu) return this.#line('incomplete', `${text}none`);
      const gpu = await this.#fastest(D, points, this.#gpu);
      this.#paces[D] = Math.max(cpu.milliseconds, gpu.milliseconds) / count;
      if (gpu.fallback)
        return this.#line('incomplete', `${text}failed: left to the CPU: ${gpu.fallback}`);
      text += `${shown(gpu.milliseconds)}, `;
      return gpu.fingerprint === cpu.fingerprint
        ? `${text}same`
        : this.#line('WRONG', `${text}DIFFERENT`);
    } catch (error) {
      const { outcome, what } = this.#trouble(error);
      return this.#line(outcome, `${text}failed: ${what}`);
    }
  }

  #line(outcome: Outcome, line: string): string {
    this.outcome = worse(this.outcome, outcome);
    return line;
  }

  /** Returns what an error says of the device. */
  #trouble(error: unknown): { outcome: Outcome; what: string } {
    this.#signal.throwIfAborted();
    const isWrong =
      error instanceof Disagreement ||
      (error instanceof GdelError && ['GPU_WRONG', 'INTERNAL'].includes(error.code));
    return { outcome: isWrong ? 'WRONG' : 'incomplete', what: messageOf(error) };
  }

  /** Returns the fastest of a few runs, which have to make the same mesh. */
  async #fastest(D: Dimension, points: Float64Array, gpu: Triangulator | null): Promise<Run> {
    let best = await this.#run(D, points, gpu);
    for (let i = 1; i < RUNS; i++) {
      const limit = i === 1 ? PATIENCE_MILLISECONDS : ENOUGH_MILLISECONDS;
      if (best.milliseconds > limit) break;
      const next = await this.#run(D, points, gpu);
      if (next.fingerprint !== best.fingerprint) throw new Disagreement();
      if (next.milliseconds < best.milliseconds) best = next;
    }
    return best;
  }

  async #run(D: Dimension, points: Float64Array, gpu: Triangulator | null): Promise<Run> {
    const signal = this.#signal;
    const began = performance.now();
    if (D === 3) {
      const mesh = await (gpu
        ? gpu.delaunay3d(points, { signal })
        : delaunay3d(points, { signal, backend: 'cpu' }));
      const milliseconds = performance.now() - began;
      const found = await fingerprint(mesh.tetrahedra, mesh.neighbors, 4);
      return { fingerprint: found, fallback: mesh.stats.fallback, milliseconds };
    }
    const mesh = await (gpu
      ? gpu.delaunay2d(points, { signal })
      : delaunay2d(points, { signal, backend: 'cpu' }));
    const milliseconds = performance.now() - began;
    const found = await fingerprint(mesh.triangles, mesh.halfedges, 3);
    return { fingerprint: found, fallback: mesh.stats.fallback, milliseconds };
  }
}

/** Two runs of one backend that made different meshes. */
class Disagreement extends Error {
  constructor() {
    super('two runs make different meshes');
  }
}

const messageOf = (error: unknown): string =>
  (error instanceof Error ? error.message : String(error)).replaceAll(/\s+/g, ' ');

/** Returns points of a kind. The grid has ties and duplicates. */
async function pointsOf(
  D: Dimension,
  kind: 'uniform' | 'grid' | 'sphere',
  count: number,
): Promise<Float64Array> {
  if (kind === 'grid') {
    let state = SEED;
    return Float64Array.from({ length: D * count }, () => {
      state = (Math.imul(state, 1_664_525) + 1_013_904_223) >>> 0;
      return (state >>> 16) % SIDE;
    });
  }
  if (D === 3) return generate(kind, count, { seed: SEED });
  return generate2d(kind === 'sphere' ? 'circle' : kind, count, { seed: SEED });
}
