// What the measuring programs share.

import { execFileSync } from 'node:child_process';
import { cpus } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

export const root = join(dirname(fileURLToPath(import.meta.url)), '../..');

/** Returns the median. */
export const median = (numbers) => numbers.toSorted((a, b) => a - b)[numbers.length >> 1];

const round = (number) => Math.round(1e3 * number) / 1e3;

/** Prints a line of JSON, which says what was measured, on what, and when. */
export function print(row) {
  const program = process.argv[1].slice(process.argv[1].lastIndexOf('benches/'));
  const about = {
    command: ['node', program, ...process.argv.slice(2)].join(' '),
    date: new Date().toISOString().slice(0, 10),
    processor: cpus()[0]?.model,
    node: process.version,
  };
  console.log(JSON.stringify({ ...about, ...row }));
}

/** Returns the fields for the times of all runs and their median, in milliseconds. */
export const times = (name, all) => ({
  [name]: round(median(all)),
  [`all_${name}`]: all.map(round),
});

/** Returns the phases of a run by name, in milliseconds. */
export const phases = (stats) =>
  Object.fromEntries(
    stats.phases.map(({ name, milliseconds }) => [name.replaceAll(' ', '_'), round(milliseconds)]),
  );

/** Returns the milliseconds that something takes, and its result. */
export async function timed(work) {
  const began = performance.now();
  const result = await work();
  return [performance.now() - began, result];
}

/** Imports a file of a package in a folder. */
export const load = (folder, file) => import(pathToFileURL(join(resolve(folder), file)));

/** Returns the `GPU` object of the npm package `webgpu`. */
export async function openGpu(folder) {
  const { create } = await load(folder, 'index.js');
  // When it is garbage, its devices are lost.
  globalThis.gpu = create([]);
  return globalThis.gpu;
}

/** Returns a device with the largest buffers that the adapter has. */
export async function openDevice(gpu) {
  const adapter = await gpu.requestAdapter({ powerPreference: 'high-performance' });
  const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
  return adapter.requestDevice({ requiredLimits: { maxBufferSize, maxStorageBufferBindingSize } });
}

/** Runs our native program with arguments, and returns its rows. */
export function native(program, args) {
  const lines = execFileSync(program, args, { encoding: 'utf8' }).trim().split('\n');
  return lines.map((line) => JSON.parse(line));
}
