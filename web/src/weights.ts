// Weights of points.

import type { Doubles } from './arrays.js';
import { GdelError } from './errors.js';
import { bad } from './options.js';

/**
 * Returns one weight per point, for radii their squares; undefined if the options have neither.
 */
export function weightsOf(
  { weights, radii }: { weights?: unknown; radii?: unknown },
  points: number,
): Doubles | undefined {
  const given = weights ?? radii;
  if (given === undefined) return undefined;
  if (weights !== undefined && radii !== undefined)
    throw bad('the option radii', 'left out beside the option weights', radii);
  const areRadii = radii !== undefined;
  const name = areRadii ? 'radii' : 'weights';
  if (!Array.isArray(given) && !ArrayBuffer.isView(given))
    throw bad(`the option ${name}`, 'an array of numbers', given);
  const values = Float64Array.from(given as ArrayLike<number>, (x) =>
    typeof x === 'number' ? x : Number.NaN,
  );
  if (values.length !== points)
    throw new GdelError('BAD_INPUT', `there are ${values.length} ${name} for ${points} points`);
  const index = values.findIndex((x) => !Number.isFinite(x) || (areRadii && x < 0));
  if (index >= 0) {
    const mustBe = areRadii ? 'a finite number from 0 on' : 'a finite number';
    const message = `${areRadii ? 'radius' : 'weight'} ${index} is ${values[index]}, not ${mustBe}`;
    throw new GdelError('BAD_INPUT', message, { index });
  }
  return areRadii ? values.map((r) => r * r) : values;
}

/** Checks that a mesh has no constraints. */
export function checkUnconstrained({
  constraints,
}: {
  constraints?: object | null | undefined;
}): void {
  if (constraints)
    throw new GdelError('BAD_INPUT', 'this is not possible with a mesh that has constraints');
}

/** Checks that no point was removed. */
export function checkAllUsed({ duplicateOf }: { duplicateOf: Int32Array }): void {
  if (duplicateOf.some((of, i) => of === i))
    throw new GdelError('BAD_INPUT', 'the mesh has points that were removed: call compact first');
}

/** Checks that a mesh is a Delaunay triangulation, as its changes need. */
export function checkDelaunay(mesh: {
  weights: Doubles | null;
  constraints?: object | null;
}): void {
  if (mesh.weights)
    throw new GdelError('BAD_INPUT', 'this is not possible with a mesh of weighted points');
  checkUnconstrained(mesh);
}
