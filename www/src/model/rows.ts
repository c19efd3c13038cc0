/** What is wrong with a table, for people. */
export class TableError extends Error {}

/** A row of a table that is not empty. */
export interface TableRow {
  cells: string[];
  /** The line of the text in which it begins. */
  line: number;
}

/** The marks that separate cells: the one that is most frequent in the first line. */
const MARKS = ['\t', ';', ','];

/**
 * Returns the rows of a table of text one by one, with quotes as in RFC 4180. Where the first line has none of the
 * marks, cells are separated by blanks if that is allowed.
 */
export function* rowsIn(text: string, { blanks = false } = {}): Generator<TableRow> {
  const content = text.replace(/^\uFEFF/, '');
  const [first = ''] = content.split(/\r\n|\r|\n/, 1);
  const times = (mark: string) => first.split(mark).length;
  const mark = MARKS.reduce((best, each) => (times(each) > times(best) ? each : best));
  const all = blanks && times(mark) === 1 ? atBlanks(content) : atMarks(content, mark);
  for (const row of all) if (row.cells.some((cell) => cell !== '')) yield row;
}

function* atBlanks(text: string): Generator<TableRow> {
  for (const [i, line] of text.split(/\r\n|\r|\n/).entries())
    yield { cells: line.trim().split(/\s+/), line: i + 1 };
}

function* atMarks(text: string, mark: string): Generator<TableRow> {
  let cells: string[] = [];
  let cell = '';
  let [line, begins, quoted] = [1, 1, false];
  for (let i = 0; i <= text.length; i++) {
    const letter = text[i];
    const isBreak = letter === '\n' || (letter === '\r' && text[i + 1] !== '\n');
    if (isBreak) line++;
    if (letter === undefined && quoted)
      throw new TableError(`Line ${begins}: a quotation mark is opened and never closed.`);
    if (quoted) {
      if (letter !== '"') cell += letter;
      else if (text[i + 1] === '"') {
        cell += '"';
        i++;
      } else quoted = false;
    } else if (letter === '"' && cell.trim() === '') [quoted, cell] = [true, ''];
    else if (letter === mark || isBreak || letter === undefined) {
      cells.push(cell.trim());
      cell = '';
      if (letter === mark) continue;
      yield { cells, line: begins };
      cells = [];
      begins = line;
    } else if (letter !== '\r') cell += letter;
  }
}
