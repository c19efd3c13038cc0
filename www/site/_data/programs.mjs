import { readFileSync } from 'node:fs';

const read = (name) => readFileSync(new URL(`../../programs/${name}`, import.meta.url), 'utf8');
const terms = JSON.parse(read('files.json'));

/** The examples with their code, in the order of the catalogue. */
export default JSON.parse(read('catalogue.json')).map(({ files, output, ...program }) => ({
  ...program,
  code: read(`${program.name}.${output ? 'mjs' : 'js'}`),
  output: output && read(output),
  files: files.map((name) => ({ name, terms: terms[name] })),
}));
