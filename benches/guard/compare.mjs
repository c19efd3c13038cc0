// Compares what scripts/guard.sh has counted with figures.json, or writes it there.
//
//   node benches/guard/compare.mjs [--accept] SECTION…

import { execFileSync } from 'node:child_process';
import { existsSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';

const root = dirname(dirname(dirname(fileURLToPath(import.meta.url))));
const FIGURES = join(root, 'benches/guard/figures.json');
const counted = (file) => readFileSync(join(root, 'target/guard', file), 'utf8').split('\n');

/** By how much a count may differ, in per cent. */
const MARGIN = 3;

/**
 * Wider margins. Which of two flips that exclude each other wins is a race on the device. The pins
 * of guard.sh decide it, so that runs on one machine agree, but another processor, or a changed
 * kernel, may decide otherwise: then these counts differ though nothing got worse. Measured on one
 * core and two, with one thread of lavapipe and two, the counts ranged over 107 to 174 failed
 * vertices on the sphere and 0 to 34 in the cube, 15 % of the few exact tests in the cube, 7 % of
 * the dispatches on sphere and circle, 3 % of all others, and less than 1 % of the flips. */
const MARGINS = [
  [/^gpu .*, failed vertices$/, 100],
  [/^gpu 3D uniform, exact tests$/, 30],
  [/^gpu (3D sphere|2D circle), dispatches$/, 12],
  [/^gpu .*, (flip iterations|dispatches|exact tests)$/, 6],
];
const marginOf = (row) => MARGINS.find(([pattern]) => pattern.test(row))?.[1] ?? MARGIN;

/** The counts of each section, by row. */
const SECTIONS = {
  instructions() {
    const runs = counted('instructions.jsonl')
      .filter((line) => line.startsWith('{'))
      .map((line) => JSON.parse(line));
    return runs.map(({ function_name, id, profiles }) => {
      const profile = profiles.find(({ tool }) => tool === 'Callgrind');
      return [`instructions ${function_name}, ${id}`, profile.data.total.metrics.Ir.values.new];
    });
  },

  gpu() {
    const lines = counted('gpu.txt').map((line) => line.match(/^(gpu .*): (\d+)$/));
    return lines.filter(Boolean).map(([, row, count]) => [row, Number(count)]);
  },

  sizes() {
    const dist = join(root, 'web/dist');
    if (!existsSync(dist)) throw new Error('web/dist is missing: run `npm run build` first');
    // The others are copies of these in another form.
    const files = readdirSync(dist).filter((file) => /^(?!inline|core).*\.(wasm|js)$/.test(file));
    return files.flatMap((file) => {
      const content = readFileSync(join(dist, file));
      return [
        [`sizes ${file}, bytes`, content.length],
        [`sizes ${file}, gzipped`, gzipSync(content, { level: 9 }).length],
      ];
    });
  },
};

const names = process.argv.slice(2).filter((name) => name !== '--accept');
const accept = process.argv.includes('--accept');
const figures = existsSync(FIGURES)
  ? JSON.parse(readFileSync(FIGURES, 'utf8'))
  : { rustc: null, counts: {} };
const rustc = execFileSync('rustc', ['--version'], { cwd: root, encoding: 'utf8' }).trim();
const isOtherRustc = names.includes('instructions') && rustc !== figures.rustc;

const after = new Map();
for (const name of names) {
  const rows = SECTIONS[name]();
  if (rows.length === 0) throw new Error(`nothing was counted of ${name}`);
  for (const [row, count] of rows) after.set(row, count);
}
const before = new Map(
  Object.entries(figures.counts).filter(([row]) => names.includes(row.split(' ', 1)[0])),
);

const number = (count) => count.toLocaleString('en');
const complaints = [];
const accepted = { ...figures.counts };
for (const row of [...new Set([...before.keys(), ...after.keys()])].sort()) {
  const [old, now] = [before.get(row), after.get(row)];
  const complain = (what) => complaints.push(`  ${row}: ${what}`);
  if (old === undefined) {
    complain(`new, ${number(now)}`);
  } else if (now === undefined) {
    complain(`gone, was ${number(old)}`);
    delete accepted[row];
    continue;
  } else if (Math.abs(now - old) * 100 > marginOf(row) * old) {
    const change =
      old === 0
        ? ''
        : ` (${now > old ? '+' : '−'}${((Math.abs(now - old) / old) * 100).toFixed(1)} %)`;
    const word = now > old ? 'more' : 'fewer';
    complain(
      `${number(old)} before, ${number(now)} now${change}: ${word} than the margin of ${marginOf(row)} % allows`,
    );
  } else if (!(isOtherRustc && row.startsWith('instructions '))) {
    continue;
  }
  accepted[row] = now;
}

if (accept) {
  const rows = Object.keys(accepted).sort();
  const lines = rows.map((row) => `    ${JSON.stringify(row)}: ${accepted[row]}`);
  const kept = names.includes('instructions') ? rustc : figures.rustc;
  writeFileSync(
    FIGURES,
    `{\n  "rustc": ${JSON.stringify(kept)},\n  "counts": {\n${lines.join(',\n')}\n  }\n}\n`,
  );
  console.log(
    `guard: accepted into benches/guard/figures.json:\n${complaints.join('\n') || '  nothing was off its margin'}`,
  );
} else if (complaints.length > 0) {
  console.error(
    `guard: ${complaints.length} of ${after.size} counts are off:\n${complaints.join('\n')}`,
  );
  if (isOtherRustc) {
    console.error(
      `The figures were taken with ${figures.rustc}, and this is ${rustc}: it may be the compiler's doing.`,
    );
  }
  console.error(
    'A loss has to be mended. To accept a change deliberately, better counts too, so that they cannot be lost',
  );
  console.error(
    `again unseen, run this, and commit benches/guard/figures.json:\n\n  scripts/guard.sh --accept ${names.join(' ')}\n`,
  );
  process.exit(1);
} else {
  console.log(`guard: ${after.size} counts are within their margins`);
  if (isOtherRustc)
    console.log(
      `guard: note that the figures were taken with ${figures.rustc}, and this is ${rustc}`,
    );
}
