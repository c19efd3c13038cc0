import { anglesChart } from '../charts/angles';
import { FILLS, type Meshing, withEdit } from '../model/edits';
import { exampleOf, SHAPE_EXAMPLES, type ShapeExample } from '../model/shapeExamples';
import { ANGLE_STEP, type Constrained, MOST_ADDED, PLAIN } from '../model/shapes';
import type { Page } from '../page';
import { whileBusy } from './busy';
import { byId, count, create, measured, things } from './dom';
import { removeRing } from './polygonHand';

/** The rules for what is inside, in the order of {@link FILLS}. */
const FILL_NAMES = [
  '',
  'Every second ring (even–odd)',
  'Where rings turn (nonzero)',
  'Enclosed by anything',
  'Everything',
];

/** Of more rings, only so many are listed. */
const MOST_LISTED = 8;

/** From which power of ten of the drawing's area the slider of areas goes, and through how many. */
const [LARGEST, POWERS] = [-0.6, 4];

/** The part of the panel with examples, and with how polygons are meshed. */
export function meshPanel(page: Page): { tell(shown: Constrained | null): void } {
  const empty = create('button', { type: 'button', id: 'draw' }, 'Empty');
  empty.title = 'Draw on an empty sheet';
  empty.addEventListener('click', () => {
    page.tool = 'draw';
    void page.run({ kind: 'generator', dimension: 2, distribution: 'uniform', count: 0, seed: 1 });
  });
  const examples = (Object.keys(SHAPE_EXAMPLES) as ShapeExample[]).map((name) => {
    const button = create(
      'button',
      { type: 'button', id: `example-${name}` },
      SHAPE_EXAMPLES[name],
    );
    button.addEventListener('click', () =>
      whileBusy(exampleOf(name).then((source) => page.run(source))),
    );
    return button;
  });
  const quick = create('div', { className: 'quick' }, ...examples, empty);
  quick.setAttribute('role', 'group');
  quick.setAttribute('aria-label', 'Polygons to begin with');
  const mesh = controls(page);
  const group = create(
    'div',
    { className: 'group only-2d', id: 'polygons' },
    create('h2', {}, 'Polygons'),
    create(
      'p',
      { className: 'note' },
      'With the tool Polygon, each click adds a corner, and a click on the first one closes the polygon. One inside another is a hole.',
    ),
    quick,
    mesh.element,
  );
  byId('clear').closest('.group')!.before(group);
  return mesh;
}

/** The controls, which are there when polygons are. */
function controls(page: Page) {
  const split = create('input', { type: 'checkbox', id: 'split' });
  const fill = create('select', { id: 'fill' });
  const angle = slider('min-angle', 'Smallest angle', { max: '34', step: '1' });
  const area = slider('max-area', 'Largest area', { max: String(POWERS), step: '0.05' });
  const crossing = create('p', { id: 'crossing', className: 'crossing', hidden: true });
  crossing.setAttribute('role', 'status');
  const result = figures(page);
  const rings = ringList(page);
  const element = create(
    'div',
    { className: 'group', id: 'meshing', hidden: true },
    crossing,
    angle.label,
    area.label,
    create(
      'div',
      { className: 'checks' },
      create('label', {}, split, 'Put points where lines cross'),
    ),
    result.element,
    create('label', {}, 'Inside ', fill),
    rings.element,
  );

  const change = (part: Partial<Meshing>) => {
    const edit = { do: 'mesh', ...meshingOf(page), ...part } as const;
    void page.edit(withEdit(page.settings.edits, edit));
  };
  split.addEventListener('change', () => change({ split: split.checked ? 1 : 0 }));
  fill.addEventListener('change', () => change({ fill: Number(fill.value) }));
  angle.input.addEventListener('input', () => change({ minAngle: angle.input.valueAsNumber }));
  area.input.addEventListener('input', () =>
    change({ maxArea: areaAt(page, area.input.valueAsNumber) }),
  );

  const tell = (shown: Constrained | null) => {
    element.hidden = !shown || page.live || page.summary?.given === undefined;
    if (element.hidden) return;
    const { split: isSplit, fill: chosen, minAngle, maxArea } = meshingOf(page);
    split.checked = isSplit === 1;
    const suits = `As they come: ${FILL_NAMES[FILLS.indexOf(shown!.suits)].toLowerCase()}`;
    const names = [suits, ...FILL_NAMES.slice(1)];
    if ([...fill.options].map(({ text }) => text).join() !== names.join())
      fill.replaceChildren(...names.map((name, i) => create('option', { value: String(i) }, name)));
    fill.value = String(chosen);
    angle.show(minAngle, minAngle === 0 ? 'any' : `${minAngle}°`);
    area.show(positionOf(page, maxArea), maxArea === 0 ? 'any' : measured(maxArea));
    crossing.hidden = shown!.crossing.length === 0;
    crossing.textContent = crossing.hidden ? '' : complaintOn(shown!.crossing);
    result.tell(shown!);
    rings.tell(shown!);
  };
  return { element, tell };
}

/** What is chosen, which the mesh that is shown may not follow yet. */
function meshingOf(page: Page): Meshing {
  const { do: _, ...meshing } = page.settings.edits.findLast((edit) => edit.do === 'mesh') ?? {
    do: 'mesh',
    ...PLAIN,
  };
  return meshing;
}

