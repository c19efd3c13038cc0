// Memory that is ready before the arrays of results go there, in Node and in Chromium.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import * as esbuild from 'esbuild';
import { launchChromium } from './browsers.mjs';
import { root } from './package.mjs';
import { serve } from './server.mjs';

const { outputFiles } = await esbuild.build({
  entryPoints: [join(root, 'web/src/memory.ts')],
  bundle: true,
  write: false,
  format: 'esm',
  target: 'es2022',
});
const source = `data:text/javascript,${encodeURIComponent(outputFiles[0].text)}`;
const { Memory, MemoryThreads } = await import(source);

const MEGABYTES = 2 ** 20;

/** Memory that says when it was added to. */
function watched(Memory) {
  const memory = new Memory();
  const sizes = [];
  const waiting = [];
  return Object.assign(memory, {
    add(buffer) {
      Memory.prototype.add.call(memory, buffer);
      sizes.push(buffer.byteLength);
      for (const resolve of waiting.splice(0)) resolve();
    },
    /** Resolves when there were so many additions, with their sizes. */
    async additions(count) {
      while (sizes.length < count) await new Promise((resolve) => waiting.push(resolve));
      return sizes;
    },
  });
}

test('memory is taken where it fits', () => {
  const memory = new Memory([new ArrayBuffer(100), new ArrayBuffer(1000)]);
  const array = memory.take(900);
  assert.equal(array.length, 900);
  assert.equal(array.byteOffset, 0);
  assert.equal(array.buffer.byteLength, 1000);
  assert.equal(memory.readyBytes, 900);
  // What is left is too small for this, and too large for that. Fresh memory has some room.
  assert.equal(memory.take(200).buffer.byteLength, 210);
  assert.equal(memory.take(10).buffer.byteLength, 11);
  assert.equal(memory.readyBytes, 900);
  // Without memory that could serve again, there is no room.
  assert.equal(new Memory().take(200).buffer.byteLength, 200);
});

test('other threads get memory ready', async (t) => {
  // The process does not wait for these threads.
  const alive = setInterval(() => {}, 1000);
  t.after(() => clearInterval(alive));
  const threads = new MemoryThreads();
  const early = watched(Memory);
  const memory = watched(Memory);
  threads.serve(early, 1, MEGABYTES);
  // The run of the first one has ended.
  threads.release();
  threads.serve(memory, 2, 2 * MEGABYTES);
  assert.deepEqual(await memory.additions(2), [2 * MEGABYTES, 2 * MEGABYTES]);
  const array = memory.take(2 * MEGABYTES - 12);
  assert.ok(array.every((byte) => byte === 0));
  assert.equal(memory.readyBytes, 2 * MEGABYTES - 12);
  assert.equal(early.take(MEGABYTES).length, MEGABYTES);
  assert.equal(early.readyBytes, 0);
  threads.end();
  threads.serve(memory, 1, MEGABYTES);
  assert.equal(memory.take(MEGABYTES).length, MEGABYTES);
});

test('without other threads, memory is fresh', () => {
  const { getBuiltinModule } = process;
  process.getBuiltinModule = () => ({
    Worker: class {
      constructor() {
        throw new Error('there are no threads');
      }
    },
  });
  try {
    const memory = new Memory();
    new MemoryThreads().serve(memory, 1, MEGABYTES);
    assert.equal(memory.take(MEGABYTES).length, MEGABYTES);
    assert.equal(memory.readyBytes, 0);
  } finally {
    process.getBuiltinModule = getBuiltinModule;
  }
});

test('other threads get memory ready in Chromium', async (t) => {
  const browser = await launchChromium();
  const server = await serve({});
  t.after(() => {
    server.close();
    return browser.close();
  });
  const page = await browser.newPage();
  await page.goto(server.url);
  const found = await page.evaluate(
    async ([source, bytes]) => {
      const { Memory, MemoryThreads } = await import(source);
      const memory = new Memory();
      const isThere = new Promise((resolve) => {
        memory.add = (buffer) => resolve(Memory.prototype.add.call(memory, buffer));
      });
      new MemoryThreads().serve(memory, 1, bytes);
      await isThere;
      const array = memory.take(bytes);
      return { length: array.length, readyBytes: memory.readyBytes };
    },
    [source, MEGABYTES],
  );
  assert.deepEqual(found, { length: MEGABYTES, readyBytes: MEGABYTES });
});
