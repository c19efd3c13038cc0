import { type Edit, withEdit } from '../model/edits';
import { type Constrained, cornersOnlyOf } from '../model/shapes';
import type { Page } from '../page';
import { byId } from './dom';
import { CLICK } from './editor';
import { isFlat, middleOf, nearest, placeAt, reachOf } from './picking';

/** A place, on the canvas in pixels or in the frame. */
type Place = readonly [x: number, y: number];

/**
 * Draws polygons by clicks and keys, and removes them. Points are dragged and removed by the editor. Returns what knows
 * where the mouse is.
 */
export function polygonHand(
  page: Page,
  shown: () => Constrained | null,
  redraw: () => void,
): { pointer(): Place | null } {
  const stage = byId('stage');
  const canvas = byId<HTMLCanvasElement>('canvas');
  let pressed: Place | null = null;
  let pointer: Place | null = null;
  /** Whether the last corner was put by a key: then Enter puts another. */
  let byKey = false;
  const open = () => shown()?.open ?? [];
  const draws = () => isFlat(page) && page.tool === 'draw' && page.viewer !== null;

  /** Puts a corner at a place, or closes the polygon there. */
  const put = ([x, y]: Place, reach: number) => {
    const corners = open();
    const point = nearest(page, x, y, reach);
    if (point === null) change(page, { do: 'corner', at: placeAt(page, x, y) }, 'Corner added');
    else if (!corners.includes(point)) change(page, { do: 'join', point }, 'Corner added');
    else if (corners.length > 2 && (point === corners[0] || point === corners.at(-1))) close();
  };
  const close = () => change(page, { do: 'close' }, 'Polygon closed');

  // Before the canvas hears of it, where a press on a point ends.
  const listen = <K extends keyof HTMLElementEventMap>(
    type: K,
    heard: (event: HTMLElementEventMap[K]) => void,
  ) => stage.addEventListener(type, heard, { capture: true });
  listen('pointerdown', (event) => {
    pressed = null;
    if (event.target !== canvas || event.button !== 0 || !event.isPrimary) return;
    pressed = [event.offsetX, event.offsetY];
  });
  listen('pointermove', (event) => {
    if (event.target !== canvas || event.pointerType !== 'mouse') return;
    pointer = [event.offsetX, event.offsetY];
    if (draws() && open().length > 0) redraw();
  });
  listen('pointerup', (event) => {
    const place: Place = [event.offsetX, event.offsetY];
    const from = pressed;
    pressed = null;
    if (!from || Math.hypot(place[0] - from[0], place[1] - from[1]) >= CLICK) return;
    const reach = reachOf(event);
    if (draws()) {
      byKey = false;
      canvas.focus({ preventScroll: true });
      put(place, reach);
    } else if (isFlat(page) && page.tool === 'remove') removeAt(page, shown(), place, reach);
  });
  canvas.addEventListener('pointerleave', () => {
    pointer = null;
    if (draws()) redraw();
  });

  byId('keys-2d').append(
    ' With the tool Polygon, Enter adds a corner at the cross, and closes the polygon where the cross is on its first or last corner. Escape takes back a corner.',
  );
  const keys: Record<string, () => boolean> = {
    Enter() {
      if (!byKey && open().length > 2) close();
      else if (!byKey && open().length > 0) return true;
      else {
        byKey = true;
        put(middleOf(canvas), reachOf({ pointerType: 'mouse' }));
      }
      return true;
    },
    Escape() {
      if (open().length === 0) return false;
      byId('undo').click();
      return true;
    },
  };
  listen('keydown', (event) => {
    if (event.target === canvas && draws()) takeKey(event, keys);
  });
  return { pointer: () => pointer };
}

/** Does what a key stands for, if it returns true, and nothing else. */
function takeKey(event: KeyboardEvent, keys: Record<string, () => boolean>): void {
  if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]?.()) return;
  event.preventDefault();
  event.stopPropagation();
}

function change(page: Page, edit: Edit, words: string): void {
  byId('edited').textContent = words;
  void page.edit(withEdit(page.settings.edits, edit));
}

/** Removes a ring with the points that only it goes through. */
export function removeRing(page: Page, shown: Constrained, ring: number): void {
  const points = cornersOnlyOf(ring, shown);
  change(page, { do: 'erase', ring, points }, 'Polygon removed');
}

/** Removes the ring whose side is at a place, unless a point is. */
function removeAt(page: Page, shown: Constrained | null, place: Place, reach: number): void {
  const { viewer, positions } = page;
  if (!shown || !viewer || !positions || nearest(page, ...place, reach) !== null) return;
  const at = viewer.at2d(...place);
  const cornerAt = (i: number): Place => [positions[3 * i], positions[3 * i + 1]];
  let best: number | null = null;
  let least = viewer.at2d(place[0] + reach, place[1])[0] - at[0];
  for (const [i, ring] of shown.rings.entries()) {
    let from = cornerAt(ring.at(-1)!);
    for (const corner of ring) {
      const to = cornerAt(corner);
      const off = distanceTo(at, from, to);
      if (off < least) [best, least] = [i, off];
      from = to;
    }
  }
  if (best !== null) removeRing(page, shown, best);
}

/** The distance of a place from a segment. */
function distanceTo([x, y]: Place, [ax, ay]: Place, [bx, by]: Place): number {
  const [dx, dy] = [bx - ax, by - ay];
  const share = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1);
  const along = Math.min(1, Math.max(0, share));
  return Math.hypot(x - ax - along * dx, y - ay - along * dy);
}
