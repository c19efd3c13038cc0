import { withEdit } from '../model/edits';
import type { Weights } from '../model/weighted';
import type { Page, Part } from '../page';
import type { Settings, Weighing } from '../settings';
import '../styles/weights.css';
import { byId, count, create, measured, things } from './dom';

/** How near to a point or to its circle the pointer has to be, in pixels. */
const REACH = { mouse: 10, touch: 24 };

/** How much a key or a notch of the wheel changes a radius, as a share of what is seen. */
const NUDGE = 0.01;

/** Of more points no circles are drawn, and of more hidden ones no marks. */
const [MOST_CIRCLES, MOST_MARKS] = [3000, 5000];

/** The choice of weights, the tool that changes those of points in 2D, and what shows them. */
export function weighing(page: Page): Part {
  const stage = byId('stage');
  const canvas = byId<HTMLCanvasElement>('canvas');
  const overlay = create('canvas', { id: 'weights-overlay' });
  overlay.setAttribute('aria-hidden', 'true');
  canvas.after(overlay);

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

  const tool = create('input', { type: 'radio', name: 'tool', value: 'weigh' });
  const label = create('label', {}, tool, create('span', {}, 'Weigh'));
  label.title = 'Drag a point: the further, the heavier';
  document.querySelector('.tools [role=radiogroup]')!.append(label);
  document
    .querySelector('#keys .only-2d')!
    .append(' Square brackets make the point nearest to the cross lighter and heavier.');
  tool.addEventListener('change', () => {
    page.tool = 'weigh';
    page.change({});
  });

  let shown: Weights = { radii: null, hidden: new Uint32Array(), columns: [] };
  /** Counts what was asked: an earlier answer is of no interest. */
  let asked = 0;
  let held: number | null = null;

  const isFlat = () => page.settings.source.dimension === 2 && !page.live && page.summary !== null;
  const unit = () => page.summary!.frame.scale;
  const placeOf = (i: number) => {
    const { positions, viewer } = page;
    return viewer!.onCanvas(positions![3 * i], positions![3 * i + 1], positions![3 * i + 2]);
  };
  /** Pixels per unit of the input, in 2D. */
  const pixels = () => {
    const { viewer } = page;
    const [x] = viewer!.onCanvas(0, 0);
    return (viewer!.onCanvas(1, 0)[0] - x) * unit();
  };
  const radiusOf = (i: number) => shown.radii?.[i] ?? 0;

  /** Asks the model what is to be shown. */
  const refresh = async () => {
    const own = ++asked;
    const answer = await page.model.weights();
    if (own !== asked) return;
    shown = answer;
    tell(page.settings);
    draw();
  };

  const tell = (settings: Settings) => {
    const { weights } = settings;
    const options = ['', 'random', ...shown.columns];
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
    scale.disabled = !weights;
    if (weights) scale.value = String(weights.scale);
    const { hidden, radii } = shown;
    const points = page.summary?.points ?? 0;
    tally.hidden = hidden.length === 0 || page.live;
    tally.textContent = `· ${count(hidden.length)} hidden`;
    note.textContent = radii
      ? `A power diagram: distances are counted from balls. ${
          hidden.length > 0
            ? `${things(hidden.length, 'point is', 'points are')} hidden by heavier ones, of ${count(points)}.`
            : 'No point is hidden.'
        }`
      : 'With radii, distances are counted from balls: the diagram is a power diagram, and heavy points may hide others.';
    tool.checked = page.tool === 'weigh';
  };

  const draw = () => {
    const { width, height } = canvas.getBoundingClientRect();
    const ratio = devicePixelRatio;
    overlay.width = Math.round(width * ratio);
    overlay.height = Math.round(height * ratio);
    const { viewer, positions } = page;
    const { radii, hidden } = shown;
    if (!viewer || !positions || page.live || (!radii && page.tool !== 'weigh')) return;
    const points = positions.length / 3;
    const context = overlay.getContext('2d')!;
    context.scale(ratio, ratio);
    const style = getComputedStyle(document.documentElement);
    if (isFlat() && points <= MOST_CIRCLES) {
      context.strokeStyle = style.getPropertyValue('--ink');
      context.globalAlpha = 0.45;
      const size = pixels();
      for (let i = 0; i < points; i++) {
        const radius = radiusOf(i) * size;
        if (radius < 1) continue;
        const [x, y] = placeOf(i);
        context.beginPath();
        context.arc(x, y, radius, 0, 2 * Math.PI);
        context.stroke();
      }
    }
    context.globalAlpha = 1;
    context.strokeStyle = style.getPropertyValue('--bad');
    context.lineWidth = 1.8;
    if (hidden.length > MOST_MARKS) return;
    context.beginPath();
    for (const i of hidden) {
      if (i >= points) continue;
      const [x, y] = placeOf(i);
      context.moveTo(x - 4, y - 4);
      context.lineTo(x + 4, y + 4);
      context.moveTo(x + 4, y - 4);
      context.lineTo(x - 4, y + 4);
    }
    context.stroke();
  };

  // Of choices that come faster than points can be triangulated, the last counts.
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
  by.addEventListener('change', () =>
    choose(by.value ? { by: by.value, scale: page.settings.weights?.scale ?? 1 } : null),
  );
  scale.addEventListener('input', () => {
    const { weights } = page.settings;
    const chosen = wanted?.weights ?? weights;
    if (chosen) void choose({ by: chosen.by, scale: scale.valueAsNumber });
  });

  /** Gives a point a radius in units of the input. */
  const weigh = (point: number, radius: number) => {
    // A fraction of a pixel, so that links stay short.
    const digits = Math.min(15, Math.max(0, Math.ceil(Math.log10(pixels())) + 1));
    const rounded = Number(Math.max(0, radius).toFixed(digits));
    byId('edited').textContent = `Radius ${measured(rounded)}`;
    void page.edit(withEdit(page.settings.edits, { do: 'weigh', point, radius: rounded }));
  };
  /** The point whose middle or whose circle is nearest to a place, within some pixels. */
  const near = (x: number, y: number, reach: number): number | null => {
    const { positions, viewer } = page;
    if (!viewer || !positions) return null;
    const size = pixels();
    let [best, least]: [number | null, number] = [null, reach];
    for (let i = 0; 3 * i < positions.length; i++) {
      const [px, py] = placeOf(i);
      const distance = Math.hypot(px - x, py - y);
      const off = Math.min(distance, Math.abs(distance - radiusOf(i) * size));
      if (off <= least) [best, least] = [i, off];
    }
    return best;
  };
  const weighs = () => isFlat() && page.tool === 'weigh';
  /** The radius with which the circle of the point that is held goes through a place. */
  const radiusAt = ({ offsetX, offsetY }: PointerEvent) => {
    const [x, y] = placeOf(held!);
    return Math.hypot(offsetX - x, offsetY - y) / pixels();
  };

  // Before the canvas hears of it, where a drag moves points and the view.
  const capture = { capture: true };
  stage.addEventListener(
    'pointerdown',
    (event) => {
      if (event.target !== canvas || !weighs() || event.button !== 0 || !event.isPrimary) return;
      const reach = event.pointerType === 'mouse' ? REACH.mouse : REACH.touch;
      held = near(event.offsetX, event.offsetY, reach);
      if (held === null) return;
      event.stopPropagation();
      canvas.focus({ preventScroll: true });
      canvas.setPointerCapture(event.pointerId);
    },
    capture,
  );
  stage.addEventListener(
    'pointermove',
    (event) => {
      if (held === null) return;
      event.stopPropagation();
      weigh(held, radiusAt(event));
    },
    capture,
  );
  for (const end of ['pointerup', 'pointercancel'] as const)
    stage.addEventListener(end, () => (held = null), capture);
  stage.addEventListener(
    'wheel',
    (event) => {
      if (event.target !== canvas || !weighs()) return;
      const point = near(event.offsetX, event.offsetY, REACH.mouse);
      if (point === null) return;
      event.preventDefault();
      event.stopPropagation();
      weigh(point, radiusOf(point) - Math.sign(event.deltaY) * step());
    },
    { capture: true, passive: false },
  );
  const step = () => (NUDGE * page.viewer!.seen[0]) / unit();
  stage.addEventListener(
    'keydown',
    (event) => {
      const by = { '[': -1, ']': 1 }[event.key];
      if (!by || !isFlat() || !page.viewer || event.ctrlKey || event.metaKey || event.altKey)
        return;
      const reach = canvas.clientWidth + canvas.clientHeight;
      const [x, y] = [canvas.clientWidth / 2, canvas.clientHeight / 2];
      const point = nearestMiddle(x, y, reach);
      if (point === null) return;
      event.preventDefault();
      event.stopPropagation();
      weigh(point, radiusOf(point) + by * step());
    },
    capture,
  );
  /** The point whose middle is nearest to a place: one that grows stays it. */
  const nearestMiddle = (x: number, y: number, reach: number): number | null => {
    let [best, least]: [number | null, number] = [null, reach];
    for (let i = 0; 3 * i < page.positions!.length; i++) {
      const [px, py] = placeOf(i);
      const distance = Math.hypot(px - x, py - y);
      if (distance < least) [best, least] = [i, distance];
    }
    return best;
  };

  const again = () => void refresh();
  if (page.summary) again();
  tell(page.settings);
  return {
    changed(settings) {
      tell(settings);
      draw();
    },
    ran: again,
    edited: again,
    lived(on) {
      tell(page.settings);
      if (on) draw();
      else again();
    },
    moved: draw,
  };
}
