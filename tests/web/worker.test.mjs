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
/** Whether workers say that they are ready. */
let areReady;

globalThis.Worker = class extends EventTarget {
  constructor() {
    super();
    made.push(this);
    if (areReady) queueMicrotask(() => this.#answer({ type: 'ready' }));
  }

  #answer(data) {
    this.dispatchEvent(Object.assign(new Event('message'), { data }));
  }

  postMessage(message) {
    if (message.type !== 'run') return;
    const { id } = message;
    this.runs = (this.runs ?? 0) + 1;
    onRun((answer) => queueMicrotask(() => this.#answer({ ...answer, id })));
  }

  terminate() {
    ended.push(this);
    whenEnded?.();
  }

  die() {
    this.dispatchEvent(
      Object.assign(new Event('error', { cancelable: true }), { message: 'dead' }),
    );
  }
};
// As in a page.
globalThis.document = {};

const url = pathToFileURL(join(dist(project()), 'index.js'));
let delaunay3d;
let copies = 0;
beforeEach(async () => {
  [made, ended, areReady] = [[], [], true];
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

/** Aborts a run of which the worker said this before its first report of progress. */
async function aborted(...before) {
  const controller = new AbortController();
  onRun = (answer) => {
    for (const message of before) answer(message);
    answer({ type: 'progress', progress: { phase: 'insert', fraction: 0.5 } });
  };
  const run = delaunay3d([[0, 0, 0]], {
    signal: controller.signal,
    onProgress: () => controller.abort(),
  });
  await assert.rejects(run, { code: 'ABORTED' });
}

test('a worker that cannot hear is ended at once, and the one that was kept ready goes on', async () => {
  for (const count of [1, 2, 3]) {
    await aborted({ type: 'blocking' });
    onRun = heard;
    assert.equal(await messageOf(delaunay3d([[0, 0, 0]])), 'heard');
    assert.equal(ended.length, count);
    assert.deepEqual(
      made.map(({ runs }) => runs),
      [1, ...Array(count - 1).fill(2), 1],
    );
  }
});

test('a run that can be aborted and takes long has a second worker started beside it', async (t) => {
  t.mock.timers.enable({ apis: ['setTimeout'] });
  for (const [options, count] of [
    [{}, 1],
    [{ signal: new AbortController().signal }, 2],
  ]) {
    let answer;
    const running = new Promise((resolve) => {
      onRun = (answerOfRun) => resolve((answer = answerOfRun));
    });
    const run = messageOf(delaunay3d([[0, 0, 0]], options));
    await running;
    t.mock.timers.tick(100);
    assert.equal(made.length, count);
    heard(answer);
    assert.equal(await run, 'heard');
  }
});

test('a worker that dies while it has nothing to do is replaced', async () => {
  onRun = heard;
  assert.equal(await messageOf(delaunay3d([[0, 0, 0]])), 'heard');
  made[0].die();
  assert.equal(await messageOf(delaunay3d([[0, 0, 0]])), 'heard');
  assert.equal(made.length, 2);
});

test('a worker that dies in a run is an error, and replaced', async () => {
  onRun = () => made[0].die();
  assert.match(await messageOf(delaunay3d([[0, 0, 0]])), /worker failed: dead/);
  onRun = heard;
  assert.equal(await messageOf(delaunay3d([[0, 0, 0]])), 'heard');
});

test('a worker that never answers is an error that says what to do', async (t) => {
  areReady = false;
  t.mock.timers.enable({ apis: ['setTimeout'] });
  const run = delaunay3d([[0, 0, 0]]).catch((error) => error);
  while (made.length === 0) await null;
  t.mock.timers.tick(60_000);
  const { name, code, message } = await run;
  assert.deepEqual([name, code], ['GdelError', 'LOAD_FAILED']);
  assert.match(message, /worker: false/);
  assert.deepEqual(ended, made);
  // The next run tries again.
  areReady = true;
  onRun = heard;
  assert.equal(await messageOf(delaunay3d([[0, 0, 0]])), 'heard');
});

test('a triangulator that is disposed of while its worker starts fails its run', async () => {
  const { createTriangulator } = await import(`${url}?${copies++}`);
  onRun = (answer) => answer({ type: 'done', result: { points: new Float64Array(0), stats: {} } });
  const triangulator = await createTriangulator({ backend: 'cpu' });
  const run = triangulator.delaunay2d([[0, 0]]).catch(({ code }) => code);
  triangulator.dispose();
  assert.equal(await run, 'DISPOSED');
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
