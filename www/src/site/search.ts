import type MiniSearch from 'minisearch';
import type { Options, SearchResult } from 'minisearch';
import indexUrl from '../../search.json?url';
import { byId, create, things } from '../ui/dom';
import fields from './fields.json';
import { ROOT } from './root';

/** A part of a page that the search can find. Its address begins at the folder with the demo page. */
interface Part {
  id: string;
  title: string;
  /** The heading of the part; empty for the beginning of a page. */
  part: string;
  /** What the page is: a guide, an example, a function. */
  kind: string;
  about: string;
}

const SHOWN = 12;

let loading: Promise<MiniSearch<Part>> | undefined;

/** Loads the words of all pages, when somebody is about to search. */
function load(): Promise<MiniSearch<Part>> {
  loading ??= (async () => {
    const [{ default: Search }, json] = await Promise.all([
      import('minisearch'),
      fetch(indexUrl).then((response) => response.text()),
    ]);
    return Search.loadJSON<Part>(json, fields as Options<Part>);
  })();
  return loading;
}

/** Sentences that explain come before those that describe. */
const boostDocument = (_id: string, _word: string, part?: Record<string, unknown>) =>
  part?.kind === 'Guide' || part?.kind === 'Example' ? 1.4 : 1;

/** Returns a result as a link. */
function linkTo({ id, title, part, kind, about }: Part & SearchResult): HTMLAnchorElement {
  const name = part ? `${title}: ${part}` : title;
  const link = create('a', { href: new URL(id, ROOT).href }, create('b', {}, name));
  link.append(create('small', {}, [kind, about].filter(Boolean).join(' · ')));
  return link;
}

export function wireSearch(): void {
  const input = byId<HTMLInputElement>('search');
  const found = byId('found');
  const status = byId('found-count');

  const show = async () => {
    const words = input.value.trim();
    if (words === '') {
      found.hidden = true;
      status.textContent = '';
      return;
    }
    const search = await load();
    // Another letter may have come meanwhile.
    if (words !== input.value.trim()) return;
    const results = search.search(words, { boostDocument }) as (Part & SearchResult)[];
    found.replaceChildren(
      ...(results.length > 0
        ? results.slice(0, SHOWN).map(linkTo)
        : [create('p', {}, 'Nothing is found for these words.')]),
    );
    found.dataset.words = words;
    found.hidden = false;
    status.textContent = things(results.length, 'result', 'results');
  };
  const close = () => {
    found.hidden = true;
  };

  input.addEventListener('focus', () => void load());
  input.addEventListener('input', () => void show());
  document.addEventListener('keydown', (event) => {
    const typing = (event.target as HTMLElement).closest('input, textarea, select');
    if (event.key === '/' && !typing) {
      event.preventDefault();
      input.focus();
    }
  });
  byId('searching').addEventListener('keydown', (event) => {
    const links = [...found.querySelectorAll('a')];
    const at = links.indexOf(document.activeElement as HTMLAnchorElement);
    if (event.key === 'Escape') {
      input.focus();
      close();
    } else if (event.key === 'Enter' && at < 0) {
      links[0]?.click();
    } else if (event.key === 'ArrowDown' || event.key === 'ArrowUp') {
      event.preventDefault();
      const next = at + (event.key === 'ArrowDown' ? 1 : -1);
      (links[next] ?? (next < 0 ? input : undefined))?.focus();
    }
  });
  document.addEventListener('click', (event) => {
    if (!byId('searching').contains(event.target as Node)) close();
  });
}
