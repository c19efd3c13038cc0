// How the package deals with its worker and keeps the calling thread free, with workers that do as
// the test says.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { beforeEach, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { dist, project } from './package.mjs';

/** What a worker does when it is sent a run: called with a function that answers. */
let onRun;
/** The workers that were made, and which of them were ended. */
let made;
let ended;
/** Resolves when a worker is ended. */
let whenEnded;

globalThis.Worker = class extends EventTarget {
  constructor() {
    super();
    made.push(this);
    // Deno can deliver a message as soon as the microtask after the one that made the worker.
    queueMicrotask(() => this.#answer({ type: 'ready' }));
  }

  #answer(data) {
    this.dispatchEvent(Object.assign(new Event('message'), { data }));
  }

  postMessage(message) {
    if (message.type !== 'run') return;
    const { id } = message;
    onRun((answer) => queueMicrotask(() => this.#answer({ ...answer, id })));
  }

  terminate() {
    ended.push(this);
    whenEnded?.();
  }
};
// The web's build, with a module that has nothing in it: nobody asks it for anything.
globalThis.fetch = async () => new Response(Uint8Array.of(0, 0x61, 0x73, 0x6d, 1, 0, 0, 0));

const url = pathToFileURL(join(dist(project()), 'index.js'));
let delaunay3d;
let copies = 0;
beforeEach(async () => {
  [made, ended] = [[], []];
  // A module of its own, with a worker of its own.
  ({ delaunay3d } = await import(`${url}?${copies++}`));
});

const heard = (answer) =>
  answer({ type: 'failed', error: { code: 'INTERNAL', message: 'heard', fatal: false } });
const messageOf = (run) => run.catch(({ message }) => message);

test('a worker that says at once that it is ready is heard', async () => {
  onRun = heard;
  assert.equal(await messageOf(delaunay3d([[0, 0, 0]])), 'heard');
});

test('a worker that does not stop when it should is ended, and the next run has a new one', async () => {
  const controller = new AbortController();
  onRun = (answer) => {
    answer({ type: 'progress', progress: { phase: 'insert', fraction: 0.5 } });
  };
  const end = new Promise((resolve) => (whenEnded = resolve));
  const run = delaunay3d([[0, 0, 0]], {
    signal: controller.signal,
    onProgress: () => controller.abort(),
  });
  await assert.rejects(run, { code: 'ABORTED' });
  assert.equal(ended.length, 0);
  onRun = heard;
  const next = messageOf(delaunay3d([[0, 0, 0]]));
  await end;
  assert.equal(await next, 'heard');
  assert.equal(made.length, 2);
  assert.deepEqual(ended, [made[0]]);
});

test('a worker that stops when it should stays', async () => {
  const controller = new AbortController();
  onRun = (answer) => {
    controller.signal.addEventListener('abort', () =>
      answer({ type: 'failed', error: { code: 'ABORTED', message: 'aborted', fatal: false } }),
    );
    answer({ type: 'progress', progress: { phase: 'insert', fraction: 0.5 } });
  };
  const run = delaunay3d([[0, 0, 0]], {
    signal: controller.signal,
    onProgress: () => controller.abort(),
  });
  await assert.rejects(run, { code: 'ABORTED' });
  onRun = heard;
  assert.equal(await messageOf(delaunay3d([[0, 0, 0]])), 'heard');
  // The second one is the one that is kept ready.
  assert.deepEqual([made.length, ended.length], [2, 0]);
});

for (const [name, points] of [
  ['rows', Array.from({ length: 100_000 }, () => [0, 0, 0])],
  ['typed arrays', new Float32Array(3 * 4_000_000)],
]) {
  test(`${name} are copied in slices, between which the caller’s events are handled`, async (t) => {
    // A clock by which every slice takes too long.
    let now = 0;
    t.mock.method(performance, 'now', () => (now += 1000));
    onRun = heard;
    let turns = 0;
    let running = true;
    const count = () => {
      turns++;
      if (running) setImmediate(count);
    };
    count();
    assert.equal(await messageOf(delaunay3d(points)), 'heard');
    running = false;
    assert.ok(turns > 10, `${turns} turns`);
  });
}
