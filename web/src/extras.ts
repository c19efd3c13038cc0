// What a run can have beside points: weights or constraints. A part of the code that is loaded when there are some.

import type { Coordinates, Doubles } from './arrays.js';
import { constraintsOf, type Segments } from './constraints.js';
import { GdelError } from './errors.js';
import { bad, hasConstraints } from './options.js';
import type { ConstraintOptions, RunOptions } from './types.js';
import { weightsOf } from './weights.js';

/** All points of a run, and what it has beside them. */
export interface Extras {
  points: Coordinates;
  weights?: Doubles | undefined;
  segments?: Segments;
}

/** Returns the points with those of polygons after them, and the weights or the constraints. */
export function extrasOf(
  options: ConstraintOptions & Pick<RunOptions, 'weights' | 'radii' | 'resident' | 'rescale'>,
  points: Coordinates,
  dimension: number,
): Extras {
  const isConstrained = hasConstraints(options);
  if (isConstrained && dimension === 3)
    throw new GdelError('BAD_INPUT', 'constraints are possible in 2D only');
  const what = isConstrained ? 'constraints' : 'weights';
  for (const name of ['resident', 'rescale'] as const)
    if (options[name]) throw bad(`the option ${name}`, `left out beside ${what}`, options[name]);
  const weights = weightsOf(options, Math.floor(points.length / dimension));
  if (!isConstrained) return { points, weights };
  if (weights)
    throw new GdelError('BAD_INPUT', 'weights are not possible together with constraints');
  return constraintsOf(options, points);
}
