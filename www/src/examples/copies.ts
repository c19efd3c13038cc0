import { addressesOf, addressOf, namesFor, stylesOf } from './catalogue';
import style from './page.css?raw';
import { specifiersOf } from './specifiers';

/** What of a name belongs to the package: @scope/name/part is of @scope/name. */
const packageOf = (name: string) => /^(@[^/]+\/)?[^/]+/.exec(name)?.[0] ?? name;

/** Where the example's files are. */
const filesNote = (files: readonly string[]) =>
  files.map((name) => `${name}: ${addressOf(name)}`);

/** The code for a project with a bundler. */
export async function forNpm(code: string, files: readonly string[]): Promise<string> {
  const names = await specifiersOf(code);
  const packages = [...new Set(names.filter((name) => !name.startsWith('node:')).map(packageOf))];
  return [
    `// npm install ${packages.join(' ')}`,
    ...filesNote(files).map((line) => `// ${line}`),
    ...stylesOf(namesFor(names)).map(({ path }) => `import '${path}';`),
    code,
  ].join('\n');
}

/** A whole page that needs no bundler. */
export async function forPage(title: string, code: string, files: readonly string[]): Promise<string> {
  const names = namesFor(await specifiersOf(code));
  const indented = (text: string) => text.trimEnd().replace(/^(?=.)/gm, '  ');
  return `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>${title}</title>
${filesNote(files).map((line) => `<!-- ${line} -->\n`).join('')}${stylesOf(names)
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
