// Checks of what callers pass: whatever is wrong with it is a `GdelError` that says what.

import { isDetached } from './arrays.js';
import { GdelError } from './errors.js';
import type { ConstraintOptions, Output, TaskOptions } from './types.js';

/** Returns a value for a message: its class and length, or what it is. */
export function nameOf(value: unknown): string {
  if (typeof value === 'object' && value !== null) {
    const { constructor, length } = value as { constructor?: { name?: unknown }; length?: unknown };
    const name = typeof constructor?.name === 'string' ? constructor.name : 'an object';
    return typeof length === 'number' ? `${name} of length ${length}` : name;
  }
  return typeof value === 'string' ? JSON.stringify(value.slice(0, 40)) : String(value);
}

export function bad(what: string, mustBe: string, value: unknown): GdelError {
  return new GdelError('BAD_INPUT', `${what} must be ${mustBe}, not ${nameOf(value)}`);
}

/** Returns options, which may be left out but are otherwise an object. */
export function optionsOf<T extends object>(options: T | undefined): Partial<T> {
  if (options === undefined) return {};
  if (typeof options !== 'object' || options === null || Array.isArray(options))
    throw bad('the options', 'an object', options);
  return options;
}

/** Returns whether there are constraints. */
export const hasConstraints = ({ edges, rings, polygons }: ConstraintOptions): boolean =>
  Boolean(edges ?? rings ?? polygons);

/** Returns an argument that has to be an object. */
export function objectOf<T>(what: string, value: T): T & object {
  if (typeof value !== 'object' || value === null) throw bad(what, 'an object', value);
  return value;
}

/** Returns the options that all tasks have. */
export function taskOptions({ signal, onProgress }: TaskOptions): TaskOptions {
  if (signal !== undefined && !isSignal(signal))
    throw bad('the option signal', 'an AbortSignal', signal);
  checkFunction('onProgress', onProgress);
  return { signal, onProgress };
}

/** Returns whether a value works as an `AbortSignal`, of whatever realm. */
function isSignal(value: unknown): value is AbortSignal {
  if (typeof value !== 'object' || value === null) return false;
  const { aborted, addEventListener, removeEventListener } = value as Partial<AbortSignal>;
  return (
    typeof aborted === 'boolean' &&
    typeof addEventListener === 'function' &&
    typeof removeEventListener === 'function'
  );
}

export function checkFunction(option: string, value: unknown): void {
  if (value !== undefined && typeof value !== 'function')
    throw bad(`the option ${option}`, 'a function', value);
}

export function checkBoolean(option: string, value: unknown): void {
  if (value !== undefined && typeof value !== 'boolean')
    throw bad(`the option ${option}`, 'true or false', value);
}

/** Checks an integer. */
export function checkInteger(what: string, value: unknown, low: number, high: number): void {
  if (!Number.isInteger(value) || (value as number) < low || (value as number) > high)
    throw bad(what, `an integer from ${low} to ${high}`, value);
}

/** Checks that the arrays of a mesh are still there. */
export function checkArrays(arrays: object): void {
  for (const [name, array] of Object.entries(arrays)) {
    if (ArrayBuffer.isView(array) && isDetached(array))
      throw new GdelError('BAD_INPUT', `the mesh’s ${name} are detached: they were transferred`);
  }
}

/** Checks a word of a list. */
export function checkOneOf(option: string, value: unknown, words: readonly string[]): void {
  if (!words.includes(value as string)) throw bad(option, `one of ${words.join(', ')}`, value);
}

const OUTPUTS: readonly Output[] = ['neighbors', 'hull', 'duplicateOf', 'trace'];

/** Returns the arrays that a run in 3D is to return. */
export function outputsOf({ outputs }: { outputs?: readonly Output[] | undefined }): Output[] {
  if (outputs === undefined) return OUTPUTS.filter((output) => output !== 'trace');
  if (!Array.isArray(outputs))
    throw bad('outputs', `an array of any of ${OUTPUTS.join(', ')}`, outputs);
  for (const output of outputs) checkOneOf('each of the outputs', output, OUTPUTS);
  return [...outputs];
}
