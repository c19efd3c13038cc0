// What functions are given that return their result at once.

import { GdelError } from './errors.js';
import { checkFunction, optionsOf } from './options.js';
import { coordinatesNow } from './points.js';
import type { AccessorOptions } from './types.js';

/** Returns the coordinates of points of any form. */
export function coordinatesOf(points: unknown, dimension: number, options: object | undefined) {
  const { point, outputs: _, ...others } = optionsOf(options) as Record<string, unknown>;
  checkFunction('point', point);
  const [option] = Object.keys(others).filter((key) => others[key] !== undefined);
  if (option)
    throw new GdelError('BAD_INPUT', `synchronous functions do not have the option ${option}`);
  return coordinatesNow(points, {
    dimension,
    transfer: false,
    point: point as AccessorOptions<unknown>['point'] | undefined,
  });
}
