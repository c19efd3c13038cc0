// The task of the module that finds weights with which cells have given volumes.

import makeGlue from 'glue:transport';
import { type Core, coreOf, reporting } from './core.js';
import { instantiate } from './instance.js';

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
    },
  });
}
