// Lets the tests of delaunator and d3-delaunay, in tests/data, test our class: to be loaded by
// `node --import`. GDEL_DELAUNATOR is the URL of the module that has the class; without it, delaunator
// itself is tested.

import { register } from 'node:module';
import { test } from 'node:test';

// d3-delaunay is tested by Mocha, whose tests are called so.
globalThis.it = test;

const { GDEL_DELAUNATOR } = process.env;
const delaunator = import.meta.resolve('delaunator');
if (GDEL_DELAUNATOR) await (await import(GDEL_DELAUNATOR)).default.load();

const hooks = `
  const url = ${JSON.stringify(GDEL_DELAUNATOR ?? delaunator)};
  export function resolve(specifier, context, next) {
    const isClass = specifier === 'delaunator' || specifier === '../index.js';
    return isClass ? { url, shortCircuit: true } : next(specifier, context);
  }`;
register(`data:text/javascript,${encodeURIComponent(hooks)}`);
