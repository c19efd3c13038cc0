import '@fontsource-variable/geist/wght.css';
import '@fontsource-variable/geist-mono/wght.css';
import '../styles/base.css';
import '../styles/panel.css';
import '../styles/report.css';
import '../styles/treemap.css';
import { type Treemap, treemap } from 'gdel-wasm/treemap';
import { pack, unpack } from '../model/packed';
import { TableError } from '../model/rows';
import { byId, count, create, duration, radios, saveFile, things } from '../ui/dom';
import { wireTheme } from '../ui/theme';
import { palette } from './colors';
import { EXAMPLES } from './examples';
import { number, pathOf, percent, type Scene, sceneOf, svgOf, titleOf } from './picture';
import { outlineOf, type ShapeName } from './shapes';
import { hashOf, type State, stateFrom } from './state';
import { type Item, nested, type Roles, readTable, rolesOf, rowsOf } from './table';

/** How long the way from equal areas to exact ones takes, in milliseconds. */
const WAY = 1100;

/** So many of the rows without a cell are named. */
const NAMED = 8;

const stage = byId('stage');
const picture = byId('picture');
const way = byId<HTMLInputElement>('way');
const text = byId<HTMLTextAreaElement>('text');

/** What is shown. */
interface Shown {
  map: Treemap<Item>;
  scene: Scene;
  sum: number;
  title: string;
  unit: string;
}

let state: State = stateFrom(location.hash);
/** The visitor's table; null before there is one. */
let own: { name: string; text: string } | null = null;
let shown: Shown | null = null;
/** Ends what is still under way for something else. */
let running = new AbortController();
/** Ends what moves. */
let moving = new AbortController();

const calm = () => matchMedia('(prefers-reduced-motion: reduce)').matches;
const colors = () => palette(document.documentElement.dataset.theme === 'dark' ? 'dark' : 'light');

/** The table to draw. */
function tableNow(): { title: string; unit: string; csv: string } {
  if (state.example === null && own)
    return { title: own.name.replace(/\.\w+$/, ''), unit: '', csv: own.text };
  return EXAMPLES[state.example ?? Object.keys(EXAMPLES)[0]];
}

/** Ends what is under way, for something new: the page is busy from now on. */
function begin(): AbortSignal {
  running.abort();
  moving.abort();
  running = new AbortController();
  stage.setAttribute('aria-busy', 'true');
  say(null);
  return running.signal;
}

/** Draws what the state says, from the table on. */
async function update(): Promise<void> {
  const signal = begin();
  try {
    const { title, unit, csv } = tableNow();
    text.value = csv;
    const table = readTable(csv);
    const roles = { ...rolesOf(table), ...withinColumns(state.roles, table.columns.length) };
    offerColumns(table.columns, roles);
    const rows = rowsOf(table, roles);
    const isTall = matchMedia('(max-width: 760px) and (orientation: portrait)').matches;
    const outline = outlineOf(state.shape, isTall);
    const started = performance.now();
    const map = await treemap(nested(rows), { shape: outline.corners, signal, onProgress });
    const took = performance.now() - started;
    const scene = sceneOf(map.cells, outline);
    const sum = rows.reduce((sum, { value }) => sum + value, 0);
    shown = { map, scene, sum, title, unit };
    stage.dataset.milliseconds = took.toFixed(1);
    stage.dataset.error = String(map.error);
    byId('result').textContent =
      `${things(scene.leaves.length, 'cell', 'cells')} in ${duration(took)}: no area is off by more than ${percent(map.error)}.`;
    const without = rows.filter(({ value }) => value === 0).map(({ name }) => name);
    const more = without.length > NAMED ? ` and ${count(without.length - NAMED)} more` : '';
    note(
      without.length > 0
        ? `No cell for ${things(without.length, 'row', 'rows')} with the number 0: ${without.slice(0, NAMED).join(', ')}${more}.`
        : null,
    );
    fillFigures();
    await play(signal);
  } catch (error) {
    if (signal.aborted) return;
    shown = null;
    picture.replaceChildren();
    byId('result').textContent = '';
    note(null);
    fillFigures();
    say(error instanceof TableError ? error.message : `It failed: ${(error as Error).message}`);
  } finally {
    if (!signal.aborted) {
      byId('progress').hidden = true;
      stage.setAttribute('aria-busy', 'false');
      for (const id of ['save-svg', 'save-csv', 'play', 'way'])
        byId<HTMLButtonElement>(id).disabled = !shown;
    }
  }
}

/** Those of the columns that were chosen which the table has. */
const withinColumns = (roles: Partial<Roles>, columns: number): Partial<Roles> =>
  Object.fromEntries(
    Object.entries(roles).filter(([role, at]) => at < columns && at >= (role === 'value' ? 0 : -1)),
  );

function onProgress({ fraction }: { fraction: number }): void {
  const progress = byId<HTMLProgressElement>('progress');
  progress.hidden = false;
  progress.value = fraction;
}

function say(message: string | null): void {
  byId('message').hidden = message === null;
  byId('message').textContent = message;
}

