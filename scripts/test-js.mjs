// Runs the tests of the npm package and the demo page, or only those files that are named. Both have to be built.
//
//   node scripts/test-js.mjs [FILE…]
//
// Files run side by side, one per processor, each in a process of its own. They wait for states, never for times; the only
// limit is there to end what hangs.

import { spawn } from 'node:child_process';
import { mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { availableParallelism, tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { packInto } from '../tests/web/package.mjs';

/** For one file. No machine needs nearly as long. */
const HANG = 40 * 60_000;

/** Those that take longest come first, so that none of them is left over at the end. */
const SLOW = ['gpu', 'chromium', 'node-gpu', 'demo', 'plane'];

const root = fileURLToPath(new URL('../', import.meta.url));

function allFiles() {
  const names = ['tests/web', 'www/tests'].flatMap((folder) =>
    readdirSync(join(root, folder), { recursive: true }).map((name) => join(folder, name)),
  );
  const rank = (file) => {
    const at = SLOW.findIndex((name) => file.endsWith(`/${name}.test.mjs`));
    return at < 0 ? SLOW.length : at;
  };
  return names
    .filter((name) => name.endsWith('.test.mjs'))
    .sort((a, b) => rank(a) - rank(b) || a.localeCompare(b));
}

const scratch = mkdtempSync(join(tmpdir(), 'gdel-packed-'));
packInto(scratch);

const named = process.argv.slice(2);
const args = [
  // V8 compiles on the main thread. Node can deadlock when it ends while another thread compiles (nodejs/node#54918).
  '--no-concurrent-recompilation',
  '--test',
  '--test-reporter=spec',
  `--test-concurrency=${availableParallelism()}`,
  `--test-timeout=${HANG}`,
  ...(named.length > 0 ? named : allFiles().map((file) => join(root, file))),
];
// A group of its own: whatever a file leaves behind ends with it.
const child = spawn(process.execPath, args, {
  stdio: 'inherit',
  detached: true,
  env: { ...process.env, GDEL_PACKED: scratch },
});

process.on('exit', () => {
  try {
    process.kill(-child.pid, 'SIGKILL');
  } catch (error) {
    if (error.code !== 'ESRCH') throw error;
  }
  rmSync(scratch, { recursive: true, force: true, maxRetries: 5 });
});
for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP']) process.on(signal, () => process.exit(1));
child.once('error', (error) => {
  throw error;
});
child.once('exit', (code) => process.exit(code ?? 1));
