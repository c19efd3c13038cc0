import type { Page } from '../page';
import { byId } from './dom';

const TURN = Math.PI / 36;

/** How far the 2D view moves, as a share of what is visible. */
const STEP = 0.08;

/** The keys that work while the drawing has the focus. */
export function wireKeyboard(page: Page): void {
  const slice = (by: number) => {
    const keep = page.settings.keep ?? page.lastDrawing?.keep;
    if (keep !== undefined) page.change({ keep: Math.min(1, Math.max(0, keep + by)) });
  };
  const isFlat = () => page.settings.source.dimension === 2;
  const go = (right: number, up: number) =>
    isFlat()
      ? page.viewer?.pan(right * STEP, up * STEP)
      : page.viewer?.orbit(right * TURN, up * TURN, 1);
  const home = () => page.change({ camera: null });
  const keys: Record<string, () => void> = {
    ArrowLeft: () => go(-1, 0),
    ArrowRight: () => go(1, 0),
    ArrowUp: () => go(0, 1),
    ArrowDown: () => go(0, -1),
    '+': () => page.viewer?.orbit(0, 0, 0.9),
    '=': () => page.viewer?.orbit(0, 0, 0.9),
    '-': () => page.viewer?.orbit(0, 0, 1 / 0.9),
    '[': () => slice(-0.01),
    ']': () => slice(0.01),
    Home: home,
  };
  byId('canvas').addEventListener('keydown', (event) => {
    const act = event.ctrlKey || event.metaKey || event.altKey ? undefined : keys[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
  byId('reset').addEventListener('click', home);
}
