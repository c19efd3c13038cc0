import assert from 'node:assert/strict';

/** Asserts that a number is the expected one up to half a unit in this decimal place. */
export function closeTo(found: number, expected: number, digits: number): void {
  const tolerance = 0.5 * 10 ** -digits;
  assert.ok(
    Math.abs(found - expected) < tolerance,
    `${found} is not within ${tolerance} of ${expected}`,
  );
}
