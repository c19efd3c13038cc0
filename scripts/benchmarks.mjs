// Makes BENCHMARKS.md of benches/results/*.json.
//
//   node scripts/benchmarks.mjs            writes it
//   node scripts/benchmarks.mjs --check    fails where it is not what would be written
//
// A file of results is a table: `keys` and `values` name its columns by their headings, with the fields of the
// rows that they show (`a.b` for a field of an object). `rows` are what the measuring programs print, a line of
// JSON each. Rows with the same keys, machine and date are runs of different processes, of which a cell shows the
// median, and the range in brackets.

import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = join(dirname(fileURLToPath(import.meta.url)), '..');
const RESULTS = join(root, 'benches/results');
const PAGE = join(root, 'BENCHMARKS.md');
// In the order of the page; others follow.
const ORDER = [
  'gpu-3d',
  'moved',
  'gpu-2d',
  'cpu-threads',
  'cpu-peers',
  'browser',
  'page',
  'npm-cpu',
];

const INTRODUCTION = `<!-- Made of benches/results/*.json by scripts/benchmarks.mjs: do not edit. -->
# Benchmarks

Each process says the median of its runs, after others to warm up; a cell has the median of processes, with the range in brackets. \`cargo run --release -p gdel-bench -- --help\` measures: its lines of JSON go to \`benches/results/\`, and \`node scripts/benchmarks.mjs\` makes this page of them. Rows up to 2026-11-28 are of programs that it has replaced; the rows name them. Why things are as they are is in [docs/decisions](docs/decisions).
`;

const field = (row, path) => path.split('.').reduce((value, name) => value?.[name], row);

const number = (value) =>
  value < 100 ? String(Number(value.toPrecision(3))) : Math.round(value).toLocaleString('en-US');

/** Returns a value as a cell shows it. */
function text(value, path) {
  if (value === undefined || value === null) return '';
  if (Array.isArray(value)) return value.map((each) => text(each, path)).join('–');
  if (typeof value !== 'number') return String(value);
  if (path.endsWith('bytes')) return number(Math.round(value / 1e6));
  if (path === 'share') return `${Number((100 * value).toPrecision(3))} %`;
  return ['points', 'queries'].includes(path) && value >= 1e6 && value % 1e6 === 0
    ? `${value / 1e6} M`
    : number(value);
}

function cell(rows, path) {
  const found = rows.map((row) => field(row, path)).filter((value) => value !== undefined);
  if (found.length < 2 || typeof found[0] !== 'number') return text(found[0], path);
  const sorted = found.toSorted((a, b) => a - b);
  const half = sorted.length >> 1;
  const median = sorted.length % 2 === 1 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
  const [least, middle, most] = [sorted[0], median, sorted.at(-1)].map((value) =>
    text(value, path),
  );
  return least === most ? middle : `${middle} (${least}–${most})`;
}

/** Returns where and when a row was measured. */
const place = ({ adapter, processor, date }) => `${adapter ?? processor}, ${date}`;

function table({ title, text: about, keys, values, rows }) {
  const groups = new Map();
  for (const row of rows) {
    const key = JSON.stringify([
      ...Object.values(keys).map((path) => field(row, path)),
      place(row),
    ]);
    groups.set(key, [...(groups.get(key) ?? []), row]);
  }
  const places = [...new Set(rows.map(place))];
  // One place is named above the table; of several, the rows have the letters.
  const letters = places.length > 1 ? places.map((_, i) => String.fromCharCode(65 + i)) : [];
  const heads = [
    ...Object.keys(keys),
    ...Object.keys(values),
    ...(letters.length > 0 ? ['on'] : []),
  ];
  const lines = [...groups.values()].map((group) => [
    ...Object.values(keys).map((path) => text(field(group[0], path), path)),
    ...Object.values(values).map((path) => cell(group, path)),
    ...(letters.length > 0 ? [letters[places.indexOf(place(group[0]))]] : []),
  ]);
  const line = (cells) => `| ${cells.join(' | ')} |`;
  const on = places.map((name, i) =>
    letters.length > 0 ? `${letters[i]}: ${name}` : `On ${name}`,
  );
  return [
    `## ${title}`,
    `${about} ${on.join('; ')}.`,
    [line(heads), line(heads.map(() => '---')), ...lines.map(line)].join('\n'),
  ].join('\n\n');
}

const names = readdirSync(RESULTS).map((file) => file.replace(/\.json$/, ''));
const rank = (name) => (ORDER.includes(name) ? ORDER.indexOf(name) : ORDER.length);
names.sort((a, b) => rank(a) - rank(b) || (a < b ? -1 : 1));
const tables = names.map((name) =>
  table(JSON.parse(readFileSync(join(RESULTS, `${name}.json`), 'utf8'))),
);
const page = `${[INTRODUCTION.trimEnd(), ...tables].join('\n\n')}\n`;
if (process.argv.includes('--check')) {
  if (readFileSync(PAGE, 'utf8') !== page) {
    console.error('BENCHMARKS.md is not made of benches/results: run node scripts/benchmarks.mjs');
    process.exit(1);
  }
} else {
  writeFileSync(PAGE, page);
}
