// Makes search.json: the words of all pages, by their parts, as src/site/search.ts loads them.

import { readFileSync } from 'node:fs';
import MiniSearch from 'minisearch';
import { GENERIC } from './reference.mjs';

const fields = JSON.parse(
  readFileSync(new URL('../src/site/fields.json', import.meta.url), 'utf8'),
);

/** Characters of text that a part of the reference is found by. */
const REFERENCE_TEXT = 240;

/** The signature of a function, and the tables of its parameters. */
const SIGNATURE = /<blockquote>.*?<\/blockquote>|<h[456] .*$/gs;

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
  const page = { title: data.title, kind: data.kind ?? '', part: '', id: url.slice(1), page: '' };
  const isReference = url.startsWith('/api/');
  const pieces = content.split(/(?=<h[23] id=")/);
  yield {
    ...page,
    page: data.title,
    about: data.description ?? '',
    text: isReference ? '' : textOf(pieces[0]),
  };
  for (const piece of pieces.slice(1)) {
    const [heading, level, id, name] = /^<h([23]) id="([^"]+)"[^>]*>(.*?)<\/h\1>/s.exec(piece);
    const part = textOf(name);
    // What is inherited is found where it comes from.
    const isRepeated = GENERIC.test(part) || /<h\d id="inherited-from/.test(piece);
    if (isReference && (level === '2' || isRepeated)) continue;
    const body = piece.slice(heading.length).replace(SIGNATURE, '');
    const text = textOf(body);
    const [sentences = text] = body.match(/<p>.*?<\/p>/s) ?? [];
    yield {
      ...page,
      part,
      id: `${page.id}#${id}`,
      about: textOf(sentences).slice(0, 160),
      text: `${data.title} ${isReference ? text.slice(0, REFERENCE_TEXT) : text}`,
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
