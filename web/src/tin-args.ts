// What is checked before terrain is made.

import type { Coordinates } from './arrays.js';
import { segmentsOf } from './constraints.js';
import { GdelError } from './errors.js';
import { bad, checkInteger } from './options.js';
import type { Tasks } from './protocol.js';
import type { ConstraintOptions } from './types.js';

/** Returns the task to make terrain of points. */
export function tinArgs(
  points: Coordinates,
  options: ConstraintOptions & { maxError?: unknown; maxPoints?: unknown },
): Tasks['tin']['args'] {
  const { maxError, maxPoints, ...constraints } = options;
  if (maxError === undefined && maxPoints === undefined)
    throw new GdelError('BAD_INPUT', 'one of the options maxError and maxPoints is needed');
  if (maxError !== undefined && typeof maxError !== 'number')
    throw bad('the option maxError', 'a number', maxError);
  if (maxPoints !== undefined) checkInteger('the option maxPoints', maxPoints, 0, 2 ** 32 - 1);
  if (constraints.polygons)
    throw new GdelError('BAD_INPUT', 'terrain has rings instead of polygons: points have heights');
  const segments = segmentsOf(constraints, points.length / 3);
  return { points, segments, options: { maxError, maxPoints } };
}
