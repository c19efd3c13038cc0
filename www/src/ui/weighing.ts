import { withEdit } from '../model/edits';
import type { Weights } from '../model/weighted';
import type { Page, Part } from '../page';
import type { Weighing } from '../settings';
import '../styles/overlay.css';
import { byId, count, create, measured, things } from './dom';
import { onCanvas, overlay, themeColor } from './overlay';
import { isFlat, middleOf, nearest, reachOf } from './picking';
import { toolButton } from './toolButton';

/** How much a key or a notch of the wheel changes a radius, as a share of what is seen. */
const NUDGE = 0.01;

/** Of more points no circles are drawn, and of more hidden ones no marks. */
const [MOST_CIRCLES, MOST_MARKS] = [3000, 5000];

/** The choice of weights, the tool that changes those of points in 2D, and what shows them. */
export function weighing(page: Page): Part {
  const begin = overlay('weights-overlay');
  let shown: Weights = { radii: null, hidden: new Uint32Array(), columns: [] };
  /** Counts what was asked: an earlier answer is of no interest. */
  let asked = 0;
  const tellChoice = choice(page);
  const tool = toolButton(page, 'weigh', 'Weigh', 'Drag a point: the further, the heavier');
  hand(page, () => shown);

  const tell = () => {
    tellChoice(shown);
    // Polygons have no weights.
    const isPossible = page.summary?.given === undefined;
    if (!isPossible && page.tool === 'weigh') page.tool = 'move';
    tool(isPossible);
  };
  const draw = () => drawWeights(page, shown, begin());
  /** Asks the model what is to be shown. */
  const refresh = async () => {
    const own = ++asked;
    const answer = await page.model.weights();
    if (own !== asked) return;
    shown = answer;
    tell();
    draw();
  };

  const again = () => void refresh();
  if (page.summary) again();
  tell();
  return {
    changed() {
      tell();
      draw();
    },
    ran: again,
    edited: again,
    lived(on) {
      tell();
      if (on) draw();
      else again();
    },
    moved: draw,
  };
}

/** The controls in the panel, and the tally under the drawing. Returns what has them tell what is shown. */
function choice(page: Page): (shown: Weights) => void {
  const by = create('select', { id: 'weights-by' });
  const scale = create('input', {
    id: 'weights-scale',
    type: 'range',
    min: '0',
    max: '2',
    step: '0.02',
  });
  const note = create('p', { id: 'weights-note', className: 'note' });
  byId('view').append(
    create('h2', {}, 'Weights'),
    create('label', {}, 'Radii ', by),
    create('label', {}, 'Scale ', scale),
    note,
  );
  const tally = create('p', { id: 'hidden-points', className: 'tally', hidden: true });
  tally.setAttribute('role', 'status');
  byId('count').after(' ', tally);
  const { choose, last } = chooser(page);
  by.addEventListener('change', () =>
    choose(by.value ? { by: by.value, scale: page.settings.weights?.scale ?? 1 } : null),
  );
  scale.addEventListener('input', () => {
    const chosen = last() ?? page.settings.weights;
    if (chosen) void choose({ by: chosen.by, scale: scale.valueAsNumber });
  });

  return ({ hidden, radii, columns }) => {
    const { weights } = page.settings;
    offer(by, columns, weights);
    by.disabled = page.summary?.given !== undefined;
    scale.disabled = !weights || by.disabled;
    if (weights) scale.value = String(weights.scale);
    tally.hidden = hidden.length === 0 || page.live;
    tally.textContent = `· ${count(hidden.length)} hidden`;
    note.textContent = by.disabled
      ? 'Points of polygons have no weights.'
      : noteOn(radii !== null, hidden.length, page.summary?.points ?? 0);
  };
}

/** Offers what radii can be taken from. */
function offer(by: HTMLSelectElement, columns: readonly string[], weights: Weighing | null): void {
  const options = ['', 'random', ...columns];
  if (weights && !options.includes(weights.by)) options.push(weights.by);
  if ([...by.options].map(({ value }) => value).join('\n') !== options.join('\n'))
    by.replaceChildren(
      ...options.map((value) =>
        create(
          'option',
          { value },
          { '': 'All the same', random: 'At random' }[value] ?? `Column “${value}”`,
        ),
      ),
    );
  by.value = weights?.by ?? '';
}

function noteOn(hasRadii: boolean, hidden: number, points: number): string {
  if (!hasRadii)
    return 'With radii, distances are counted from balls: the diagram is a power diagram, and heavy points may hide others.';
  const rest =
    hidden > 0
      ? `${things(hidden, 'point is', 'points are')} hidden by heavier ones, of ${count(points)}.`
      : 'No point is hidden.';
  return `A power diagram: distances are counted from balls. ${rest}`;
}

/** Runs the points with chosen weights. Of choices that come faster than points can be triangulated, the last counts. */
function chooser(page: Page) {
  let wanted: { weights: Weighing | null } | null = null;
  let isRunning = false;
  const choose = async (weights: Weighing | null) => {
    wanted = { weights };
    if (isRunning) return;
    isRunning = true;
    for (let next = wanted; next; next = wanted!) {
      wanted = null;
      const { source, edits, filter } = page.settings;
      await page.run(source, {
        ...next,
        edits,
        // Weighted points have no surface.
        filter: next.weights && filter === 'surface' ? 'all' : filter,
      });
    }
    isRunning = false;
  };
  return { choose, last: () => wanted?.weights ?? null };
}

