// Typed arrays of any realm: those of an iframe, of a `vm` context or of jest are no instances of
// our classes, but work just as well.

/** A `Uint8Array` of a result. It owns its memory, so that `Blob`s and `postMessage` take it. */
export type Bytes = ReturnType<Uint8Array['slice']>;
/** A `Uint32Array` of a result, which owns its memory as {@link Bytes} do. */
export type Indices = ReturnType<Uint32Array['slice']>;
/** An `Int32Array` of a result, which owns its memory as {@link Bytes} do. */
export type SignedIndices = ReturnType<Int32Array['slice']>;
/** A `Float64Array` of a result, which owns its memory as {@link Bytes} do. */
export type Doubles = ReturnType<Float64Array['slice']>;
/** Coordinates of points, one point after the other, which own their memory as {@link Bytes} do. */
export type Coordinates = ReturnType<Float32Array['slice']> | Doubles;

const TYPED_ARRAY: object = Object.getPrototypeOf(Uint8Array.prototype);
const kindGetter = Object.getOwnPropertyDescriptor(TYPED_ARRAY, Symbol.toStringTag)!.get!;

/** Returns the name of the class of a typed array, and undefined for everything else. */
export function kindOf(value: unknown): string | undefined {
  return kindGetter.call(value);
}

/** Returns whether a value is an `ArrayBuffer`, which unlike shared memory can be transferred. */
export function isArrayBuffer(value: unknown): value is ArrayBuffer {
  return Object.prototype.toString.call(value) === '[object ArrayBuffer]';
}

/** Returns whether the memory of an array was transferred to somebody else. */
export function isDetached(array: ArrayBufferView): boolean {
  try {
    new Uint8Array(array.buffer);
    return false;
  } catch {
    return true;
  }
}

type TypedArray = ArrayBufferView & ArrayLike<number>;

/** Returns a typed array with the same memory that is an instance of this realm's class. */
export function inThisRealm<T extends ArrayBufferView>(array: T): T {
  type Class = new (buffer: ArrayBufferLike, offset: number, length: number) => T & TypedArray;
  const Own = (globalThis as unknown as Record<string, Class>)[kindOf(array)!]!;
  if (array instanceof Own) return array;
  return new Own(array.buffer, array.byteOffset, (array as T & TypedArray).length);
}

/** Replaces the typed arrays in a plain object, at any depth, by those of {@link inThisRealm}. */
export function allInThisRealm<T>(value: T): T {
  if (typeof value !== 'object' || value === null) return value;
  if (kindOf(value)) return inThisRealm(value as T & ArrayBufferView);
  for (const [key, item] of Object.entries(value)) {
    const own = allInThisRealm(item);
    if (own !== item) (value as Record<string, unknown>)[key] = own;
  }
  return value;
}

/** Returns the buffers of all typed arrays in a plain object, to be transferred. */
export function buffersOf(value: unknown): ArrayBuffer[] {
  const found = new Set<ArrayBuffer>();
  const visit = (value: unknown) => {
    if (ArrayBuffer.isView(value)) {
      if (isArrayBuffer(value.buffer)) found.add(value.buffer);
    } else if (typeof value === 'object' && value) {
      Object.values(value).forEach(visit);
    }
  };
  visit(value);
  return [...found];
}
