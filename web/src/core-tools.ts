// The tasks of the module with tools: files, verification and synthetic points.

import makeGlue from 'glue:tools';
import type { Doubles } from './arrays.js';
import { type Core, coreOf } from './core.js';
import { instantiate } from './instance.js';
import type { Control, TaskName, Tasks } from './protocol.js';

export function openCore(module: WebAssembly.Module): Core {
  const { glue, memory } = instantiate(makeGlue, module);
  const tasks: { [T in TaskName]?: (args: Tasks[T]['args']) => Tasks[T]['result'] } = {
    readPoints: ({ bytes, extension, dimension }) => glue.read_points(bytes, extension, dimension),
    readShapes: ({ bytes, extension }) => glue.read_shapes(bytes, extension),
    generate: ({ kind, count, seed }) => glue.generate3d(kind, count, seed) as Doubles,
    write: ({ points, mesh, format }) => glue.write3d(points, mesh, format),
    verify: ({ points, mesh }) => glue.verify3d(points, mesh),
    generate2d: ({ kind, count, seed }) => glue.generate2d(kind, count, seed) as Doubles,
    write2d: ({ points, mesh, format }) => glue.write2d(points, mesh, format),
    verify2d: ({ points, mesh }) => glue.verify2d(points, mesh),
  };
  const handlers = Object.entries(tasks).map(([name, task]) => [
    name,
    async (args: never, control: Control) => {
      control.onBlocking();
      return task(args);
    },
  ]);
  return coreOf({ handlers: Object.fromEntries(handlers), memory });
}
