import type { Page, Part } from '../page';
import { byId, measured } from './dom';
import { CLICK } from './editor';

/**
 * Measures between points: while the button is pressed, a click on the model takes the nearest
 * corner of what is under it, and every second one gives a distance in units of the file.
 */
export function ruler(page: Page): Part {
  const button = byId<HTMLButtonElement>('measure');
  const said = byId('measured');
  const canvas = byId<HTMLCanvasElement>('canvas');
  let ends: number[] = [];
  let pressed = { x: 0, y: 0 };
  const isOn = () => button.getAttribute('aria-pressed') === 'true';

  const clear = () => {
    ends = [];
    page.viewer?.showRuler(null);
    said.textContent = isOn() ? 'Click on two points of the model.' : '';
    said.hidden = !isOn();
  };
  button.addEventListener('click', () => {
    button.setAttribute('aria-pressed', String(!isOn()));
    canvas.toggleAttribute('data-measures', isOn());
    clear();
  });

  /** The corner of the tetrahedron under a place that is nearest to it on the screen. */
  const pointAt = async (x: number, y: number): Promise<number | null> => {
    const { viewer, positions } = page;
    if (!viewer || !positions) return null;
    const picked = await page.model.pick(viewer.ray(x, y), page.settings.apart);
    if (!picked) return null;
    const farness = (v: number) => {
      const [left, top] = viewer.onCanvas(
        positions[3 * v],
        positions[3 * v + 1],
        positions[3 * v + 2],
      );
      return Math.hypot(left - x, top - y);
    };
    return picked.vertices.reduce((best, v) => (farness(v) < farness(best) ? v : best));
  };

  const take = async (x: number, y: number) => {
    const point = await pointAt(x, y);
    if (point === null || !isOn()) return;
    ends = ends.length === 1 && ends[0] !== point ? [ends[0], point] : [point];
    const positions = page.positions!;
    const places = ends.map((v) => [...positions.subarray(3 * v, 3 * v + 3)]);
    // One point alone is a short cross.
    const cross = [0, 1, 2].flatMap((axis) =>
      [-0.012, 0.012].flatMap((by) => places[0].map((c, i) => (i === axis ? c + by : c))),
    );
    page.viewer?.showRuler(Float32Array.from(places.length === 2 ? places.flat() : cross));
    if (ends.length === 1) {
      said.textContent = `From point ${ends[0]}. Click on another one.`;
      return;
    }
    const [from, to] = await Promise.all(ends.map((v) => page.model.place(v)));
    const distance = Math.hypot(...from.map((x, axis) => to[axis] - x));
    said.textContent = `From point ${ends[0]} to ${ends[1]}: ${measured(distance)} units of the file.`;
  };

  canvas.addEventListener(
    'pointerdown',
    ({ offsetX, offsetY }) => (pressed = { x: offsetX, y: offsetY }),
    { capture: true },
  );
  canvas.addEventListener('click', ({ offsetX, offsetY }) => {
    const isDrag = Math.hypot(offsetX - pressed.x, offsetY - pressed.y) >= CLICK;
    if (isOn() && !isDrag) void take(offsetX, offsetY);
  });
  return {
    ran({ dimension }) {
      if (dimension === 2) {
        button.setAttribute('aria-pressed', 'false');
        canvas.removeAttribute('data-measures');
      }
      clear();
    },
  };
}
