import { rowsIn, TableError } from '../model/rows';

/** What a row of a table is for a treemap. */
export interface Row {
  name: string;
  value: number;
  /** The names of the groups that it is in, the widest first. */
  path: string[];
}

/** A table with names and numbers, by its columns. */
export interface Table {
  columns: string[];
  /** The cells of each row; all rows are of the same length. */
  rows: string[][];
  /** The line of the file in which each row begins. */
  lines: number[];
}

/** The columns that make up a treemap; −1 for none. */
export interface Roles {
  name: number;
  value: number;
  group: number;
}

/** More cells than this would take a browser too long. */
const MOST_ROWS = 20_000;

/** What the numbers of a treemap are often called, and what groups are. */
const VALUE = /^(value|size|area|weight|amount|count|total|number|population|share|n)\b/i;
const GROUP = /^(parent|group|category|region|continent|type|sector|class|path)\b/i;

/** Reads a table of text: separated by tabs, semicolons or commas, whichever is most frequent in the first line. */
export function readTable(text: string): Table {
  const found = [...rowsIn(text)];
  const all = found.map(({ cells }) => cells);
  const lines = found.map(({ line }) => line);
  if (all.length === 0) throw new TableError('The file has no rows.');
  if (all.length > MOST_ROWS + 1)
    throw new TableError(
      `The file has ${all.length} rows, and a treemap of more than ${MOST_ROWS} would take too long.`,
    );
  const width = Math.max(...all.map((row) => row.length));
  for (const row of all) while (row.length < width) row.push('');
  // A first row without a number, where all others have some, has the names of the columns.
  const isNumeric = (row: readonly string[]) => row.some((cell) => !Number.isNaN(numberIn(cell)));
  const isHeader = all.length > 1 && !isNumeric(all[0]) && isNumeric(all[1]);
  const columns = isHeader
    ? all[0].map((name, i) => name || `Column ${i + 1}`)
    : all[0].map((_, i) => `Column ${i + 1}`);
  return { columns, rows: all.slice(isHeader ? 1 : 0), lines: lines.slice(isHeader ? 1 : 0) };
}

/** The number in a cell: 1234.5, 1,234.5, 1 234,5 or 12 %. NaN where there is none. */
export function numberIn(cell: string): number {
  const text = cell
    .replace(/[\s\u00A0\u202F'’_]/g, '')
    .replace(/[−–]/, '-')
    .replace(/%$/, '');
  if (text === '') return NaN;
  if (/^[-+]?\d{1,3}(,\d{3})+(\.\d+)?$/.test(text)) return Number(text.replaceAll(',', ''));
  if (/^[-+]?\d{1,3}(\.\d{3})+,\d+$/.test(text))
    return Number(text.replaceAll('.', '').replace(',', '.'));
  if (/^[-+]?\d*,\d+$/.test(text)) return Number(text.replace(',', '.'));
  return Number(text);
}

/** Which columns suit: that with the numbers, that with the names, and perhaps one with groups. */
export function rolesOf({ columns, rows }: Table): Roles {
  const numeric = columns.map((_, at) => {
    const filled = rows.filter((row) => row[at] !== '');
    const numbers = filled.filter((row) => !Number.isNaN(numberIn(row[at])));
    return filled.length > 0 && numbers.length >= filled.length / 2;
  });
  const all = columns.map((_, at) => at);
  const numbers = all.filter((at) => numeric[at]);
  if (numbers.length === 0)
    throw new TableError('No column has numbers. A treemap needs names and numbers.');
  const isOnlyNumbers = numbers.length === columns.length;
  const value =
    numbers.find((at) => VALUE.test(columns[at])) ??
    (isOnlyNumbers && numbers.length > 1 ? numbers[1] : numbers[0]);
  const words = all.filter((at) => at !== value && (!numeric[at] || isOnlyNumbers));
  const name = words.find((at) => !GROUP.test(columns[at])) ?? words[0] ?? -1;
  const group = words.find((at) => at !== name && GROUP.test(columns[at])) ?? -1;
  return { name, value, group };
}

/** Reads the rows for a treemap. What is no number, or negative, is an error that says where. */
export function rowsOf(table: Table, { name, value, group }: Roles): Row[] {
  const { columns, rows, lines } = table;
  const nameOf = (row: readonly string[], i: number) => (name >= 0 && row[name]) || `Row ${i + 1}`;
  const found = rows.map((row, i): Row => {
    const text = row[value];
    const number = numberIn(text);
    const where = `Line ${lines[i]} (${nameOf(row, i)})`;
    if (text === '') throw new TableError(`${where}: there is nothing under “${columns[value]}”.`);
    if (!Number.isFinite(number))
      throw new TableError(`${where}: “${text}” under “${columns[value]}” is not a number.`);
    if (number < 0) throw new TableError(`${where}: ${text} is negative, and no area can be.`);
    const path = group >= 0 && row[group] ? row[group].split('/').map((part) => part.trim()) : [];
    return { name: nameOf(row, i), value: number, path: path.filter((part) => part !== '') };
  });
  if (found.every((row) => row.value === 0))
    throw new TableError(`All numbers under “${columns[value]}” are 0.`);
  return group >= 0 ? withParents(found) : found;
}

/** Where groups are names of other rows, as in a column of parents, a row's path is that of its parent and the parent. */
function withParents(rows: readonly Row[]): Row[] {
  const byName = new Map(rows.map((row) => [row.name, row]));
  if (!rows.some(({ path }) => path.length === 1 && byName.has(path[0]))) return [...rows];
  const pathOf = (row: Row): string[] => {
    const path: string[] = [];
    const seen = new Set([row]);
    for (let at: Row | undefined = row; at?.path.length; ) {
      path.unshift(...at.path);
      at = byName.get(at.path[0]);
      if (at && seen.has(at)) throw new TableError(`“${at.name}” is within itself.`);
      if (at) seen.add(at);
    }
    return path;
  };
  const parents = new Set(rows.flatMap(({ path }) => path.slice(0, 1)));
  // A group has the sum of what is in it.
  return rows
    .filter(({ name }) => !parents.has(name))
    .map((row) => ({ ...row, path: pathOf(row) }));
}

/** A group, or a row. */
export interface Item {
  name: string;
  value: number;
  children?: Item[];
}

/** The rows in their groups. */
export function nested(rows: readonly Row[]): Item[] {
  const top: Item[] = [];
  const groups = new Map<string, Item>();
  for (const { name, value, path } of rows) {
    let inside = top;
    path.forEach((part, depth) => {
      const key = path.slice(0, depth + 1).join('\0');
      let group = groups.get(key);
      if (!group) {
        group = { name: part, value: 0, children: [] };
        groups.set(key, group);
        inside.push(group);
      }
      group.value += value;
      inside = group.children!;
    });
    inside.push({ name, value });
  }
  return top;
}
