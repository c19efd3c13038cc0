// The tasks of the module for meshes in the memory of the CPU that gain and lose points, and for
// those of weighted points, and those with constraints.

import makeGlue from 'glue:edit';
import type { Coordinates } from './arrays.js';
import { blockingInstance } from './blocking.js';
import { Constrained } from './constrained.js';
import { constraintsOf, type Segments } from './constraints.js';
import { type Core, coreOf, type ReportProgress, reporting, statsOfCpu } from './core.js';
import { extrasOf } from './extras.js';
import { coordinatesOf } from './given.js';
import { instantiate } from './instance.js';
import { outputsFor, withEmpty } from './outputs.js';
import type { Tasks } from './protocol.js';
import { refineArgs } from './refining.js';
import { inWorkers, joinTiles } from './tiles.js';
import { tinArgs } from './tin-args.js';
import type { ConstraintOptions } from './types.js';
import { ballArgs, madeOf, placeOf, regularArgs } from './weighted.js';

export { ballArgs, extrasOf, inWorkers, madeOf, placeOf, refineArgs, regularArgs, tinArgs };

/** Returns a result whose constraints have methods, which cannot be sent from a worker. */
export const withConstraints = (result: Tasks['constrained']['result']) => ({
  ...result,
  constraints: new Constrained(result.constraints!, result.duplicateOf),
});

type Glue = ReturnType<typeof makeGlue>;

/** Triangulates points with constraints. */
const constrained = (
  glue: Glue,
  points: Coordinates,
  { edges, boundary, holes, fill, isSplit }: Segments,
  report: ReportProgress,
): Tasks['constrained']['result'] => ({
  points,
  ...glue.constrained_triangulation(points, edges, boundary, holes, fill, isSplit, report),
});

/** Returns a function that triangulates with constraints before it returns; it throws a `PlainError`. */
export function createBlocking(module: WebAssembly.Module) {
  const instance = blockingInstance(() => instantiate(makeGlue, module));
  return (points: unknown, options: ConstraintOptions) => {
    const { edges, rings, polygons, holes, fill, crossings, ...others } = options;
    const constraints = { edges, rings, polygons, holes, fill, crossings };
    const given = constraintsOf(constraints, coordinatesOf(points, 2, others));
    return withConstraints(
      instance((glue) => constrained(glue, given.points, given.segments, () => false)),
    );
  };
}

export function openCore(module: WebAssembly.Module): Core {
  const { glue, memory } = instantiate(makeGlue, module);
  let tile: InstanceType<Glue['WasmTile']> | undefined;
  let report: ReportProgress = () => false;
  return coreOf({
    memory,
    handlers: {
      async splitPoints({ dimension, points, tiles }) {
        return { points, ...glue.splitPoints(dimension, points, tiles) };
      },
      async stepTile({ begin, messages }, control) {
        report = reporting(control);
        if (begin) {
          const { dimension, plan, number, points, indices } = begin;
          const ofStep: ReportProgress = (...progress) => report(...progress);
          // One that was given up.
          tile?.free();
          tile = undefined;
          tile = new glue.WasmTile(dimension, plan, number, points, indices, ofStep);
        }
        return { messages: tile!.step(messages) };
      },
      async finishTile() {
        const { stats, ...finished } = tile!.finish();
        return { ...finished, stats: statsOfCpu(stats, performance.now(), memory) };
      },
      async takeTile({ base }) {
        const taken = tile!.take(base);
        tile = undefined;
        return taken;
      },
      async joinTiles(args) {
        const own = tile!;
        tile = undefined;
        return joinTiles(args, {
          copyTo: (simplices, neighbors) => own.copyTo(simplices, neighbors),
          link: glue.joinTiles,
        });
      },
      async change({ dimension, points, before, mesh: given, removed, outputs }, control) {
        const started = performance.now();
        control.onBlocking();
        const wanted = outputsFor(glue, outputs);
        const report = reporting(control);
        const mesh = glue.change(dimension, points, before, given, removed, wanted, report);
        if (dimension === 3) withEmpty(mesh);
        return { points, ...mesh, stats: statsOfCpu(mesh.stats, started, memory) };
      },
      async regular({ dimension, points, weights, outputs }, control) {
        const started = performance.now();
        control.onBlocking();
        const wanted = outputsFor(glue, outputs);
        const report = reporting(control);
        const mesh = glue.regular_triangulation(dimension, points, weights, wanted, report);
        if (dimension === 3) withEmpty(mesh);
        return { points, ...mesh, stats: statsOfCpu(mesh.stats, started, memory) };
      },
      async constrained({ points, backend, segments }, control) {
        const started = performance.now();
        control.onBlocking();
        const report = reporting(control);
        const mesh = constrained(glue, points, segments, report);
        const stats = statsOfCpu(mesh.stats, started, memory);
        if (backend !== 'cpu') stats.fallback = 'there are constraints, which only the CPU takes';
        return { ...mesh, stats };
      },
      async refine({ points, mesh, options, before }, control) {
        const started = performance.now();
        control.onBlocking();
        const refined = glue.refine(points, mesh, options);
        // Points at crossings were added before.
        const { constraints } = refined;
        Object.assign(constraints, before, { added: constraints.added + before.added });
        return { points, ...refined, stats: statsOfCpu(refined.stats, started, memory) };
      },
      async tin({ points, segments, options }, control) {
        control.onBlocking();
        return glue.tin(points, segments, options, reporting(control));
      },
    },
  });
}
