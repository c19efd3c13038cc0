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
  | 'interpolateGrid'
  | 'interpolationWeights'
  | 'gradients'
  | 'contours'
  | 'voronoi'
  | 'alphaShape'
  | 'spanningTree'
  | 'topology'
  | 'geometry'
  | 'onSphere'
  | 'sphere'
  | 'sphereNearest'
  | 'sphereLocate'
  | 'sphereInterpolate'
  | 'sphereVoronoi';

export function openCore(module: WebAssembly.Module): Core {
  const { glue, memory } = instantiate(makeGlue, module);
  const tasks: {
    [T in DerivedTask]: (args: Tasks[T]['args'], report: ReportProgress) => Tasks[T]['result'];
  } = {
    locate: ({ dimension, points, mesh, queries, options }, report) =>
      glue.locate(dimension, points, mesh, queries, options, report),
    nearest: ({ dimension, points, mesh, queries, k }, report) =>
      glue.nearest(dimension, points, mesh, queries, k, report) as SignedIndices,
    interpolate: ({ dimension, points, mesh, queries, values, options }, report) =>
      glue.interpolate(dimension, points, mesh, queries, values, options, report),
    interpolateGrid: ({ dimension, points, mesh, values, grid, options }, report) =>
      glue.interpolateGrid(dimension, points, mesh, values, grid, options, report),
    interpolationWeights: ({ dimension, points, mesh, queries, options }, report) =>
      glue.interpolationWeights(dimension, points, mesh, queries, options, report),
    gradients: ({ dimension, points, mesh, values, options }, report) =>
      glue.gradients(dimension, points, mesh, values, options, report),
    contours: ({ dimension, points, mesh, values, levels, closed }, report) =>
      glue.contours(dimension, points, mesh, values, levels, closed, report),
    voronoi: ({ dimension, points, mesh, clip, bounds }, report) =>
      glue.voronoi(dimension, points, mesh, clip, bounds, report),
    alphaShape: ({ dimension, points, mesh, options }, report) =>
      glue.alphaShape(dimension, points, mesh, options, report),
    spanningTree: ({ dimension, points, mesh }, report) =>
      glue.spanningTree(dimension, points, mesh, report),
    topology: ({ dimension, points, mesh }, report) =>
      glue.topology(dimension, points, mesh, report),
    geometry: ({ dimension, points, mesh }, report) =>
      glue.geometry(dimension, points, mesh, report),
    onSphere: ({ places }) => glue.onSphere(places) as Doubles,
    sphere: ({ points, triangles, duplicateOf }, report) =>
      glue.sphere(points, triangles, duplicateOf, report),
    sphereNearest: ({ points, triangles, duplicateOf, queries }, report) =>
      glue.sphereNearest(points, triangles, duplicateOf, queries, report) as SignedIndices,
    sphereLocate: ({ points, triangles, duplicateOf, queries }, report) =>
      glue.sphereLocate(points, triangles, duplicateOf, queries, report),
    sphereInterpolate: ({ points, triangles, duplicateOf, queries, values }, report) =>
      glue.sphereInterpolate(points, triangles, duplicateOf, queries, values, report),
    sphereVoronoi: ({ points, triangles, duplicateOf }, report) =>
      glue.sphereVoronoi(points, triangles, duplicateOf, report),
  };
  const handlers = Object.entries(tasks).map(([name, task]) => [
    name,
    async (args: never, control: Control) => {
      control.onBlocking();
      let last: string = name;
      const reported = reporting(control);
      const result = task(args, (phase, fraction) => reported((last = phase), fraction));
      control.onProgress({ phase: last, fraction: 1 });
      return result;
    },
  ]);
  return coreOf({ handlers: Object.fromEntries(handlers), memory });
}
