import { type Edit, withEdit } from '../model/edits';
import type { Page, Part } from '../page';
import type { Tool } from '../settings';
import { byId, radios } from './dom';
import { middleOf, nearest, placeAt, reachOf } from './picking';

/** A pointer that moved less than this has clicked. */
export const CLICK = 5;

/** How far a point that is held moves with an arrow key, as a share of what is seen. */
const NUDGE = 0.01;

/**
 * Edits 2D points by hand: with the mouse, by touch, and with the keys, for a crosshair in the
 * middle of the drawing.
 */
export function editor(page: Page): Part {
  const canvas = byId<HTMLCanvasElement>('canvas');
  const ring = byId('ring');
  const undo = byId<HTMLButtonElement>('undo');
  const redo = byId<HTMLButtonElement>('redo');
  const said = byId('edited');
  /** The point that is dragged, or held by the keys. */
  let held: number | null = null;
  /** What was taken back, the last first, until there is another change. */
  let undone: Edit[] = [];
  /** The changes as they were last seen here. */
  let latest = page.settings.edits;
  let pressed: { x: number; y: number; moved: boolean } | null = null;

  const flat = () => page.settings.source.dimension === 2 && !page.live && page.summary !== null;
  const points = () => (page.positions?.length ?? 0) / 3;

  const change = (edit: Edit, words: string) => {
    said.textContent = words;
    undone = [];
    return page.edit(withEdit(page.settings.edits, edit));
  };
  const add = (x: number, y: number) =>
    change({ do: 'add', at: placeAt(page, x, y) }, 'Point added');
  const remove = (point: number) => change({ do: 'remove', point }, 'Point removed');
  const move = (point: number, x: number, y: number) =>
    change({ do: 'move', point, at: placeAt(page, x, y) }, '');

  const mark = (point: number | null) => {
    ring.hidden = point === null || !page.viewer || point >= points();
    if (ring.hidden) return;
    const [x, y] = page.viewer!.onCanvas(
      page.positions![3 * point!],
      page.positions![3 * point! + 1],
    );
    ring.style.translate = `${x}px ${y}px`;
  };

  // Before the controls of the camera hear of it, which would move the view instead.
  canvas.addEventListener(
    'pointerdown',
    (event) => {
      if (!flat() || event.button !== 0 || !event.isPrimary) return;
      const { offsetX: x, offsetY: y } = event;
      pressed = { x, y, moved: false };
      held = nearest(page, x, y, reachOf(event));
      mark(held);
      if (held === null) return;
      event.stopImmediatePropagation();
      canvas.focus({ preventScroll: true });
      canvas.setPointerCapture(event.pointerId);
    },
    { capture: true },
  );

  canvas.addEventListener('pointermove', (event) => {
    if (!flat()) return;
    const { offsetX: x, offsetY: y } = event;
    if (pressed) {
      pressed.moved ||= Math.hypot(x - pressed.x, y - pressed.y) >= CLICK;
      if (held !== null && pressed.moved) void move(held, x, y);
    } else if (event.pointerType === 'mouse') mark(nearest(page, x, y, reachOf(event)));
  });

  const release = (event: PointerEvent) => {
    if (!pressed || !event.isPrimary) return;
    const { moved } = pressed;
    const point = held;
    pressed = held = null;
    if (!flat() || moved || event.type === 'pointercancel') return;
    if (point !== null && page.tool === 'remove') void remove(point);
    if (point === null && page.tool === 'add') void add(event.offsetX, event.offsetY);
  };
  canvas.addEventListener('pointerup', release);
  canvas.addEventListener('pointercancel', release);
  canvas.addEventListener('pointerleave', () => pressed ?? mark(null));
  canvas.addEventListener('blur', () => {
    held = null;
    mark(null);
  });

  const middle = () => middleOf(canvas);
  const nearestToMiddle = () => nearest(page, ...middle(), Infinity);
  const nudge = (right: number, up: number) => {
    const { positions, viewer } = page;
    const [width] = viewer!.seen;
    const [x, y] = viewer!.onCanvas(
      positions![3 * held!] + right * NUDGE * width,
      positions![3 * held! + 1] + up * NUDGE * width,
    );
    void move(held!, x, y);
  };
  const keys: Record<string, () => void> = {
    Enter: () => void add(...middle()),
    Delete: () => {
      const point = nearestToMiddle();
      if (point !== null) void remove(point);
    },
    ' ': () => {
      held = held === null ? nearestToMiddle() : null;
      said.textContent = held === null ? 'Point put down' : 'Point held';
      mark(held);
    },
  };
  keys.Backspace = keys.Delete;
  const whileHeld: Record<string, () => void> = {
    ArrowLeft: () => nudge(-1, 0),
    ArrowRight: () => nudge(1, 0),
    ArrowUp: () => nudge(0, 1),
    ArrowDown: () => nudge(0, -1),
    Escape: keys[' '],
  };
  const takeBack = () => {
    const last = page.settings.edits.at(-1);
    if (!last) return;
    undone.push(last);
    said.textContent = 'Undone';
    latest = page.settings.edits.slice(0, -1);
    void page.edit(latest);
  };
  const bringBack = () => {
    const edit = undone.pop();
    if (!edit) return;
    said.textContent = 'Redone';
    latest = [...page.settings.edits, edit];
    void page.edit(latest);
  };
  canvas.addEventListener('keydown', (event) => {
    if (!flat() || event.altKey) return;
    const withControl = { z: event.shiftKey ? bringBack : takeBack, y: bringBack };
    const act =
      event.ctrlKey || event.metaKey
        ? withControl[event.key.toLowerCase() as 'z' | 'y']
        : ((held !== null ? whileHeld[event.key] : undefined) ?? keys[event.key]);
    if (!act) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    act();
  });

  const tools = radios('tool', (tool) => {
    page.tool = tool as Tool;
    show();
  });
  undo.addEventListener('click', takeBack);
  redo.addEventListener('click', bringBack);
  byId('clear').addEventListener('click', () => {
    page.tool = 'add';
    void page.run({ kind: 'generator', dimension: 2, distribution: 'uniform', count: 0, seed: 1 });
  });

  const show = () => {
    // Something else has changed the points.
    if (page.settings.edits !== latest) undone = [];
    latest = page.settings.edits;
    canvas.dataset.tool = flat() ? page.tool : '';
    for (const radio of tools) radio.checked = radio.value === page.tool;
    undo.disabled = page.settings.edits.length === 0;
    redo.disabled = undone.length === 0;
  };
  const forget = () => {
    undone = [];
    held = pressed = null;
    mark(null);
    show();
  };
  return {
    changed: show,
    ran: forget,
    edited: () => {
      show();
      if (held !== null) mark(held);
    },
  };
}
