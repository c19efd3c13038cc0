// The tasks of the module that finds weights with which cells have given volumes, treemaps of such cells, and the alpha
// complex of balls.

import makeGlue from 'glue:transport';
import type { Doubles } from './arrays.js';
import { blockingInstance } from './blocking.js';
import { type Core, coreOf, type ReportProgress, reporting } from './core.js';
import { instantiate } from './instance.js';
import { layOut, type PowerCells, type Solver } from './nested.js';
import type { PowerTask, Tasks } from './protocol.js';

type Glue = ReturnType<typeof makeGlue>;

const solverOf = (glue: Glue, report: ReportProgress): Solver => ({
  weights(points, corners, masses, tolerance, [start, length]) {
    const options = { normalize: true, tolerance };
    return glue.transport(
      2,
      points,
      'corners',
      corners,
      masses,
      options,
      (phase: string, fraction: number) => report(phase, start + length * fraction),
    );
  },
  cells: (points, weights, corners): PowerCells => glue.powerCells(points, weights, corners),
  hull: (points) => glue.hullOf(points) as Doubles,
  sites: (corners, masses) => glue.sitesByHalves(corners, masses) as Doubles,
});

/** What does the tasks with cells in the plane. */
const tasksWith = (glue: Glue, report: ReportProgress) => ({
  treemap: (task: Tasks['treemap']['args']) => layOut(task, solverOf(glue, report)),
  powerCells({ points, weights, corners }: Tasks['powerCells']['args']) {
    const solver = solverOf(glue, report);
    return solver.cells(points, weights, solver.hull(corners));
  },
});

/** Returns a function that does a task before it returns; it throws a `PlainError`. */
export function createBlocking(module: WebAssembly.Module) {
  const instance = blockingInstance(() => instantiate(makeGlue, module));
  return <T extends PowerTask>(task: T, args: Tasks[T]['args']): Tasks[T]['result'] =>
    instance((glue) => {
      const run = tasksWith(glue, () => false)[task] as (args: object) => Tasks[T]['result'];
      return run(args);
    });
}

export function openCore(module: WebAssembly.Module): Core {
  const { glue, memory } = instantiate(makeGlue, module);
  return coreOf({
    memory,
    handlers: {
      async transport({ dimension, points, clip, bounds, masses, options }, control) {
        control.onBlocking();
        const report = reporting(control);
        return glue.transport(dimension, points, clip, bounds, masses, options, report);
      },
      async ballComplex({ dimension, points, mesh, weights, alpha }, control) {
        control.onBlocking();
        const report = reporting(control);
        const complex = glue.ballComplex(dimension, points, mesh, weights, alpha, report);
        control.onProgress({ phase: 'alpha', fraction: 1 });
        return complex;
      },
      async treemap(task, control) {
        control.onBlocking();
        return tasksWith(glue, reporting(control)).treemap(task);
      },
      async powerCells(task, control) {
        control.onBlocking();
        return tasksWith(glue, reporting(control)).powerCells(task);
      },
    },
  });
}
