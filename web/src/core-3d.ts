// The tasks of the 3D module.

import makeGlue from 'glue:d3';
import type { Coordinates } from './arrays.js';
import { blockingInstance } from './blocking.js';
import { type Core, coreOf, type Uses } from './core.js';
import { Driver, hosting } from './driving.js';
import { Engine, type Kind } from './engine.js';
import { instantiate } from './instance.js';
import type { Made } from './meshes.js';
import { outputsFor, withEmpty } from './outputs.js';
import type { Tasks } from './protocol.js';
import { Runner } from './running.js';
import type { Output } from './types.js';

type Glue = ReturnType<typeof makeGlue>;

const KIND: Kind<Glue> = {
  task: 'delaunay3d',
  speed: (triangulator) => ({
    least: () => triangulator.least3d(),
    open: (meanwhile) => triangulator.open3d(meanwhile),
    whyCpu: (points) => triangulator.why_cpu3d(points),
    known: () => triangulator.known3d(),
    recall: (known) => triangulator.recall3d(known),
  }),
  dimension: 3,
  arrays: ['tetrahedra', 'neighbors', 'hull'],
  corners: 4,
  hullCorners: 3,
  // There are 6.8 tetrahedra per uniform point.
  bytesPerCoordinate: (7 * 16) / 3,
};

export function openCore(module: WebAssembly.Module, uses: Uses = {}): Core {
  const engine = new Engine(KIND, makeGlue, module, uses);
  const { glue, memory, triangulator, choice } = engine;
  const runner = new Runner(engine);
  const driver = IN_WORKER ? undefined : new Driver(engine);

  return coreOf({
    memory,
    dispose: () => engine.dispose(),
    free: (key) => engine.meshes.free(key),
    handlers: {
      ...hosting(glue.Session3),
      open: ({ backend }) => choice.open(backend, engine.speed),
      async delaunay3d(args, control, helper) {
        const { points, outputs, vertexSimplex } = args;
        if (driver && helper) {
          const hasTrace = outputs.includes('trace');
          return withEmpty(
            await driver.run(args, control, helper, {
              begin: (carrier, report) => triangulator.drive3d(carrier, hasTrace, report),
              room: ([tetrahedra, hull], { duplicateOf, dimension }) =>
                triangulator.room3d(tetrahedra, hull, duplicateOf!, dimension!),
            }),
          );
        }
        const mesh = await runner.run(args, control, {
          large: outputs.includes('neighbors') ? 2 : 1,
          triangulate: ({ backend, onDevice, take, report }): Promise<Made> => {
            const wanted = outputsFor(glue, outputs, vertexSimplex);
            return triangulator.delaunay3d(points, backend, wanted, onDevice, take, report);
          },
        });
        return withEmpty(mesh);
      },
    },
  });
}

/** The arrays and the statistics of a triangulation. */
type Blocking = Omit<Tasks['delaunay3d']['result'], 'points'>;

/**
 * Returns a function that triangulates with the CPU backend before it returns. It throws a
 * `PlainError`, and replaces an instance that broke.
 */
export function createBlocking(
  module: WebAssembly.Module,
): (points: Coordinates, outputs: readonly Output[]) => Blocking {
  const instance = blockingInstance(() => instantiate(makeGlue, module));
  return (points, outputs) =>
    instance((glue) =>
      withEmpty<Blocking>(glue.delaunay3d_blocking(points, outputsFor(glue, outputs))),
    );
}
