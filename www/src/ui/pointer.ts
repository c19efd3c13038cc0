import type { Picked } from '../model/model';
import type { Page, Part } from '../page';
import { byId, count, create, measured } from './dom';

/** Shows the tetrahedron under the pointer: its outline on the model, its numbers beside it. */
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
      page.viewer.showOutline(picked?.corners ?? null);
      tip.hidden = picked === null;
      if (picked) describe(tip, picked, x, y, canvas);
    }
    busy = false;
  };

  canvas.addEventListener('pointermove', (event) => {
    if (event.buttons !== 0 || event.pointerType !== 'mouse') return;
    asked = { x: event.offsetX, y: event.offsetY };
    void ask();
  });
  canvas.addEventListener('pointerleave', (event) => event.pointerType === 'mouse' && hide());
  canvas.addEventListener('pointerdown', hide);
  canvas.addEventListener('click', (event) => {
    asked = { x: event.offsetX, y: event.offsetY };
    void ask();
  });
  return { ran: hide };
}

function describe(tip: HTMLElement, picked: Picked, x: number, y: number, canvas: HTMLElement): void {
  const rows: [string, string][] = [
    ['tetrahedron', count(picked.index)],
    ['vertices', picked.vertices.join(' ')],
    ['neighbours', picked.neighbors.map((n) => (n < 0 ? 'outside' : n)).join(' ')],
    ['radius ratio', measured(picked.radiusRatio)],
    ['volume', measured(picked.volume)],
    ['circumradius', measured(picked.circumradius)],
  ];
  if (picked.phase) rows.push(['made in phase', String(picked.phase)]);
  tip.replaceChildren(...rows.flatMap(([name, value]) => [create('dt', {}, name), create('dd', {}, value)]));
  const { offsetWidth, offsetHeight } = tip;
  tip.style.left = `${Math.max(8, x + 18 + offsetWidth > canvas.clientWidth ? x - 18 - offsetWidth : x + 18)}px`;
  tip.style.top = `${Math.min(Math.max(8, y - 20), canvas.clientHeight - offsetHeight - 8)}px`;
}