function note(message: string | null): void {
  byId('notes').hidden = message === null;
  byId('notes').textContent = message;
}

/** Draws the final picture. */
function draw(): void {
  if (!shown) return;
  const { scene } = shown;
  picture.innerHTML = svgOf(scene, colors(), describe(shown), false);
}

const describe = ({ scene, title, unit, sum }: Shown) => {
  const largest = [...scene.leaves].sort((one, other) => other.cell.value - one.cell.value);
  const first = largest.slice(0, 3).map((leaf) => titleOf(leaf, sum));
  const of = unit ? ` ${unit}` : '';
  return {
    title,
    text: `Treemap of ${things(scene.leaves.length, 'cell', 'cells')} whose areas are proportional to numbers, ${number(sum)}${of} in all. The largest: ${first.join('; ')}.`,
  };
};

/** Shows the cells at the top on their way from equal areas to exact ones. */
async function show(share: number, signal: AbortSignal): Promise<void> {
  if (!shown) return;
  if (share === 1) {
    draw();
    return;
  }
  const { map, scene } = shown;
  const cells = await map.between(share, { signal });
  if (signal.aborted) return;
  let paths = [...picture.querySelectorAll<SVGPathElement>('path[data-top]')];
  if (paths.length !== cells.length) {
    const { width, height } = scene.outline;
    const { line, cell } = colors();
    const thin = Math.min(2, 40 / Math.sqrt(cells.length));
    picture.innerHTML = `<svg viewBox="-4 -4 ${width + 8} ${height + 8}" role="img" aria-label="Areas between equal and exact ones"><g stroke="${line}" stroke-width="${thin}" stroke-linejoin="round">${cells.map((_, i) => `<path data-top="${i}" fill="${cell(i, 0)}"/>`).join('')}</g></svg>`;
    paths = [...picture.querySelectorAll<SVGPathElement>('path[data-top]')];
  }
  cells.forEach((cell, i) => {
    paths[i].setAttribute('d', cell ? pathOf(cell) : '');
  });
}

/** Moves from equal areas to exact ones, unless the visitor wants nothing to move. */
async function play(outer: AbortSignal): Promise<void> {
  moving.abort();
  moving = new AbortController();
  const signal = AbortSignal.any([moving.signal, outer]);
  try {
    if (!calm() && shown && shown.map.cells.length > 1) {
      await show(0, signal);
      const started = performance.now();
      for (let at = 0; at < 1 && !signal.aborted; at = (performance.now() - started) / WAY) {
        const share = at * at * (3 - 2 * at);
        way.value = String(share);
        await show(share, signal);
        await new Promise(requestAnimationFrame);
      }
    }
  } catch (error) {
    if (!signal.aborted) throw error;
  }
  if (signal.aborted) return;
  way.value = '1';
  draw();
}

/** The table of all cells, which is made when it is looked at. */
function fillFigures(): void {
  const rows = byId('rows');
  if (!byId<HTMLDetailsElement>('figures').open || !shown) {
    rows.replaceChildren();
    return;
  }
  const { scene, sum } = shown;
  rows.replaceChildren(
    ...scene.leaves.map(({ cell, path }) =>
      create(
        'tr',
        {},
        create('th', { scope: 'row' }, [...path, cell.item.name].join(' › ')),
        create('td', {}, number(cell.value)),
        create('td', {}, percent(cell.value / sum)),
        create('td', {}, percent(errorOf(cell, sum))),
      ),
    ),
  );
}

/** The share by which a cell's area is off. */
const errorOf = ({ area, value }: { area: number; value: number }, sum: number) =>
  Math.abs((area / 1e6) * (sum / value) - 1);

function offerColumns(columns: readonly string[], roles: Roles): void {
  for (const role of ['value', 'name', 'group'] as const) {
    const select = byId<HTMLSelectElement>(`column-${role}`);
    const none = role === 'value' ? [] : [create('option', { value: '-1' }, 'None')];
    select.replaceChildren(
      ...none,
      ...columns.map((name, i) => create('option', { value: String(i) }, name)),
    );
    select.value = String(roles[role]);
  }
}

/** Shows the choices that the state holds, and puts them into the address. */
function tell(): void {
  const source = byId<HTMLSelectElement>('source');
  source.replaceChildren(
    ...Object.entries(EXAMPLES).map(([value, { title }]) => create('option', { value }, title)),
    ...(own ? [create('option', { value: '' }, own.name)] : []),
  );
  source.value = state.example ?? '';
  for (const radio of shapes) radio.checked = radio.value === state.shape;
  history.replaceState(null, '', `#${hashOf(state)}`);
}

function change(more: Partial<State>): void {
  state = { ...state, ...more };
  tell();
  void update();
}

/** Takes a table of the visitor's. */
async function take(file: File): Promise<void> {
  const signal = begin();
  try {
    const [content, data] = await Promise.all([file.text(), pack(file)]);
    if (signal.aborted) return;
    own = { name: file.name, text: content };
    change({ example: null, roles: {}, file: file.name, data });
  } catch (error) {
    if (signal.aborted) return;
    say(`“${file.name}” cannot be read: ${(error as Error).message}`);
    stage.setAttribute('aria-busy', 'false');
  }
}

