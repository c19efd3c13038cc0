// Makes BENCHMARKS.md of benches/results/*.json.
//
//   node scripts/benchmarks.mjs            writes it
//   node scripts/benchmarks.mjs --check    fails where it is not what would be written

import { readFileSync, writeFileSync } from 'node:fs';
import { tables } from './results.mjs';

const PAGE = new URL('../BENCHMARKS.md', import.meta.url);

const INTRODUCTION = `<!-- Made of benches/results/*.json by scripts/benchmarks.mjs: do not edit. -->
# Benchmarks

Each process says the median of its runs, after others to warm up; a cell has the median of processes, with the range in brackets. \`cargo run --release -p gdel-bench -- --help\` measures: its lines of JSON go to \`benches/results/\`, and \`node scripts/benchmarks.mjs\` makes this page of them. Rows up to 2026-11-28 are of programs that it has replaced; the rows name them. Why things are as they are is in [docs/decisions](docs/decisions).
`;

const line = (cells) => `| ${cells.join(' | ')} |`;

function section({ title, about, keys, values, lines, hasLetters }) {
  const heads = [...keys, ...values, ...(hasLetters ? ['on'] : [])];
  const rows = lines.map((each) =>
    line([
      ...each.keys,
      ...each.values.map(({ text }) => text),
      ...(hasLetters ? [each.letter] : []),
    ]),
  );
  const head = [line(heads), line(heads.map(() => '---'))];
  return [`## ${title}`, about, [...head, ...rows].join('\n')].join('\n\n');
}

const page = `${[INTRODUCTION.trimEnd(), ...tables().map(section)].join('\n\n')}\n`;
if (process.argv.includes('--check')) {
  if (readFileSync(PAGE, 'utf8') !== page) {
    console.error('BENCHMARKS.md is not made of benches/results: run node scripts/benchmarks.mjs');
    process.exit(1);
  }
} else {
  writeFileSync(PAGE, page);
}
