// Runs the programs of the guides: blocks of Markdown that begin with ```js run.

import { readFileSync } from 'node:fs';
import { serve } from '../../tests/web/server.mjs';

const web = new URL('../../web/', import.meta.url);

/** The entries of the package, as a page without a bundler finds them. */
const { exports } = JSON.parse(readFileSync(new URL('package.json', web), 'utf8'));
const imports = Object.fromEntries(
  Object.entries(exports)
    .filter(([, entry]) => entry.default)
    .map(([name, entry]) => [
      name.replace('.', 'gdel-wasm'),
      entry.default.replace('./dist', '/gdel'),
    ]),
);

/** Returns the programs of a Markdown file, each with what it says that it logs. */
export function programsOf(markdown) {
  return [...markdown.matchAll(/^```js run\n(.*?)^```$/gms)].map(([, code]) => ({
    code,
    says: [...code.matchAll(/\/\/ → (.*)$/gm)].map(([, value]) => value),
  }));
}

/** Serves the package to programs. */
export async function openPlace(browser) {
  const server = await serve({ '/gdel/': new URL('dist', web).pathname });
  const page = await browser.newPage();
  await page.goto(server.url);
  await page.evaluate((imports) => {
    const map = document.createElement('script');
    map.type = 'importmap';
    map.textContent = JSON.stringify({ imports });
    document.head.append(map);
  }, imports);
  return {
    /** Runs a program, and returns what it logs. */
    run: (code) =>
      page.evaluate(async (code) => {
        const lines = [];
        const text = (value) =>
          typeof value === 'string'
            ? value
            : JSON.stringify(ArrayBuffer.isView(value) ? Array.from(value) : value).replaceAll(
                ',',
                ', ',
              );
        const { log } = console;
        console.log = (...values) => lines.push(values.map(text).join(' '));
        const url = URL.createObjectURL(new Blob([code], { type: 'text/javascript' }));
        try {
          await import(url);
        } finally {
          console.log = log;
          URL.revokeObjectURL(url);
        }
        return lines;
      }, code),
    async close() {
      await page.close();
      server.close();
    },
  };
}
