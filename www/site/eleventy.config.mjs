// The pages beside the demo: Eleventy makes HTML files of what is in this folder, and Vite then builds them with the
// demo page (vite.config.ts), which hashes their scripts and styles and makes all addresses relative.
//
//   _layouts/base.njk      what every page has: head, navigation, search
//   _layouts/article.njk   the same with text in a column, and a list of the section's pages beside it
//   _data/site.mjs         version, repository and navigation, as `site` in templates
//   guide/NAME.md          a guide, at /guide/NAME/; `order` in its front matter is its place
//   examples/              their index, and a page for each program of programs/catalogue.json
//   benchmarks/            the charts, made of benches/results
//   api/                   the reference, made by TypeDoc (reference.mjs)
//   search.11ty.mjs        the words of all pages, for the search
//
// A page is Markdown or Nunjucks with front matter:
//
//   title        required
//   description  one sentence, for search engines, lists and the search
//   script       a module for this page alone, such as /src/examples/weather.ts, without `await` at its top level: because of
//                one, Rolldown cuts all pages, also the demo, into more and smaller files
//   style        a style sheet for this page alone, such as /src/examples/weather.css
//
// The main element of a page has the id `main`, to which the link at its top leads. Links are addresses from the root (/guide/),
// which become relative, or files of the repository (repo:docs/answers.md). What is written goes to www/guide, www/api, … beside
// the sources of the demo, where Vite finds it; git ignores it.
//
// A block of Markdown that begins with ```js run is a program of its own. tests/site.test.mjs runs it in a browser, where what
// it logs must be what its comments `// → …` say, in order.

import { readFileSync, rmSync } from 'node:fs';
import { InputPathToUrlTransformPlugin } from '@11ty/eleventy';
import shiki from '@shikijs/markdown-it';
import anchor from 'markdown-it-anchor';
import site from './_data/site.mjs';
import { GENERIC, writeReference } from './reference.mjs';

/** Returns the name by which GitHub, too, links to a heading. */
const slugify = (text) =>
  text
    .trim()
    .toLowerCase()
    .replace(/[^\p{L}\p{N}\s_-]/gu, '')
    .replace(/\s/g, '-');

/** Returns what the list beside a text shows of it: its headings, in the reference the members of a class or an interface. */
function headings(html) {
  const level = this.page.url.startsWith('/api/gdel-wasm/') ? 3 : 2;
  const all = html.matchAll(/<h([23]) id="([^"]+)"[^>]*>(.*?)<\/h\1>/gs);
  return [...all]
    .map(([, found, id, text]) => ({
      found: Number(found),
      id,
      text: text.replace(/<[^>]+>/g, ''),
    }))
    .filter(({ found, text }) => found === level && !GENERIC.test(text));
}

/** Returns an address from the root as one that is relative to a page, and one in the repository in full. */
function relativeTo(page, address) {
  if (address.startsWith('repo:')) return `${site.repository}/blob/main/${address.slice(5)}`;
  if (!address.startsWith('/') || !page.url) return address;
  const up = '../'.repeat(page.url.split('/').length - 2);
  return `${up}${address.slice(1)}` || './';
}

/** Puts code into a box, for the button that copies it, and tables into one that scrolls. */
function boxes(markdown) {
  const { rules } = markdown.renderer;
  const fence = rules.fence ?? markdown.renderer.rules.fence;
  rules.fence = (...args) => `<div class="code">${fence(...args)}</div>\n`;
  rules.table_open = () =>
    '<div class="scroll" tabindex="0" role="group" aria-label="Table"><table>\n';
  rules.table_close = () => '</table></div>\n';
}

export default async function configure(eleventy) {
  for (const folder of ['api', 'benchmarks', 'examples', 'guide'])
    rmSync(new URL(`../${folder}`, import.meta.url), { recursive: true, force: true });
  await writeReference();
  eleventy.setUseGitIgnore(false);
  eleventy.setQuietMode(true);

  const highlight = await shiki({
    langs: ['js', 'ts', 'python', 'rust', 'cpp', 'sh', 'json', 'html', 'css'],
    themes: { light: 'github-light-high-contrast', dark: 'github-dark-high-contrast' },
    defaultColor: false,
    // The first line takes long, while grammars are compiled, and would lose its colours.
    tokenizeTimeLimit: 0,
  });
  eleventy.amendLibrary('md', (markdown) =>
    markdown
      .set({ html: true })
      .use(highlight)
      .use(boxes)
      .use(anchor, { slugify, tabIndex: false }),
  );

  // The package has this one as well.
  const arrays = readFileSync(new URL('../../web/docs/arrays.md', import.meta.url), 'utf8');
  eleventy.addTemplate('guide/arrays.md', arrays, {
    title: 'How points map to arrays',
    short: 'Arrays',
    description: 'What is where in the arrays of a mesh, with pictures and recipes.',
    order: 8,
  });
  eleventy.addFilter('headings', headings);
  eleventy.addFilter('of', (pages, entry, member) =>
    pages.filter(({ data }) => data.entry === entry && data.member === member),
  );
  eleventy.addCollection('guide', (all) =>
    all
      .getAll()
      .filter(({ data, url }) => data.order && url.startsWith('/guide/'))
      .sort((a, b) => a.data.order - b.data.order),
  );
  const reference = (isMember) => (all) =>
    all
      .getAll()
      .filter(({ data }) => data.entry && isMember === (data.member !== ''))
      .sort((a, b) => (a.url < b.url ? -1 : 1));
  eleventy.addCollection('entries', reference(false));
  eleventy.addCollection('members', reference(true));
  eleventy.addPlugin(InputPathToUrlTransformPlugin);
  eleventy.htmlTransformer.addUrlTransform(
    'html',
    function (address) {
      return relativeTo(this.page, address);
    },
    // After links to Markdown have become addresses.
    { priority: -2 },
  );
  return {
    dir: { input: 'site', output: '.', layouts: '_layouts', data: '_data' },
    markdownTemplateEngine: false,
    htmlTemplateEngine: 'njk',
  };
}
