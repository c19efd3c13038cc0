import boot from './boot.mjs?raw';
import { addressOf, allParts, modulesOf, neededFor, partOf, stylesOf } from './catalogue';
import style from './page.css?raw';

/** What an example's frame says. */
export type Said =
  | { type: 'log'; level: 'log' | 'info' | 'warn' | 'error'; text: string }
  | { type: 'error'; message: string; line: number | null }
  | { type: 'done' };

// No module, since an import map has to come before the first one.
const DOCUMENT = `<!doctype html><html lang="en"><head><meta charset="utf-8"><title>The result</title></head><body><script>(() => {
${boot}
})();</script></body></html>`;

/** What the code needs, fetched. */
async function loaded(code: string, files: readonly string[]) {
  const names = neededFor(code);
  const bytes = async (name: string) => [name, await (await fetch(addressOf(name))).arrayBuffer()];
  const [modules, parts, styles, contents] = await Promise.all([
    modulesOf(names),
    // Workers cannot ask for them.
    /\bnew (Shared)?Worker\b/.test(code) ? allParts() : null,
    Promise.all(stylesOf(names).map(({ text }) => text())),
    Promise.all(files.map(bytes)),
  ]);
  return {
    modules,
    allParts: parts,
    styles: [style, ...styles],
    files: Object.fromEntries(contents),
  };
}

/**
 * Runs code in a new frame in a place, instead of what runs there. The frame has no origin, so that the code has nothing
 * of this site, and no request of its own reaches it: the page hands over all that it needs.
 */
export function run(
  place: HTMLElement,
  code: string,
  files: readonly string[],
  heard: (said: Said) => void,
): void {
  const frame = document.createElement('iframe');
  frame.title = 'The result';
  frame.sandbox.add('allow-scripts', 'allow-downloads');
  const root = document.documentElement;
  const isDark = () => root.dataset.theme === 'dark';
  const needed = loaded(code, files);
  const tell = (message: object) => frame.contentWindow?.postMessage(message, '*');
  const listen = async ({ source, data }: MessageEvent) => {
    if (!frame.isConnected) removeEventListener('message', listen);
    if (source !== frame.contentWindow || source === null) return;
    try {
      if (data.type === 'ready') tell({ type: 'start', code, dark: isDark(), ...(await needed) });
      else if (data.type === 'part')
        tell({ type: 'part', name: data.name, text: await partOf(data.name) });
      else heard(data);
    } catch (error) {
      heard({
        type: 'error',
        message: `What the example needs did not load: ${error}`,
        line: null,
      });
    }
  };
  addEventListener('message', listen);
  new MutationObserver((_, observer) => {
    if (frame.isConnected) tell({ type: 'theme', dark: isDark() });
    else observer.disconnect();
  }).observe(root, { attributeFilter: ['data-theme'] });
  frame.srcdoc = DOCUMENT;
  place.replaceChildren(frame);
}
