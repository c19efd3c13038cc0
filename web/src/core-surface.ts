// The task of the module that finds the closed surface through points.

import makeGlue from 'glue:surface';
import { type Core, coreOf, reporting } from './core.js';
import { instantiate } from './instance.js';

export function openCore(module: WebAssembly.Module): Core {
  const { glue, memory } = instantiate(makeGlue, module);
  return coreOf({
    memory,
    handlers: {
      async surface({ dimension, points, mesh, options }, control) {
        control.onBlocking();
        const report = reporting(control);
        const result = glue.surface(dimension, points, mesh, options, report);
        control.onProgress({ phase: 'surface', fraction: 1 });
        return result;
      },
    },
  });
}
