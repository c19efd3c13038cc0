// Runs in the frame of an example, which has no origin: it makes modules of the texts that the page sends, answers
// requests for the example's files, and tells the page what happens.

const tell = (message) => parent.postMessage(message, '*');

/** Where the visitor's code is. */
let own = '';

const addressOf = (text) => URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));

/** The line in the visitor's code from which an error comes, or null. */
function lineOf(error, event) {
  if (event?.filename === own && event.lineno > 0) return event.lineno;
  const found = String(error?.stack).split(`${own}:`)[1];
  return found ? Number.parseInt(found, 10) : null;
}

function failed(error, event) {
  const message = error instanceof Error ? `${error.name}: ${error.message}` : String(error ?? event?.message);
  tell({ type: 'error', message, line: lineOf(error, event) });
}

addEventListener('error', (event) => failed(event.error, event));
addEventListener('unhandledrejection', ({ reason }) => failed(reason));

for (const level of ['log', 'info', 'warn', 'error']) {
  const write = console[level];
  console[level] = (...values) => {
    write(...values);
    const text = values.map((value) => (typeof value === 'object' ? JSON.stringify(value) : String(value)));
    tell({ type: 'log', level, text: text.join(' ') });
  };
}

/** The page fetches the package's own files when they are needed, also for workers of the visitor's: see part.mjs. */
const parts = new BroadcastChannel('gdel-parts');
parts.onmessage = ({ data }) => data.wanted && tell({ type: 'part', name: data.wanted });

function start({ code, modules, files, styles, dark }) {
  document.documentElement.style.colorScheme = dark ? 'dark' : 'light';
  for (const style of styles) document.head.append(Object.assign(document.createElement('style'), { textContent: style }));
  const request = globalThis.fetch;
  globalThis.fetch = async (input, ...rest) =>
    files[input] ? new Response(files[input].slice(0)) : request(input, ...rest);
  const imports = Object.fromEntries(Object.entries(modules).map(([name, text]) => [name, addressOf(text)]));
  const script = (type, properties) =>
    document.head.append(Object.assign(document.createElement('script'), { type, ...properties }));
  script('importmap', { textContent: JSON.stringify({ imports }) });
  own = addressOf(code);
  // The element reports errors with their lines; importing the same module tells when it has ended.
  script('module', { src: own });
  import(own).then(() => tell({ type: 'done' }), () => {});
}

addEventListener('message', ({ data }) => {
  if (data.type === 'part') parts.postMessage(data);
  else start(data);
});
tell({ type: 'ready' });