/** Pixels per unit of the input, in 2D. */
function pixelsOf({ viewer, summary }: Page): number {
  return (viewer!.onCanvas(1, 0)[0] - viewer!.onCanvas(0, 0)[0]) * summary!.frame.scale;
}

/** Draws the radii of points as circles, in 2D, and marks those that are hidden. */
function drawWeights(
  page: Page,
  { radii, hidden }: Weights,
  context: CanvasRenderingContext2D,
): void {
  const { viewer, positions } = page;
  if (!viewer || !positions || page.live || (!radii && page.tool !== 'weigh')) return;
  const points = positions.length / 3;
  if (isFlat(page) && points <= MOST_CIRCLES) {
    context.strokeStyle = themeColor('ink');
    context.globalAlpha = 0.45;
    const size = pixelsOf(page);
    for (let i = 0; i < points; i++) {
      const radius = (radii?.[i] ?? 0) * size;
      if (radius < 1) continue;
      context.beginPath();
      context.arc(...onCanvas(page, i), radius, 0, 2 * Math.PI);
      context.stroke();
    }
  }
  if (hidden.length > MOST_MARKS) return;
  context.globalAlpha = 1;
  context.strokeStyle = themeColor('bad');
  context.lineWidth = 1.8;
  context.beginPath();
  for (const i of hidden) {
    if (i >= points) continue;
    const [x, y] = onCanvas(page, i);
    context.moveTo(x - 4, y - 4);
    context.lineTo(x + 4, y + 4);
    context.moveTo(x + 4, y - 4);
    context.lineTo(x - 4, y + 4);
  }
  context.stroke();
}

/** Changes weights by a drag, by the wheel and by keys. */
function hand(page: Page, shown: () => Weights): void {
  const stage = byId('stage');
  const canvas = byId<HTMLCanvasElement>('canvas');
  let held: number | null = null;
  const radiusOf = (i: number) => shown().radii?.[i] ?? 0;
  const step = () => (NUDGE * page.viewer!.seen[0]) / page.summary!.frame.scale;
  const isPossible = () => isFlat(page) && page.summary!.given === undefined;
  const isOn = () => isPossible() && page.tool === 'weigh' && page.viewer !== null;
  /** The point whose middle or whose circle is nearest. */
  const near = (event: PointerEvent | WheelEvent) => {
    const size = pixelsOf(page);
    const reach = reachOf(event instanceof PointerEvent ? event : { pointerType: 'mouse' });
    const off = (distance: number, i: number) =>
      Math.min(distance, Math.abs(distance - radiusOf(i) * size));
    return nearest(page, event.offsetX, event.offsetY, reach, off);
  };
  /** Gives a point a radius in units of the input. */
  const weigh = (point: number, radius: number) => {
    // A fraction of a pixel, so that links stay short.
    const digits = Math.min(15, Math.max(0, Math.ceil(Math.log10(pixelsOf(page))) + 1));
    const rounded = Number(Math.max(0, radius).toFixed(digits));
    byId('edited').textContent = `Radius ${measured(rounded)}`;
    void page.edit(withEdit(page.settings.edits, { do: 'weigh', point, radius: rounded }));
  };

  // Before the canvas hears of it, where a drag moves points and the view.
  const listen = <K extends keyof HTMLElementEventMap>(
    type: K,
    heard: (event: HTMLElementEventMap[K]) => void,
  ) => stage.addEventListener(type, heard, { capture: true, passive: false });
  listen('pointerdown', (event) => {
    if (event.target !== canvas || !isOn() || event.button !== 0 || !event.isPrimary) return;
    held = near(event);
    if (held === null) return;
    event.stopPropagation();
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
  });
  listen('pointermove', (event) => {
    if (held === null) return;
    event.stopPropagation();
    const [x, y] = onCanvas(page, held);
    // Its circle goes through the pointer.
    weigh(held, Math.hypot(event.offsetX - x, event.offsetY - y) / pixelsOf(page));
  });
  for (const end of ['pointerup', 'pointercancel'] as const) listen(end, () => (held = null));
  listen('wheel', (event) => {
    const point = event.target === canvas && isOn() ? near(event) : null;
    if (point === null) return;
    event.preventDefault();
    event.stopPropagation();
    weigh(point, radiusOf(point) - Math.sign(event.deltaY) * step());
  });
  byId('keys-2d').append(
    ' Square brackets make the point nearest to the cross lighter and heavier.',
  );
  listen('keydown', (event) => {
    const by = { '[': -1, ']': 1 }[event.key];
    const isPlain = !event.ctrlKey && !event.metaKey && !event.altKey;
    if (!by || !isPlain || !isPossible()) return;
    const point = nearest(page, ...middleOf(canvas), Infinity);
    if (point === null) return;
    event.preventDefault();
    event.stopPropagation();
    weigh(point, radiusOf(point) + by * step());
  });
}
