// Times small inputs and what comes before the first result: where the first millisecond goes.
//
//   npm run build
//   node benches/js/small.mjs [--package FOLDER_OF_DIST]

import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { Worker } from 'node:worker_threads';
import Theirs from 'delaunator';

const { values } = parseArgs({ options: { package: { type: 'string', default: 'web/dist' } } });
const load = performance.now();
const gdel = await import(pathToFileURL(resolve(values.package, 'index.js')));
const { delaunay2d, delaunay3d, delaunay2dSync, delaunay3dSync, Delaunator } = gdel;

const rows = [];
const milliseconds = (from) => Number((performance.now() - from).toFixed(1));
rows.push({ what: 'import', milliseconds: milliseconds(load) });
const first = performance.now();
await delaunay3d([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]);
rows.push({ what: 'first delaunay3d: module, worker, run', milliseconds: milliseconds(first) });
const loading = performance.now();
await Promise.all([gdel.load2d(), gdel.load3d()]);
rows.push({ what: 'load2d and load3d after that', milliseconds: milliseconds(loading) });
console.table(rows);

/** The median of the microseconds that a call takes, after as many calls as compile it. */
async function microseconds(call) {
  const times = [];
  const until = performance.now() + 400;
  while (times.length < 20 || performance.now() < until) {
    const started = performance.now();
    await call();
    times.push(performance.now() - started);
  }
  const warm = times.slice(times.length / 2).sort((a, b) => a - b);
  return Number((1e3 * warm[Math.floor(warm.length / 2)]).toPrecision(3));
}

/** There and back again, without any work. */
const echo = new Worker(
  `const { parentPort } = require('node:worker_threads');
   parentPort.on('message', (message) => parentPort.postMessage(message));`,
  { eval: true },
);
const toWorker = () =>
  new Promise((resolve) => {
    echo.once('message', resolve);
    echo.postMessage(0);
  });
console.log(`a message to a worker and back: ${await microseconds(toWorker)} µs`);
await echo.terminate();

const table = {};
for (const count of [0, 10, 100, 1000, 10_000]) {
  const [d3, d2] = [await gdel.generate('uniform', count), await gdel.generate2d('uniform', count)];
  table[`${count} points`] = {
    delaunay3d: await microseconds(() => delaunay3d(d3)),
    delaunay3dSync: await microseconds(() => delaunay3dSync(d3)),
    delaunay2d: await microseconds(() => delaunay2d(d2)),
    delaunay2dSync: await microseconds(() => delaunay2dSync(d2)),
    Delaunator: await microseconds(() => new Delaunator(d2)),
    delaunator: await microseconds(() => new Theirs(d2)),
  };
}
console.log('microseconds:');
console.table(table);
