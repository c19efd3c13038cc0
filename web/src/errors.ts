/** What kind of failure a {@link GdelError} is. */
export type GdelErrorCode =
  /** A coordinate is NaN or infinite; `index` is the first such point. */
  | 'NOT_FINITE'
  /** An argument has the wrong type, length or value. */
  | 'BAD_INPUT'
  /** More points than an engine can number. */
  | 'TOO_MANY_POINTS'
  /** More tetrahedra than an engine can number, which only contrived input has. */
  | 'TOO_MANY_TETRAHEDRA'
  /** The `signal` was aborted. */
  | 'ABORTED'
  /** `engine: 'gpu'` was asked for, but there is no WebGPU adapter or it gives no device. */
  | 'NO_ADAPTER'
  /** The GPU was reset or taken away during the run. The next run opens it anew. */
  | 'DEVICE_LOST'
  /** The GPU has not enough memory. */
  | 'OUT_OF_DEVICE_MEMORY'
  /** A buffer would exceed what this adapter can bind. */
  | 'BUFFER_TOO_LARGE'
  /** The GPU or its driver reports what should not happen. */
  | 'GPU'
  /** WebAssembly's memory, at most 4 GB, does not suffice. */
  | 'OUT_OF_MEMORY'
  /** A file is broken; the message says where. */
  | 'BAD_FILE'
  /** No reader or writer for this name or format. */
  | 'UNKNOWN_FORMAT'
  /** WebAssembly cannot be loaded: the file is not there, or a Content-Security-Policy lacks `'wasm-unsafe-eval'`. */
  | 'LOAD_FAILED'
  /** A `Delaunator` was made before the promise of `Delaunator.load()` was fulfilled. */
  | 'NOT_LOADED'
  /** The engine was disposed of. */
  | 'DISPOSED'
  /** A defect of this package. */
  | 'INTERNAL';

/** Every failure of this package, except that of an aborted run whose signal has an own reason. */
export class GdelError extends Error {
  override readonly name = 'GdelError';
  /** What kind of failure it is: for programs, as the message is for people. */
  readonly code: GdelErrorCode;
  /** The point that is to blame, by its index in the input, where there is one. */
  declare readonly index?: number;

  constructor(
    code: GdelErrorCode,
    message: string,
    options: { index?: number; cause?: unknown } = {},
  ) {
    super(message, 'cause' in options ? { cause: options.cause } : undefined);
    this.code = code;
    if (options.index !== undefined) this.index = options.index;
  }
}

/** An error in a form that survives `postMessage`. */
export interface PlainError {
  code: GdelErrorCode;
  message: string;
  index?: number;
  /** The WebAssembly instance is broken and must not be used again. */
  fatal: boolean;
}

export function toGdelError({ code, message, index }: PlainError): GdelError {
  return new GdelError(code, message, index === undefined ? {} : { index });
}

/** What the surface in Rust throws has a `code`; all else is a panic or a trap, which ends the instance. */
export function toPlainError(thrown: unknown, memoryBytes: number): PlainError {
  const { code, message, index } = (
    typeof thrown === 'object' && thrown ? thrown : {}
  ) as Partial<PlainError>;
  if (typeof code === 'string') {
    return {
      code,
      message: String(message),
      ...(index === undefined ? {} : { index }),
      fatal: code === 'BAD_FILE',
    };
  }
  // Rust aborts without a word where an allocation fails: a trap in a memory near its 4 GB is taken for that.
  if (thrown instanceof WebAssembly.RuntimeError && memoryBytes > 3 * 2 ** 30) {
    return {
      code: 'OUT_OF_MEMORY',
      message: `WebAssembly's memory of ${memoryBytes} bytes does not suffice`,
      fatal: true,
    };
  }
  return {
    code: 'INTERNAL',
    message: `a defect of gdel-wasm: ${message ?? String(thrown)}`,
    fatal: true,
  };
}
