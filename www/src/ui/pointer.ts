import type { Picked } from '../model/model';
import type { Page, Part } from '../page';
import { byId, count, create, measured } from './dom';
import { CLICK } from './editor';

/**
 * Shows the simplex under the pointer: its outline on the model, in 2D with its circumcircle, and
 * its numbers beside it.
 */
export function pointer(page: Page): Part {
  const canvas = byId<HTMLCanvasElement>('canvas');
  const tip = byId('tip');
  let asked: { x: number; y: number } | null = null;
  let busy = false;

  const hide = () => {
    asked = null;
    tip.hidden = true;
    page.viewer?.showOutline(null);
  };

  /** One question at a time; of those that come meanwhile, only the last is asked. */
  const ask = async () => {
    if (busy || !page.viewer) return;
    busy = true;
    while (asked) {
      const { x, y } = asked;
      asked = null;
      const picked = await page.model.pick(page.viewer.ray(x, y), page.settings.apart);
      page.viewer.showOutline(picked?.outline ?? null);
      tip.hidden = picked === null;
      if (picked) describe(tip, picked, page, x, y);
    }
    busy = false;
  };

  /** In 2D, other tools have other uses for a click. */
  const asks = () => page.settings.source.dimension === 3 || page.tool === 'move';
  let pressed: { x: number; y: number } | null = null;

  canvas.addEventListener('pointermove', (event) => {
    if (event.buttons !== 0 || event.pointerType !== 'mouse' || !asks()) return;
    asked = { x: event.offsetX, y: event.offsetY };
    void ask();
  });
  canvas.addEventListener('pointerleave', (event) => event.pointerType === 'mouse' && hide());
  canvas.addEventListener(
    'pointerdown',
    ({ offsetX, offsetY }) => {
      pressed = { x: offsetX, y: offsetY };
      hide();
    },
    { capture: true },
  );
  canvas.addEventListener('click', (event) => {
    // The end of a drag is no question.
    if (
      !asks() ||
      !pressed ||
      Math.hypot(event.offsetX - pressed.x, event.offsetY - pressed.y) >= CLICK
    )
      return;
    asked = { x: event.offsetX, y: event.offsetY };
    void ask();
  });
  return { ran: hide, edited: hide, showed: hide };
}

function describe(tip: HTMLElement, picked: Picked, page: Page, x: number, y: number): void {
  const { dimension, frame } = page.summary!;
  const rows: [string, string][] = [
    ...picked.place.map((at, axis): [string, string] => ['xyz'[axis], located(at, frame.scale)]),
    ...(picked.height === null
      ? []
      : [['height', located(picked.height, frame.scale)] as [string, string]]),
    [dimension === 3 ? 'tetrahedron' : 'triangle', count(picked.index)],
    ['vertices', picked.vertices.join(' ')],
    ['neighbours', picked.neighbors.map((n) => (n < 0 ? 'outside' : n)).join(' ')],
    ['radius ratio', measured(picked.radiusRatio)],
    [dimension === 3 ? 'volume' : 'area', measured(picked.volume)],
    ['circumradius', measured(picked.circumradius)],
  ];
  if (picked.phase) rows.push(['made in phase', String(picked.phase)]);
  tip.replaceChildren(
    ...rows.flatMap(([name, value]) => [create('dt', {}, name), create('dd', {}, value)]),
  );
  const { offsetWidth, offsetHeight } = tip;
  const canvas = byId('canvas');
  tip.style.left = `${Math.max(8, x + 18 + offsetWidth > canvas.clientWidth ? x - 18 - offsetWidth : x + 18)}px`;
  tip.style.top = `${Math.min(Math.max(8, y - 20), canvas.clientHeight - offsetHeight - 8)}px`;
}

/** A coordinate to a thousandth of the object's size. */
export function located(x: number, scale: number): string {
  const digits = Math.ceil(3 + Math.log10(scale));
  return Math.abs(x) < 1e15 && digits <= 20 ? x.toFixed(Math.max(0, digits)) : measured(x);
}
