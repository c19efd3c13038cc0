import type { Coordinates } from './arrays.js';

/** What kind of failure a {@link GdelError} is. */
export type GdelErrorCode =
  /** A coordinate is NaN or infinite; `index` is the first such point. */
  | 'NOT_FINITE'
  /** An argument has the wrong type, length or value. */
  | 'BAD_INPUT'
  /** Constraints cross where there is no point; `pairs` are the first of them. */
  | 'CROSSING_CONSTRAINTS'
  /** There are more points than can be triangulated. */
  | 'TOO_MANY_POINTS'
  /**
   * There are more tetrahedra or triangles than can be numbered, which only contrived input has.
   */
  | 'TOO_MANY_TETRAHEDRA'
  /** The `signal` was aborted. */
  | 'ABORTED'
  /** `backend: 'gpu'` was requested, but there is no WebGPU adapter, or it cannot be opened. */
  | 'NO_ADAPTER'
  /** The GPU was reset or removed during the run. The next run reopens it. */
  | 'DEVICE_LOST'
  /** The GPU ran out of memory. */
  | 'OUT_OF_DEVICE_MEMORY'
  /** A buffer would be larger than this adapter allows. */
  | 'BUFFER_TOO_LARGE'
  /** The GPU or its driver reported an unexpected error. */
  | 'GPU'
  /** The GPU or its driver computes wrong results, which a test or a check has noticed. */
  | 'GPU_WRONG'
  /** WebAssembly ran out of memory, of which there is at most 4 GB. */
  | 'OUT_OF_MEMORY'
  /** A file is broken; the message says where. */
  | 'BAD_FILE'
  /** There is no reader or writer for this file name or format. */
  | 'UNKNOWN_FORMAT'
  /**
   * WebAssembly cannot be loaded: the file and its copy are missing, or a Content-Security-Policy
   * lacks `'wasm-unsafe-eval'`. Or the worker was started, but never answered. The message says
   * what to do.
   */
  | 'LOAD_FAILED'
  /**
   * A synchronous function was called before the module was loaded: `load3d()`, `load2d()` or
   * `Delaunator.load()`.
   */
  | 'NOT_LOADED'
  /** The triangulator was disposed of. */
  | 'DISPOSED'
  /** A bug in this package. */
  | 'INTERNAL';

/** The errors for which a device is to blame. */
export const GPU_ERRORS: ReadonlySet<GdelErrorCode> = new Set([
  'NO_ADAPTER',
  'DEVICE_LOST',
  'OUT_OF_DEVICE_MEMORY',
  'BUFFER_TOO_LARGE',
  'GPU',
  'GPU_WRONG',
]);

/**
 * The error of every failure in this package. Only errors of your own stay what they are: what
 * `point` or `onProgress` throws, and the reason that you give to `AbortController.abort`.
 */
export class GdelError extends Error {
  override readonly name = 'GdelError';
  /** The kind of failure, for programs to test. The message is for people. */
  readonly code: GdelErrorCode;
  /** The index of the point that caused the failure, if a point did. */
  declare readonly index?: number;
  /** The segments that cross, in the order of the input: at most 16 pairs, each segment as its two ends. */
  declare readonly pairs?: [[number, number], [number, number]][];
  /** The coordinates that were given away by `transfer: true`, given back. */
  declare readonly points?: Coordinates;

  constructor(
    code: GdelErrorCode,
    message: string,
    options: Pick<PlainError, 'index' | 'pairs'> & { cause?: unknown } = {},
  ) {
    super(message, 'cause' in options ? { cause: options.cause } : undefined);
    this.code = code;
    if (options.index !== undefined) this.index = options.index;
    if (options.pairs !== undefined) this.pairs = options.pairs;
  }
}

/** An error in a form that survives `postMessage`. */
export interface PlainError {
  code: GdelErrorCode;
  message: string;
  index?: number | undefined;
  pairs?: GdelError['pairs'] | undefined;
  /** The WebAssembly instance is broken and must not be used again. */
  fatal: boolean;
  /** The points that the run was given. */
  points?: Coordinates;
}

export function toGdelError({ code, message, ...details }: PlainError): GdelError {
  return new GdelError(code, message, details);
}

/** Calls a function whose errors may be plain, or those of another file of the package. */
export function thrown<R>(run: () => R): R {
  try {
    return run();
  } catch (error) {
    throw toGdelError(error as PlainError);
  }
}

/** Gives coordinates back, in a property that consoles do not print: there can be millions. */
export function giveBack(error: GdelError, points: Coordinates): void {
  Object.defineProperty(error, 'points', { value: points });
}

/**
 * Converts what WebAssembly threw. Errors of the bindings have a `code`; everything else is a panic
 * or a trap, which ends the instance.
 */
export function toPlainError(thrown: unknown, memoryBytes: number): PlainError {
  const { code, message, index, pairs, fatal } = (
    typeof thrown === 'object' && thrown ? thrown : {}
  ) as Partial<PlainError>;
  if (typeof code === 'string') {
    return {
      code,
      message: String(message),
      index,
      pairs,
      // What another thread threw says so.
      fatal: fatal ?? code === 'BAD_FILE',
    };
  }
  // Rust traps without a message if an allocation fails: so a trap in a memory of nearly 4 GB
  // counts as that.
  if (thrown instanceof WebAssembly.RuntimeError && memoryBytes > 3 * 2 ** 30) {
    return {
      code: 'OUT_OF_MEMORY',
      message: `WebAssembly ran out of memory, of which it has ${memoryBytes} bytes`,
      fatal: true,
    };
  }
  return {
    code: 'INTERNAL',
    message: `a bug in gdel-wasm: ${message ?? String(thrown)}`,
    fatal: true,
  };
}
