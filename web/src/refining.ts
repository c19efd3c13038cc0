// What is checked before a mesh with constraints is refined.

import type { RefineOptions } from './answers.js';
import type { Coordinates, Indices, SignedIndices } from './arrays.js';
import type { Constrained } from './constrained.js';
import { GdelError } from './errors.js';
import { bad, checkArrays, checkInteger, optionsOf } from './options.js';
import type { Tasks } from './protocol.js';

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
}

/** Returns the task to refine a mesh. */
export function refineArgs(
  mesh: Refinable,
  options: RefineOptions | undefined,
): Tasks['refine']['args'] {
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
  return {
    points,
    mesh: { ...arrays, constraints: { edges, segments, inside } },
    options: { minAngle, maxArea, maxPoints, size: isList ? undefined : size, sizes },
    before: { added, moved, zeroLength },
  };
}