/** A slider from 0 on, with its label and what it says. */
function slider(id: string, name: string, range: { max: string; step: string }) {
  const input = create('input', { type: 'range', id, min: '0', ...range, value: '0' });
  const output = create('output');
  const label = create('label', { className: 'slide' }, `${name} `, input, output);
  return {
    input,
    label,
    show(value: number, words: string) {
      // Not under the hand that moves it.
      if (Math.abs(input.valueAsNumber - value) > Number(range.step) / 2)
        input.value = String(value);
      output.textContent = words;
      input.setAttribute('aria-valuetext', words);
    },
  };
}

/** The largest area at a position of the slider; 0 for any. */
function areaAt(page: Page, position: number): number {
  if (position === 0) return 0;
  const drawing = Math.PI / page.summary!.frame.scale ** 2;
  return Number((drawing * 10 ** (LARGEST - position)).toPrecision(3));
}

function positionOf(page: Page, area: number): number {
  const drawing = Math.PI / page.summary!.frame.scale ** 2;
  return area === 0 ? 0 : Math.min(POWERS, Math.max(0.05, LARGEST - Math.log10(area / drawing)));
}

function complaintOn(crossing: Constrained['crossing']): string {
  const pairs = crossing.map((pair) => pair.map((ends) => ends.join('–')).join(' and '));
  const [first] = pairs;
  const rest =
    pairs.length > 1 ? `, and ${things(pairs.length - 1, 'other pair', 'other pairs')}` : '';
  return `There is no mesh: lines ${first} cross${rest}. Move corners, or put points there.`;
}

/** What became of the polygons, in numbers and as a histogram. */
function figures(page: Page) {
  const table = create('tbody');
  const chart = create('div');
  const note = create('p', { className: 'note' });
  const figure = create(
    'figure',
    { className: 'chart' },
    chart,
    create('figcaption', {}, 'Angles of the triangles'),
  );
  const element = create(
    'div',
    { className: 'group' },
    create('table', { className: 'figures', id: 'mesh-figures' }, table),
    note,
    figure,
  );
  let charted = '';
  /** Draws the histogram, of many in a row the last. */
  const draw = async ({ angles, meshing }: Constrained) => {
    const what = JSON.stringify([angles.counts, meshing.minAngle]);
    if (what === charted || byId('points').hidden) return;
    charted = what;
    const drawn = await anglesChart(angles.counts, ANGLE_STEP, meshing.minAngle);
    if (what === charted) chart.replaceChildren(drawn);
  };

  const tell = (shown: Constrained) => {
    const { refinement, atCrossings, angles } = shown;
    const rows: [string, string | false][] = [
      ['Triangles', count(page.summary!.simplices)],
      ['Smallest angle', !Number.isNaN(angles.smallest) && `${angles.smallest.toFixed(1)}°`],
      ['Added at crossings', atCrossings > 0 && count(atCrossings)],
      ['Added on segments', refinement !== null && count(refinement.pointsOnSegments)],
      ['Added inside', refinement !== null && count(refinement.pointsInside)],
    ];
    table.replaceChildren(
      ...rows
        .filter(([, value]) => value !== false)
        .map(([name, value]) =>
          create('tr', {}, create('th', { scope: 'row' }, name), create('td', {}, value as string)),
        ),
    );
    note.textContent = notesOn(shown).join(' ');
    note.hidden = note.textContent === '';
    figure.hidden = Number.isNaN(angles.smallest);
    if (!figure.hidden) void draw(shown);
  };
  return { element, tell };
}

/** What is not as it was asked for. */
function notesOn({ refinement, leftOut }: Constrained): string[] {
  const notes: string[] = [];
  if (refinement?.limited)
    notes.push(`Refinement stopped at ${count(MOST_ADDED)} points: a page has only so much time.`);
  if (refinement && refinement.atInputAngles > 0)
    notes.push(
      `${things(refinement.atInputAngles, 'triangle has', 'triangles have')} smaller angles, where lines meet under small ones.`,
    );
  if (leftOut.length > 0) notes.push(`Left out of the file: ${leftOut.join(', ')}.`);
  return notes;
}

/** The rings, each with a button that removes it. */
function ringList(page: Page) {
  const element = create('ul', { className: 'rings', id: 'rings' });
  element.setAttribute('aria-label', 'Polygons');
  let listed = '';
  let latest: Constrained;
  const item = (ring: readonly number[], i: number) => {
    const button = create('button', { type: 'button', className: 'small' }, 'Remove');
    button.setAttribute('aria-label', `Remove ring ${i + 1}`);
    button.addEventListener('click', () => removeRing(page, latest, i));
    return create('li', {}, `Ring ${i + 1}: ${count(ring.length)} corners`, button);
  };
  const tell = (shown: Constrained) => {
    latest = shown;
    const sizes = shown.rings.map(({ length }) => length);
    const hasFocus = element.contains(document.activeElement);
    element.hidden = sizes.length === 0;
    // A button that has the focus stays.
    if (sizes.join() === listed) return;
    listed = sizes.join();
    const more = sizes.length - MOST_LISTED;
    element.replaceChildren(
      ...shown.rings.slice(0, MOST_LISTED).map(item),
      ...(more > 0 ? [create('li', {}, `and ${count(more)} more`)] : []),
    );
    if (hasFocus) (element.querySelector('button') ?? byId('canvas')).focus();
  };
  return { element, tell };
}
