// What benches/results/*.json say, for BENCHMARKS.md and for the page of benchmarks.
//
// A file of results is a table: `keys` and `values` name its columns by their headings, with the fields of the
// rows that they show (`a.b` for a field of an object). `rows` are what the measuring programs print, a line of
// JSON each. Rows with the same keys, machine and date are runs of different processes, of which a cell shows the
// median, and the range in brackets.

import { readdirSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const RESULTS = join(dirname(fileURLToPath(import.meta.url)), '../benches/results');
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

/** Returns a cell: its text, and the median and the range of its numbers if it has any. */
function cell(rows, path) {
  const found = rows
    .map((row) => field(row, path))
    .filter((value) => value !== undefined && value !== null);
  if (typeof found[0] !== 'number') return { text: text(found[0], path) };
  const sorted = found.toSorted((a, b) => a - b);
  const half = sorted.length >> 1;
  const median = sorted.length % 2 === 1 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
  const range = [sorted[0], sorted.at(-1)];
  const [least, middle, most] = [range[0], median, range[1]].map((value) => text(value, path));
  return { text: least === most ? middle : `${middle} (${least}–${most})`, median, range };
}

/** Returns where and when a row was measured. */
const place = ({ adapter, processor, date }) => `${adapter ?? processor}, ${date}`;

/**
 * Returns a table: the headings of its keys and values, its lines with the texts of the keys and the cells of the
 * values, and the places where they were measured. If there are several, each line has the letter of its own.
 */
function table(name) {
  const {
    title,
    text: about,
    keys,
    values,
    rows,
  } = JSON.parse(readFileSync(join(RESULTS, `${name}.json`), 'utf8'));
  const groups = new Map();
  for (const row of rows) {
    const key = JSON.stringify([
      ...Object.values(keys).map((path) => field(row, path)),
      place(row),
    ]);
    groups.set(key, [...(groups.get(key) ?? []), row]);
  }
  const places = [...new Set(rows.map(place))];
  const letters = places.length > 1 ? places.map((_, i) => String.fromCharCode(65 + i)) : [];
  const lines = [...groups.values()].map((group) => ({
    keys: Object.values(keys).map((path) => text(field(group[0], path), path)),
    values: Object.values(values).map((path) => cell(group, path)),
    letter: letters[places.indexOf(place(group[0]))] ?? '',
  }));
  const on =
    letters.length > 0
      ? places.map((where, i) => `${letters[i]}: ${where}`).join('; ')
      : `On ${places[0]}`;
  return {
    name,
    title,
    about: `${about} ${on}.`,
    keys: Object.keys(keys),
    values: Object.keys(values),
    lines,
    hasLetters: letters.length > 0,
  };
}

/** Returns all tables, in the order of the page. */
export function tables() {
  const names = readdirSync(RESULTS).map((file) => file.replace(/\.json$/, ''));
  const rank = (name) => (ORDER.includes(name) ? ORDER.indexOf(name) : ORDER.length);
  return names.sort((a, b) => rank(a) - rank(b) || (a < b ? -1 : 1)).map(table);
}
