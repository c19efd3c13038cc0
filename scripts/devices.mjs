// The reports of devices, as `gdel adapters --test` and the page www/report/ write them, and their table, DEVICES.md.
//
//   node scripts/devices.mjs --check   fails if the table is not as it should be
//   node scripts/devices.mjs FILE      prints the row of a report

import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const TABLE = join(dirname(fileURLToPath(import.meta.url)), '../DEVICES.md');

const SIZES = [10_000, 100_000, 1_000_000];
const NAMES = ['10⁴', '10⁵', '10⁶'];
const INPUTS = [3, 2].flatMap((dimension) => SIZES.map((size) => `${dimension}D ${size}`));
const COLUMNS = [
  ...['device', 'driver', 'system', 'gdel', 'result'],
  ...[3, 2].flatMap((dimension) => NAMES.map((name) => `${dimension}D ${name}`)),
  'report',
];

const TIME = String.raw`\d+(?:\.\d)?`;
/** What each cell is, by its column. */
const CELLS = [
  ...[/^\S.*$/, /^(?:vulkan|metal|dx12|webgpu), \S.*$/, /^\S.*, \d+ threads$/],
  ...[/^\d+\.\d+\.\d+\S*$/, /^(?:right|incomplete|WRONG)$/],
  ...INPUTS.map(() => new RegExp(`^(?:–|${TIME} / (?:–|${TIME}))$`)),
  /^(?:\[[^\]]+\]\(https:\/\/[^)\s]+\)|ours, \d{4}-\d{2}-\d{2})$/,
];

/**
 * Returns what a report says: the lines that have a name, by that name.
 *
 * @throws if it is none.
 */
export function parse(text) {
  const [title, ...lines] = text.trim().split(/\r?\n/);
  if (title !== 'gdel report 1') throw new Error(`this is no report: ${title}`);
  const said = {};
  for (const line of lines) {
    const [, name, value] = /^([^:]+): (.*)$/.exec(line) ?? [];
    if (!name || name in said) throw new Error(`not a line of a report: ${line}`);
    said[name] = value;
  }
  for (const name of [
    'version',
    'device',
    'driver',
    'system',
    'self-test 3D',
    'self-test 2D',
    'result',
  ])
    if (!said[name]) throw new Error(`the report has no ${name}`);
  return said;
}

/** Returns the row of a report. */
export function rowOf(text) {
  const said = parse(text);
  const times = INPUTS.map((input) => {
    const [, cpu, gpu = '–'] =
      new RegExp(`^CPU (${TIME}) ms, GPU (?:(${TIME}) ms)?`).exec(said[input] ?? '') ?? [];
    return cpu ? `${cpu} / ${gpu}` : '–';
  });
  const { device, driver, system, version, result } = said;
  const cells = [device, driver, system, version, result, ...times, '[#N](LINK)'];
  return `| ${cells.map((cell) => cell.replaceAll('|', '\\|')).join(' | ')} |`;
}

/** Returns what is wrong with the table of a document. */
export function faultsOf(document) {
  const lines = document.split('\n');
  const start = lines.findIndex((line) => line.startsWith('| device |'));
  if (start < 0) return ['there is no table'];
  const end = lines.findIndex((line, i) => i > start && !line.startsWith('|'));
  const cellsOf = (line) =>
    line
      .slice(1, -1)
      .split(/(?<!\\)\|/)
      .map((cell) => cell.trim());
  const [header, rule, ...rows] = lines.slice(start, end < 0 ? undefined : end);
  const faults = [];
  if (cellsOf(header).join() !== COLUMNS.join())
    faults.push(`the columns are not ${COLUMNS.join(', ')}`);
  if (!cellsOf(rule).every((cell) => /^-+:?$/.test(cell)))
    faults.push('the second line is no rule');
  let before = '';
  for (const row of rows) {
    const cells = cellsOf(row);
    if (cells.length !== COLUMNS.length) faults.push(`${cells.length} cells: ${row}`);
    for (const [i, cell] of cells.entries())
      if (CELLS[i] && !CELLS[i].test(cell)) faults.push(`${COLUMNS[i]} is ${cell}: ${row}`);
    const key = cells.slice(0, 4).join(' ').toLowerCase();
    if (key <= before) faults.push(`not in alphabetical order: ${row}`);
    before = key;
  }
  return faults;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [argument] = process.argv.slice(2);
  if (argument === '--check') {
    const faults = faultsOf(readFileSync(TABLE, 'utf8'));
    for (const fault of faults) console.error(`DEVICES.md: ${fault}`);
    process.exitCode = faults.length ? 1 : 0;
  } else console.log(rowOf(readFileSync(argument ?? 0, 'utf8')));
}
