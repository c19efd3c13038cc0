// Runs in the frame of an example, which has no origin: it makes modules of the texts that the page sends, answers
// requests for the example's files, and tells the page what happens.

const tell = (message) => parent.postMessage(message, '*');

/** Where the visitor's code is. */
let own = '';

const addressOf = (text) => URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));

/** The line in the visitor's code from which an error comes, or null. */
function lineOf(error, event) {
  if (event?.filename === own && event.lineno > 0) return event.lineno;
  const found = own && String(error?.stack).split(`${own}:`)[1];
  return found ? Number.parseInt(found, 10) : null;
}

function failed(error, event) {
  const message =
    error instanceof Error ? `${error.name}: ${error.message}` : String(error ?? event?.message);
  tell({ type: 'error', message, line: lineOf(error, event) });
}

addEventListener('error', (event) => failed(event.error, event));
addEventListener('unhandledrejection', ({ reason }) => failed(reason));

for (const level of ['log', 'info', 'warn', 'error']) {
  const write = console[level];
  console[level] = (...values) => {
    write(...values);
    const text = values.map((value) =>
      typeof value === 'object' ? JSON.stringify(value) : String(value),
    );
    tell({ type: 'log', level, text: text.join(' ') });
  };
}

/** What gives the package its own files, by their names, once the page has sent them. */
const parts = new Map();

/** The package's main file calls this in place of imports. */
globalThis.partOf = (name) => {
  let part = parts.get(name);
  if (!part) {
    part = {};
    part.module = new Promise((resolve) => {
      part.resolve = resolve;
    });
    parts.set(name, part);
    tell({ type: 'part', name });
  }
  return part.module;
};

/** The same for workers, which cannot ask the page: it has sent all files. */
function partsAtHand(texts) {
  const addresses = Object.entries(texts).map(([name, text]) => [name, addressOf(text)]);
  return `const partOf = (name) => import(${JSON.stringify(Object.fromEntries(addresses))}[name]);\n`;
}

const setTheme = (dark) => {
  document.documentElement.style.colorScheme = dark ? 'dark' : 'light';
};

function start({ code, modules, files, styles, dark, allParts }) {
  setTheme(dark);
  for (const style of styles)
    document.head.append(Object.assign(document.createElement('style'), { textContent: style }));
  const request = globalThis.fetch;
  globalThis.fetch = async (input, ...rest) =>
    files[input] ? new Response(files[input].slice(0)) : request(input, ...rest);
  const imports = {};
  for (const { names, text } of modules) {
    const isPackage = allParts && names.includes('gdel-wasm');
    const address = addressOf(isPackage ? partsAtHand(allParts) + text : text);
    for (const name of names) imports[name] = address;
  }
  const script = (type, properties) =>
    document.head.append(Object.assign(document.createElement('script'), { type, ...properties }));
  script('importmap', { textContent: JSON.stringify({ imports }) });
  own = addressOf(code);
  // The element reports errors with their lines; importing the same module tells when it has ended.
  script('module', { src: own });
  import(own).then(
    () => tell({ type: 'done' }),
    () => {},
  );
}

addEventListener('message', ({ data }) => {
  if (data.type === 'part') parts.get(data.name).resolve(import(addressOf(data.text)));
  else if (data.type === 'theme') setTheme(data.dark);
  else start(data);
});
tell({ type: 'ready' });
