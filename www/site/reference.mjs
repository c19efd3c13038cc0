// Makes a page of Markdown of each export of the package, in site/api/: what TypeDoc reads from the sources.

import { rmSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { Application, PageEvent, ReflectionKind } from 'typedoc';

const web = new URL('../../web/', import.meta.url);
const out = new URL('api/gdel-wasm/', import.meta.url);
const here = (path, base = web) => fileURLToPath(new URL(path, base));

/** The entries that package.json exports; `inline` has what the main one has. */
export const ENTRIES = [
  'index',
  'cdt2d',
  'constrainautor',
  'd3-voronoi-map',
  'd3-voronoi-treemap',
  'd3-weighted-voronoi',
  'delaunator',
  'earcut',
  'tin',
  'treemap',
];

/** Headings that say what kind of thing follows, on every page. */
export const GENERIC =
  /^(Parameters|Type Parameters|Returns|Throws|Call Signature|Extends|Extended by|Inherited from|Overrides|Examples?|Type Declaration|Implements|Implementation of|Deprecated|Default|default|See|Properties)$/;

/** Returns the first sentence of what the sources say about an export. */
function summaryOf(model) {
  const comment = model.comment ?? model.signatures?.[0]?.comment;
  const text = (comment?.summary ?? []).map((part) => part.text).join('');
  const words = text.replace(/`|\*(?=\w)|(?<=\w)\*/g, '').replace(/\s+/g, ' ');
  return /^.*?(\.(?= |$)|$)/.exec(words)[0];
}

/** Puts the data that the layouts show before the text of a page. */
function addFrontMatter(page) {
  const { model } = page;
  const isEntry = model.kindOf(ReflectionKind.Module);
  const data = {
    title: model.name,
    description: summaryOf(model) || `${model.name} in the reference of gdel-wasm.`,
    entry: isEntry ? model.name : model.parent.name,
    member: isEntry ? '' : ReflectionKind.singularString(model.kind),
  };
  page.contents = `---json\n${JSON.stringify(data, null, 2)}\n---\n\n${page.contents}`;
}

export async function writeReference() {
  rmSync(out, { recursive: true, force: true });
  const app = await Application.bootstrapWithPlugins({
    plugin: ['typedoc-plugin-markdown'],
    entryPoints: ENTRIES.map((name) => here(`src/${name}.ts`)),
    tsconfig: here('tsconfig.json'),
    name: 'gdel-wasm',
    out: here('../', out),
    readme: 'none',
    router: 'member',
    cleanOutputDir: false,
    entryFileName: 'index',
    excludeInternal: true,
    excludePrivate: true,
    disableSources: true,
    hideBreadcrumbs: true,
    hidePageHeader: true,
    parametersFormat: 'table',
    indexFormat: 'table',
    // Entries name types and errors of the main one, which are no exports of theirs.
    validation: { notExported: false, invalidLink: false },
    // The build of the package checks types.
    skipErrorChecking: true,
    logLevel: 'Warn',
  });
  const project = await app.convert();
  for (const entry of project.children)
    entry.name = entry.name === 'index' ? 'gdel-wasm' : `gdel-wasm/${entry.name}`;
  app.renderer.on(PageEvent.END, (page) => {
    if (page.model !== project) addFrontMatter(page);
  });
  await app.generateOutputs(project);
  // The list of entries has a page of its own.
  rmSync(new URL('../index.md', out));
}
