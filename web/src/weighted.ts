// The arguments of tasks with weights. A part of the code that is loaded when it is needed.

import type { BallOptions } from './answers.js';
import type { Coordinates, Doubles } from './arrays.js';
import { GdelError } from './errors.js';
import { bad, optionsOf } from './options.js';
import type { DerivedArgs, Tasks } from './protocol.js';
import type { MoveOptions, Stats } from './types.js';
import { checkAllUsed, checkUnconstrained, weightsOf } from './weights.js';

/**
 * Returns the task to triangulate the points of a mesh, or as many others, with the weights of the options or those of
 * the mesh.
 */
export function regularArgs(
  { dimension, points, mesh, factors }: DerivedArgs & { factors: readonly number[] | null },
  options: MoveOptions,
  own: Coordinates,
): Tasks['regular']['args'] {
  checkUnconstrained(mesh);
  const count = points.length / dimension;
  const weights = weightsOf(options, count) ?? mesh.weights!;
  if (factors)
    throw bad('the weights', 'left out, since the points were rescaled', options.weights);
  checkAllUsed(mesh);
  if (own.length !== points.length)
    throw new GdelError('BAD_INPUT', `the mesh has ${count} points, not ${own.length / dimension}`);
  const outputs = ['neighbors', 'hull', 'duplicateOf'] as const;
  return { dimension, points: own, weights, outputs };
}

/** Returns what a mesh takes over of a run with weights, which the thread of the run before has made. */
export function madeOf(
  result: Tasks['regular']['result'],
  { points, weights }: Tasks['regular']['args'],
  stats: Stats,
) {
  const kept = result.hidden ? weights : null;
  return { result: { ...result, points }, place: placeOf(stats), weights: kept };
}

/** Returns what stats say of the thread. */
export function placeOf({ thread, whyThread, whyInlined }: Stats) {
  return { thread, whyThread, whyInlined };
}

/** Returns what the complex of the balls around the points of a mesh needs beside these. */
export function ballArgs(
  { dimension, points, mesh }: DerivedArgs,
  options: BallOptions | undefined,
): { alpha: number; weights: Doubles } {
  const { alpha = 0, weights, radii } = optionsOf(options);
  if (!(typeof alpha === 'number' && alpha >= 0))
    throw bad('the option alpha', 'a number that is not negative', alpha);
  const given = weightsOf({ weights, radii }, points.length / dimension);
  return { alpha, weights: given ?? mesh.weights ?? new Float64Array(0) };
}
