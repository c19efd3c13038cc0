// The tasks of the module that derives something from a mesh.

import makeGlue from 'glue:derived';
import type { Doubles, SignedIndices } from './arrays.js';
import { type Core, coreOf, type ReportProgress, reporting } from './core.js';
import { instantiate } from './instance.js';
import type { Control, Tasks } from './protocol.js';

type DerivedTask =
  | 'locate'
  | 'nearest'
  | 'interpolate'
  | 'voronoi'
  | 'alphaShape'
  | 'surface'
  | 'spanningTree'
  | 'topology'
  | 'geometry';

export function openCore(module: WebAssembly.Module): Core {
  const { glue, memory } = instantiate(makeGlue, module);
  const tasks: {
    [T in DerivedTask]: (args: Tasks[T]['args'], report: ReportProgress) => Tasks[T]['result'];
  } = {
    locate: ({ dimension, points, mesh, queries }, report) =>
      glue.locate(dimension, points, mesh, queries, report),
    nearest: ({ dimension, points, mesh, queries, k }, report) =>
      glue.nearest(dimension, points, mesh, queries, k, report) as SignedIndices,
    interpolate: ({ dimension, points, mesh, queries, values, method }, report) =>
      glue.interpolate(dimension, points, mesh, queries, values, method, report) as Doubles,
    voronoi: ({ dimension, points, mesh, clip, bounds }, report) =>
      glue.voronoi(dimension, points, mesh, clip, bounds, report),
    alphaShape: ({ dimension, points, mesh, alpha, components, criticalValues }, report) =>
      glue.alphaShape(dimension, points, mesh, alpha, components, criticalValues, report),
    surface: ({ dimension, points, mesh, options }, report) =>
      glue.surface(dimension, points, mesh, options, report),
    spanningTree: ({ dimension, points, mesh }, report) =>
      glue.spanningTree(dimension, points, mesh, report),
    topology: ({ dimension, points, mesh }, report) =>
      glue.topology(dimension, points, mesh, report),
    geometry: ({ dimension, points, mesh }, report) =>
      glue.geometry(dimension, points, mesh, report),
  };
  const handlers = Object.entries(tasks).map(([name, task]) => [
    name,
    async (args: never, control: Control) => {
      control.onBlocking();
      let last = '';
      const reported = reporting(control);
      const result = task(args, (phase, fraction) => reported((last = phase), fraction));
      control.onProgress({ phase: last, fraction: 1 });
      return result;
    },
  ]);
  return coreOf({ handlers: Object.fromEntries(handlers), memory });
}
