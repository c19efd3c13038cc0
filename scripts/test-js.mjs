// Runs the tests of the npm package and the demo page, or only those files that are named. Both
// have to be built.
//
//   node --no-concurrent-recompilation scripts/test-js.mjs [FILE…]
//
// Files run side by side, one per processor, each in a process of its own with the flags of this
// one: Node can deadlock when it ends while V8 compiles on another thread (nodejs/node#54918).
// Tests wait for states, never for times; the only limit is there to end what hangs.

import { mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { availableParallelism, tmpdir } from 'node:os';
import { join, relative, resolve } from 'node:path';
import { run } from 'node:test';
import { spec } from 'node:test/reporters';
import { packInto, root } from '../tests/web/package.mjs';

/** In milliseconds, for one file. No machine needs nearly as long. */
const HANG = 25 * 60_000;

/** The files that take longest come first, so that none of them is left over at the end. */
const SLOW = [
  'tests/web/node-gpu',
  'tests/web/update-gpu',
  'www/tests/demo',
  'tests/web/caller-device',
  'www/tests/scans',
  'www/tests/demo-2d',
  'www/tests/examples',
  'www/tests/gallery',
  'tests/web/self-test',
  'tests/web/gpu-stand-in',
  'www/tests/gpu',
  'www/tests/site',
  'tests/web/chromium',
];

function allFiles() {
  const files = ['tests/web', 'www/tests'].flatMap((folder) =>
    readdirSync(join(root, folder)).map((name) => `${folder}/${name}`),
  );
  const tests = files.filter((file) => file.endsWith('.test.mjs'));
  const slow = SLOW.map((file) => `${file}.test.mjs`);
  return [...slow, ...tests.filter((file) => !slow.includes(file))].map((file) => join(root, file));
}

const packed = mkdtempSync(join(tmpdir(), 'gdel-packed-'));
process.on('exit', () => rmSync(packed, { recursive: true, force: true, maxRetries: 5 }));
packInto(packed);
process.env.GDEL_PACKED = packed;

const named = process.argv.slice(2).map((file) => resolve(file));
const tests = run({
  files: named.length > 0 ? named : allFiles(),
  concurrency: availableParallelism(),
  timeout: HANG,
});
tests.on('test:fail', () => {
  process.exitCode = 1;
});
// The report tells of a file once those before it have ended: this says at once how far the tests are.
tests.on('test:complete', ({ name, file, details: { passed, duration_ms } }) => {
  if (name !== file) return;
  const [seconds, sinceStart] = [duration_ms / 1000, performance.now() / 1000].map(Math.round);
  const verdict = passed ? 'passed' : 'failed';
  console.error(
    `${relative(root, file)} has ${verdict} in ${seconds} s, ${sinceStart} s after the start`,
  );
});
tests.compose(spec).pipe(process.stdout);
