import catalogue from '../../programs/catalogue.json';
import { pack, unpack } from '../model/packed';
import { byId, create } from '../ui/dom';
import { addressOf } from './catalogue';
import { forNpm, forPage } from './copies';
import { editorIn } from './editor';
import { run, type Said } from './run';

const main = byId('main');
const example = catalogue.find(({ name }) => name === main.dataset.name)!;
const original = byId('code').textContent;
const runs = !example.output;
const status = byId('status');

const editor = editorIn(byId('editor'), original, {
  readOnly: !runs,
  changed: () => {
    byId<HTMLButtonElement>('reset').disabled = editor.text === original;
    status.textContent = '';
  },
  run: () => void start(),
});
byId('code').remove();

/** Writes what the frame says below it. */
function heard(said: Said): void {
  if (said.type === 'log') {
    const output = byId('output');
    output.hidden = false;
    output.append(create('span', { className: said.level }, `${said.text}\n`));
    return;
  }
  // What happens after the first error is seldom news.
  if (main.dataset.state === 'failed') return;
  main.dataset.state = said.type === 'done' ? 'done' : 'failed';
  if (said.type === 'done') return;
  const problem = byId('problem');
  const { message, line } = said;
  problem.textContent = line === null ? message : `Line ${line}: ${message}`;
  problem.hidden = false;
  editor.mark(line);
}

/** Runs the code, and keeps what was changed in the address. */
async function start(): Promise<void> {
  main.dataset.state = 'running';
  byId('problem').hidden = true;
  byId('output').hidden = true;
  byId('output').replaceChildren();
  editor.mark(null);
  const code = editor.text;
  run(byId('frame'), code, example.files, heard);
  const packed = code === original ? null : await pack(new Blob([code]));
  history.replaceState(null, '', packed ? `#code=${packed}` : location.pathname + location.search);
  if (code !== original && !packed) status.textContent = 'So much code does not fit into a link.';
}

/** Has a button copy something. */
function copies(id: string, text: () => Promise<string> | string): void {
  byId(id).addEventListener('click', async () => {
    await navigator.clipboard.writeText(await text());
    status.textContent = 'Copied';
  });
}

/** What a link has changed, or null. */
async function changedByLink(): Promise<string | null> {
  const packed = /^#code=(.+)/.exec(location.hash)?.[1];
  const file = packed && (await unpack(packed, 'code.js'));
  return file ? file.text() : null;
}

/** Makes links of the names of files, whose addresses change with their contents. */
function linkFiles(): void {
  for (const name of document.querySelectorAll<HTMLElement>('[data-file]')) {
    const file = name.dataset.file!;
    name.replaceChildren(create('a', { href: addressOf(file), download: file, textContent: file }));
  }
}

async function wire(): Promise<void> {
  linkFiles();
  if (!runs) return copies('copy-npm', () => editor.text);
  copies('copy-npm', () => forNpm(editor.text, example.files));
  copies('copy-page', () => forPage(example.title, editor.text, example.files));
  copies('copy-link', async () => {
    await start();
    return location.href;
  });
  byId('run').addEventListener('click', () => void start());
  byId('reset').addEventListener('click', () => {
    editor.put(original);
    void start();
  });
  const changed = await changedByLink();
  if (changed !== null) editor.put(changed);
  await start();
}

void wire();
