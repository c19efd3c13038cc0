// The tasks of the 2D module.

import makeGlue from 'glue:d2';
import type { Coordinates } from './arrays.js';
import { blockingInstance } from './blocking.js';
import { type Core, coreOf, type Uses } from './core.js';
import { Driver, hosting } from './driving.js';
import { Engine, type Kind } from './engine.js';
import { instantiate } from './instance.js';
import type { Made } from './meshes.js';
import type { Tasks } from './protocol.js';
import { Runner } from './running.js';

type Glue = ReturnType<typeof makeGlue>;

const KIND: Kind<Glue> = {
  task: 'delaunay2d',
  speed: (triangulator) => ({
    least: () => triangulator.least2d(),
    open: (meanwhile) => triangulator.open2d(meanwhile),
    whyCpu: (points) => triangulator.why_cpu2d(points),
    known: () => triangulator.known2d(),
    recall: (known) => triangulator.recall2d(known),
  }),
  dimension: 2,
  arrays: ['triangles', 'halfedges', 'hull'],
  corners: 3,
  hullCorners: 1,
  // There are less than 2 triangles per point.
  bytesPerCoordinate: (2 * 12) / 2,
};

export function openCore(module: WebAssembly.Module, uses: Uses = {}): Core {
  const engine = new Engine(KIND, makeGlue, module, uses);
  const { glue, memory, triangulator } = engine;
  const runner = new Runner(engine);
  const driver = IN_WORKER ? undefined : new Driver(engine);

  return coreOf({
    memory,
    dispose: () => engine.dispose(),
    free: (key) => engine.meshes.free(key),
    handlers: {
      ...hosting(glue.Session2),
      delaunay2d(given, control, helper) {
        const args = { ...given, outputs: [...KIND.arrays, 'duplicateOf'] };
        const { points, vertexSimplex = false } = args;
        if (driver && helper)
          return driver.run(args, control, helper, {
            begin: (...to) => triangulator.drive2d(...to),
            room: ([triangles, hull], { duplicateOf, dimension }) =>
              triangulator.room2d(triangles, hull, duplicateOf!, dimension!),
          });
        return runner.run(args, control, {
          large: 2,
          triangulate: ({ backend, onDevice, take, report }): Promise<Made> =>
            triangulator.delaunay2d(points, backend, vertexSimplex, onDevice, take, report),
        });
      },
    },
  });
}

/** The arrays and the statistics of a triangulation. */
type Blocking = Omit<Tasks['delaunay2d']['result'], 'points'>;

/**
 * Returns functions that triangulate with the CPU backend before they return, for callers that need the
 * statistics and for those that do not. They throw a `PlainError`, and replace an instance that broke.
 */
export function createBlocking(module: WebAssembly.Module) {
  const instance = blockingInstance(() => instantiate(makeGlue, module));
  return {
    mesh: (points: Coordinates): Blocking =>
      instance((glue) => glue.delaunay2d_blocking(points, true)),
    arrays: (points: Coordinates): Omit<Blocking, 'stats'> =>
      instance((glue) => glue.delaunay2d_blocking(points, false)),
  };
}
