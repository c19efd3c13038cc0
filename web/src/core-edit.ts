// The tasks of the module for meshes in the memory of the CPU that gain and lose points, and for
// those of weighted points.

import makeGlue from 'glue:edit';
import { type Core, coreOf, reporting, statsOfCpu } from './core.js';
import { instantiate } from './instance.js';
import { outputsFor, withEmpty } from './outputs.js';

export function openCore(module: WebAssembly.Module): Core {
  const { glue, memory } = instantiate(makeGlue, module);
  return coreOf({
    memory,
    handlers: {
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
    },
  });
}
