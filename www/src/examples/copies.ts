import { addressesOf, addressOf, namedIn, neededFor, stylesOf } from './catalogue';
import style from './page.css?raw';

/** What of a name belongs to the package: @scope/name/part is of @scope/name. */
const packageOf = (name: string) => /^(@[^/]+\/)?[^/]+/.exec(name)?.[0] ?? name;

/** Where the example's files are. */
const filesNote = (files: readonly string[]) => files.map((name) => `${name}: ${addressOf(name)}`);

/** The code for a project with a bundler. */
export function forNpm(code: string, files: readonly string[]): string {
  const packages = [...new Set(namedIn(code).map(packageOf))];
  return [
    `// npm install ${packages.join(' ')}`,
    ...filesNote(files).map((line) => `// ${line}`),
    ...stylesOf(neededFor(code)).map(({ path }) => `import '${path}';`),
    code,
  ].join('\n');
}

/** A whole page that needs no bundler. */
export function forPage(title: string, code: string, files: readonly string[]): string {
  const names = neededFor(code);
  const indented = (text: string) => text.trimEnd().replace(/^(?=.)/gm, '  ');
  return `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>${title}</title>
${filesNote(files)
  .map((line) => `<!-- ${line} -->\n`)
  .join('')}${stylesOf(names)
  .map(({ cdn }) => `<link rel="stylesheet" href="${cdn}">\n`)
  .join('')}<style>
${indented(style)}
</style>
<script type="importmap">
${indented(JSON.stringify({ imports: addressesOf(names) }, null, 2))}
</script>
<body>
<script type="module">
${code.replaceAll('</script', '<\\/script')}
</script>
`;
}
