// Refinement of meshes with constraints: a part of the code that is loaded when it is used.

import { moduleEdit } from '#assets';
import type { RefineOptions } from './answers.js';
import type { Coordinates, Indices, SignedIndices } from './arrays.js';
import { Constrained } from './constrained.js';
import { GdelError } from './errors.js';
import { bad, checkArrays, checkInteger, optionsOf, taskOptions } from './options.js';
import type { Done } from './protocol.js';
import { runShared } from './shared.js';
import type { Place } from './types.js';

/** A mesh with constraints. */
interface Refinable {
  triangles: Indices;
  halfedges: SignedIndices;
  hull: Indices;
  duplicateOf: SignedIndices;
  dimension: number;
  constraints: Constrained | null;
  coords: Coordinates;
  factors: readonly number[] | null;
  stats: Place;
}

/** The class of a mesh, which is made of what a run returns and a function that updates it. */
type Class<M> = new (done: Done<'delaunay2d'>, update: () => Promise<never>) => M;

/** Returns a mesh of a class with points added until its triangles inside are as asked for. */
export async function refine<M>(
  mesh: Refinable,
  options: RefineOptions | undefined,
  Made: Class<M>,
): Promise<M> {
  const { minAngle, maxArea, maxPoints, size } = optionsOf(options);
  for (const [name, value] of Object.entries({ minAngle, maxArea }))
    if (value !== undefined && typeof value !== 'number')
      throw bad(`the option ${name}`, 'a number', value);
  if (maxPoints !== undefined) checkInteger('the option maxPoints', maxPoints, 0, 2 ** 32 - 1);
  const isList = Array.isArray(size) || ArrayBuffer.isView(size);
  if (size !== undefined && typeof size !== 'number' && !isList)
    throw bad('the option size', 'a number, or one for each point', size);
  const { triangles, halfedges, hull, duplicateOf, dimension, constraints, coords: points } = mesh;
  if (!constraints || mesh.factors)
    throw new GdelError('BAD_INPUT', 'only meshes with constraints can be refined');
  const { edges, segments, inside, added, moved, zeroLength } = constraints;
  const arrays = { triangles, halfedges, hull, duplicateOf, dimension };
  checkArrays({ points, ...arrays, edges, segments, inside });
  const sizes = isList ? Float64Array.from(size as ArrayLike<number>) : undefined;
  const wanted = { minAngle, maxArea, maxPoints, size: isList ? undefined : size, sizes };
  const args = {
    points,
    mesh: { ...arrays, constraints: { edges, segments, inside } },
    options: wanted,
  };
  const result = await runShared(moduleEdit, 'refine', args, taskOptions(optionsOf(options)));
  const made = result.constraints!;
  // Points at crossings were added before.
  const all = { ...made, added: made.added + added, moved, zeroLength };
  const { thread, whyThread, whyInlined } = mesh.stats;
  return new Made(
    {
      result: { ...result, constraints: new Constrained(all, result.duplicateOf) },
      place: { thread, whyThread, whyInlined },
    },
    // Meshes with constraints are not updated.
    () => Promise.reject(new GdelError('BAD_INPUT', 'meshes with constraints cannot be changed')),
  );
}
