// Runs test files of Node's test runner one after the other, each in a process of its own, and fails if one of them does.
//
//   node scripts/test-files.mjs FILE…
//
// A process of Node sometimes hangs when it should end (nodejs/node#54918), and so may a browser on a busy machine. So a file
// that is not done after LIMIT is stopped with all that it started, and gets a second chance: what hangs twice has failed.

import { spawn } from 'node:child_process';

const LIMIT = 10 * 60_000;
const files = process.argv.slice(2);
if (files.length === 0) throw new Error('usage: node scripts/test-files.mjs FILE…');

let group;

/** Stops what the last file has started and left behind. */
function stop() {
  try {
    if (group) process.kill(-group, 'SIGKILL');
  } catch (error) {
    if (error.code !== 'ESRCH') throw error;
  }
}
process.on('exit', stop);
for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP']) process.on(signal, () => process.exit(1));

/** Resolves to the exit status, or to null when the time was up. */
async function run(file) {
  const child = spawn(process.execPath, ['--test', file], { stdio: ['ignore', 'inherit', 'inherit'], detached: true });
  group = child.pid;
  let timer;
  const status = await new Promise((resolve, reject) => {
    timer = setTimeout(() => resolve(null), LIMIT);
    child.once('error', reject);
    child.once('exit', (code) => resolve(code ?? 1));
  });
  clearTimeout(timer);
  stop();
  return status;
}

const failed = [];
for (const file of files) {
  console.log(`== ${file}`);
  let status = await run(file);
  if (status === null) {
    console.log(`== ${file} was not done after ${LIMIT / 60_000} minutes: once more`);
    status = await run(file);
  }
  if (status !== 0) failed.push(status === null ? `${file} (hung twice)` : file);
}
if (failed.length > 0) {
  console.error(`failed: ${failed.join(', ')}`);
  process.exitCode = 1;
}
