// Which backend a run uses.

import type { Coordinates } from './arrays.js';
import { type PlainError, toPlainError } from './errors.js';
import type { CoreInfo } from './protocol.js';
import { COMPILES_MEANWHILE, type Speed } from './speed.js';
import type { AdapterInfo, Backend } from './types.js';

/** What is used of a GPU object. */
export interface Gpu {
  /** Whether it stands for a device of the caller's, which is not given back. */
  isGiven?: boolean;
  requestAdapter(options?: object): Promise<Adapter | null>;
}

/** What is used of a `GPUAdapter`. */
export interface Adapter {
  info: {
    vendor: string;
    architecture: string;
    device: string;
    description: string;
    isFallbackAdapter?: boolean;
  };
  limits: { maxStorageBufferBindingSize: number; maxBufferSize: number };
  requestDevice(descriptor?: object): Promise<object>;
}

/** Chooses between the GPU and the CPU, by the adapter that it looks for once. */
export class BackendChoice {
  readonly #gpu: Gpu | undefined;
  readonly #memory: WebAssembly.Memory;
  #looking: Promise<AdapterInfo> | undefined;

  constructor(gpu: Gpu | undefined, memory: WebAssembly.Memory) {
    this.#gpu = gpu;
    this.#memory = memory;
  }

  /**
   * Returns what `backend` would use. The Rust library also chooses, but it does not see all names
   * of an adapter.
   */
  async choose(backend: Backend): Promise<CoreInfo> {
    let adapter: AdapterInfo | null = null;
    try {
      adapter = await (this.#looking ??= look(this.#gpu));
      if (backend === 'auto' && adapter.software) {
        const name = [adapter.vendor, adapter.architecture, adapter.description]
          .filter(Boolean)
          .join(' ');
        return {
          backend: 'cpu',
          fallback: `the GPU adapter (${name}) is software, which is slower than the CPU backend`,
          adapter,
        };
      }
      return { backend: 'gpu', fallback: null, adapter };
    } catch (thrown) {
      this.#looking = undefined;
      const error = toPlainError(thrown, this.#memory.buffer.byteLength);
      if (backend === 'gpu' || error.fatal) throw thrown;
      return { backend: 'cpu', fallback: error.message, adapter };
    }
  }

  /** Opens the device that `backend` would use. Returns what it uses then. */
  async open(backend: Backend, speed: Speed): Promise<CoreInfo> {
    const info = await this.choose(backend);
    if (info.backend === 'cpu') return info;
    try {
      await speed.recall(info.adapter!);
      await speed.open(backend);
      return info;
    } catch (thrown) {
      const error = toPlainError(thrown, this.#memory.buffer.byteLength);
      if (backend === 'gpu' || error.fatal) throw thrown;
      return { ...info, backend: 'cpu', fallback: error.message };
    }
  }

  /** Returns what `backend` uses for these points, or null where it is the CPU without looking for an adapter. */
  async decide(backend: Backend, { length }: Coordinates, speed: Speed): Promise<CoreInfo | null> {
    if (backend === 'cpu' || (backend === 'auto' && length < speed.least)) return null;
    if (!COMPILES_MEANWHILE) return this.choose(backend);
    const info = await this.open(backend, speed);
    const fallback = backend === 'auto' && info.backend === 'gpu' && speed.whyCpu(length);
    return fallback ? { ...info, backend: 'cpu', fallback } : info;
  }
}

/** Looks for an adapter. */
async function look(gpu: Gpu | undefined): Promise<AdapterInfo> {
  const none = (message: string): PlainError => ({ code: 'NO_ADAPTER', message, fatal: false });
  if (!gpu) throw none('WebGPU is not available here (there is no navigator.gpu)');
  try {
    const adapter = await gpu.requestAdapter({ powerPreference: 'high-performance' });
    if (adapter) return describe(adapter);
  } catch (error) {
    throw none(`WebGPU failed to look for an adapter: ${String(error)}`);
  }
  throw none('WebGPU has no adapter here');
}

/**
 * Describes an adapter. Chromium sets `isFallbackAdapter`; the names are those of the software
 * rasterisers of browsers, Mesa and Windows.
 */
function describe({ info, limits }: Adapter): AdapterInfo {
  const { vendor, architecture, device, description } = info;
  const software = /swiftshader|llvmpipe|lavapipe|softpipe|warp|basic render/i;
  return {
    vendor,
    architecture,
    device,
    description,
    software:
      info.isFallbackAdapter === true ||
      software.test([vendor, architecture, device, description].join(' ')),
    maxStorageBufferBindingSize: Math.min(limits.maxStorageBufferBindingSize, limits.maxBufferSize),
  };
}
