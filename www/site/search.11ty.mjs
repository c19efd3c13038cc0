// Makes search.json: the words of all pages, by their parts, as src/site/search.ts loads them.

import { readFileSync } from 'node:fs';
import MiniSearch from 'minisearch';

const fields = JSON.parse(
  readFileSync(new URL('../src/site/fields.json', import.meta.url), 'utf8'),
);

/** Headings of the reference that say what kind of thing follows, on every page. */
const GENERIC =
  /^(Parameters|Type Parameters|Returns|Throws|Call Signature|Extends|Extended by|Inherited from|Overrides|Examples?|Type Declaration)$/;
/** Characters of text that a part of the reference is found by. */
const REFERENCE_TEXT = 240;

const textOf = (html) =>
  html
    .replace(/<[^>]+>/g, ' ')
    .replace(/&lt;/g, '<')
    .replace(/&gt;/g, '>')
    .replace(/&quot;/g, '"')
    .replace(/&#39;/g, "'")
    .replace(/&amp;/g, '&')
    .replace(/\s+/g, ' ')
    .trim();

/** Splits a page at its headings. */
function* partsOf({ data, url, content }) {
  const page = { title: data.title, kind: data.kind ?? '', part: '', id: url.slice(1) };
  const isReference = url.startsWith('/api/');
  const pieces = content.split(/(?=<h[23] id=")/);
  yield { ...page, about: data.description ?? '', text: isReference ? '' : textOf(pieces[0]) };
  for (const piece of pieces.slice(1)) {
    const [heading, level, id, name] = /^<h([23]) id="([^"]+)"[^>]*>(.*?)<\/h\1>/s.exec(piece);
    const part = textOf(name);
    if (isReference && (level === '2' || GENERIC.test(part))) continue;
    const text = textOf(piece.slice(heading.length));
    yield {
      ...page,
      part,
      id: `${page.id}#${id}`,
      about: text.slice(0, 160),
      text: isReference ? text.slice(0, REFERENCE_TEXT) : text,
    };
  }
}

export const data = {
  permalink: '/search.json',
  eleventyExcludeFromCollections: true,
  layout: null,
};

export function render({ collections }) {
  const search = new MiniSearch(fields);
  for (const page of collections.all) if (page.data.title) search.addAll([...partsOf(page)]);
  return JSON.stringify(search);
}