function save(extension: string, type: string, content: string): void {
  const stem = (shown?.title ?? 'treemap').replace(/[^\p{L}\p{N}]+/gu, '-').toLowerCase();
  saveFile(`${stem}.${extension}`, new Blob([content], { type }));
}

/** A cell of a CSV file, which spreadsheets must not take for a formula. */
const quoted = (cell: string) => {
  const safe = /^[=+\-@\t\r]/.test(cell) ? `'${cell}` : cell;
  return /[",\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
};

function csvOf({ scene, sum }: Shown): string {
  const lines = scene.leaves.map(({ cell, path }) =>
    [
      quoted(path.join('/')),
      quoted(cell.item.name),
      cell.value,
      cell.value / sum,
      cell.area / 1e6,
      ...cell.site.map((x) => x.toPrecision(9)),
    ].join(','),
  );
  return `${['group,name,number,share,share of the area,site x,site y', ...lines].join('\n')}\n`;
}

const shapes = radios('shape', (shape) => change({ shape: shape as ShapeName }));
byId<HTMLSelectElement>('source').addEventListener('change', (event) => {
  const { value } = event.currentTarget as HTMLSelectElement;
  if (value) change({ example: value, roles: {}, file: null, data: null });
  else void take(new File([own!.text], own!.name));
});
for (const role of ['name', 'value', 'group'] as const)
  byId<HTMLSelectElement>(`column-${role}`).addEventListener('change', (event) =>
    change({
      roles: { ...state.roles, [role]: Number((event.currentTarget as HTMLSelectElement).value) },
    }),
  );
const file = byId<HTMLInputElement>('file');
byId('open').addEventListener('click', () => file.click());
file.addEventListener('change', () => {
  if (file.files?.[0]) void take(file.files[0]);
  file.value = '';
});
byId('draw').addEventListener('click', () =>
  take(new File([text.value], own?.name ?? 'table.csv')),
);
byId('play').addEventListener('click', () => void play(running.signal));
way.addEventListener('input', async () => {
  moving.abort();
  moving = new AbortController();
  const { signal } = moving;
  try {
    await show(way.valueAsNumber, AbortSignal.any([signal, running.signal]));
  } catch (error) {
    if (!signal.aborted && !running.signal.aborted) say((error as Error).message);
  }
});
byId('save-svg').addEventListener('click', () => {
  if (shown) save('svg', 'image/svg+xml', svgOf(shown.scene, colors(), describe(shown), true));
});
byId('save-csv').addEventListener('click', () => {
  if (shown) save('csv', 'text/csv', csvOf(shown));
});
byId('figures').addEventListener('toggle', fillFigures);
byId('share').addEventListener('click', async () => {
  const button = byId('share');
  try {
    await navigator.clipboard.writeText(location.href);
    button.textContent =
      state.example === null && !state.data ? 'Copied, without the table' : 'Link copied';
  } catch {
    button.textContent = 'Link is in the address bar';
  }
  setTimeout(() => (button.textContent = 'Copy link'), 2500);
});

const tip = byId('tip');
picture.addEventListener('pointermove', (event) => {
  const at = (event.target as Element).getAttribute('data-cell');
  tip.hidden = at === null || !shown;
  if (tip.hidden) return;
  tip.textContent = titleOf(shown!.scene.leaves[Number(at)], shown!.sum);
  const { left, top, width } = stage.getBoundingClientRect();
  const x = event.clientX - left;
  tip.style.left = `${Math.min(x, width - tip.offsetWidth - 8)}px`;
  tip.style.top = `${event.clientY - top + 16}px`;
});
picture.addEventListener('pointerleave', () => (tip.hidden = true));

const holdsFiles = (event: DragEvent) => event.dataTransfer?.types.includes('Files') ?? false;
window.addEventListener('dragover', (event) => {
  if (!holdsFiles(event)) return;
  event.preventDefault();
  byId('drop').hidden = false;
});
window.addEventListener('dragleave', (event) => {
  if (event.relatedTarget === null) byId('drop').hidden = true;
});
window.addEventListener('drop', (event) => {
  byId('drop').hidden = true;
  if (!holdsFiles(event)) return;
  event.preventDefault();
  const [dropped] = event.dataTransfer!.files;
  if (dropped) void take(dropped);
});

/** Shows what the address says. */
async function start(): Promise<void> {
  const signal = begin();
  state = stateFrom(location.hash);
  if (state.data) {
    const unpacked = await unpack(state.data, state.file!);
    if (signal.aborted) return;
    if (unpacked) own = { name: unpacked.name, text: await unpacked.text() };
    else state = stateFrom('');
  }
  tell();
  await update();
}

window.addEventListener('hashchange', () => void start());
wireTheme(() => {
  if (stage.getAttribute('aria-busy') === 'false') draw();
});
void start();
