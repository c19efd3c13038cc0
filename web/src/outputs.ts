// The arrays of a 3D mesh that a run returns.

import type { Tasks } from './protocol.js';
import type { Output } from './types.js';

/** What the glue of a module with 3D meshes has. */
interface WithOutputs<Outputs> {
  Outputs: new (
    neighbors: boolean,
    hull: boolean,
    duplicateOf: boolean,
    trace: boolean,
    vertexSimplex: boolean,
  ) => Outputs;
}

/** Returns what a run takes for the arrays that it is to return. */
export function outputsFor<Outputs>(
  { Outputs }: WithOutputs<Outputs>,
  outputs: readonly Output[],
  vertexSimplex = false,
): Outputs {
  const has = (output: Output) => outputs.includes(output);
  return new Outputs(
    has('neighbors'),
    has('hull'),
    has('duplicateOf'),
    has('trace'),
    vertexSimplex,
  );
}

/** Adds empty arrays for those that were not requested. */
export function withEmpty<M extends Partial<Tasks['delaunay3d']['result']>>(mesh: M): M {
  mesh.neighbors ??= new Int32Array(0);
  mesh.hull ??= new Uint32Array(0);
  mesh.duplicateOf ??= new Int32Array(0);
  return mesh;
}

/** Returns the arrays of a 3D mesh that were requested, and empty ones for the others. */
export function onlyOutputs<M extends object>(arrays: M, outputs: readonly Output[]): M {
  const kept = Object.entries(arrays).filter(([name]) => outputs.includes(name as Output));
  return withEmpty(Object.fromEntries(kept) as Partial<Tasks['delaunay3d']['result']>) as M;
}
