// What is known of the speed of a device, by which the backend is chosen.

import { builtin } from './builtin.js';
import { load, save } from './kept.js';
import type { AdapterInfo, Backend } from './types.js';

/** Whether the CPU triangulates while kernels are compiled: Node may end meanwhile, and then crash. */
export const COMPILES_MEANWHILE = !builtin('node:worker_threads');

/** How long the database may take. */
const PATIENCE_MILLISECONDS = 300;

/** The functions of a dimension in WebAssembly. */
export interface SpeedOf {
  /** The number of points from which on a GPU is faster. */
  least(): number;
  /** Opens the device, and compiles the kernels, or begins to. */
  open(meanwhile: boolean): Promise<void>;
  /** Says why the CPU triangulates so many points, if it is sooner. */
  whyCpu(points: number): string | undefined;
  known(): Uint32Array;
  recall(known: Uint32Array): void;
}

/** Keeps what is known of the speed of a device for later visits. */
export class Speed {
  readonly #of: SpeedOf;
  readonly #dimension: number;
  #name: string | undefined;
  #kept: Uint32Array = new Uint32Array(0);

  constructor(dimension: number, of: SpeedOf) {
    this.#dimension = dimension;
    this.#of = of;
  }

  /** The number of coordinates from which on a GPU is faster. */
  get least(): number {
    return this.#dimension * this.#of.least();
  }

  /** Says why the CPU triangulates so many coordinates, if it is sooner. */
  whyCpu(coordinates: number): string | undefined {
    return this.#of.whyCpu(coordinates / this.#dimension);
  }

  /** Opens the device. Unless that is required, nobody waits for its kernels. */
  open(backend: Backend): Promise<void> {
    return this.#of.open(backend === 'auto' && COMPILES_MEANWHILE);
  }

  /** Recalls what was known of an adapter. */
  async recall({ vendor, architecture, device, description }: AdapterInfo): Promise<void> {
    const { userAgent } = globalThis.navigator ?? {};
    if (this.#name !== undefined || !globalThis.indexedDB) return;
    const parts = [VERSION, this.#dimension, vendor, architecture, device, description, userAgent];
    this.#name = parts.join();
    // A database that does not answer holds nobody up.
    const nothing = new Promise<void>((resolve) => setTimeout(resolve, PATIENCE_MILLISECONDS));
    const known = await Promise.race([load(this.#name), nothing]);
    if (known) this.#of.recall(known);
    this.#kept = this.#of.known();
  }

  /** How many meshes of the device have failed a check. */
  get wrongMeshes(): number {
    return this.#of.known()[0]! >> 1;
  }

  /** Keeps what is known now, if a run has told much. */
  keep(): void {
    if (this.#name === undefined) return;
    const known = this.#of.known();
    // The first word says whether the device has passed its test, and how many meshes were wrong.
    const isOld = (word: number, i: number) =>
      i > 0 ? word > 0.9 * (this.#kept[i] ?? Infinity) : word === this.#kept[0];
    if (known.every(isOld)) return;
    this.#kept = known;
    void save(this.#name, known);
  }
}
