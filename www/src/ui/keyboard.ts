import type { Page } from '../page';
import { HOME } from '../settings';
import { byId } from './dom';

const TURN = Math.PI / 36;

/** The keys that work while the drawing has the focus. */
export function wireKeyboard(page: Page): void {
  const slice = (by: number) => page.change({ keep: Math.min(1, Math.max(0, page.settings.keep + by)) });
  const keys: Record<string, () => void> = {
    ArrowLeft: () => page.viewer?.orbit(-TURN, 0, 1),
    ArrowRight: () => page.viewer?.orbit(TURN, 0, 1),
    ArrowUp: () => page.viewer?.orbit(0, TURN, 1),
    ArrowDown: () => page.viewer?.orbit(0, -TURN, 1),
    '+': () => page.viewer?.orbit(0, 0, 0.9),
    '=': () => page.viewer?.orbit(0, 0, 0.9),
    '-': () => page.viewer?.orbit(0, 0, 1 / 0.9),
    '[': () => slice(-0.01),
    ']': () => slice(0.01),
    Home: () => page.change({ camera: HOME }),
  };
  byId('canvas').addEventListener('keydown', (event) => {
    const act = event.ctrlKey || event.metaKey || event.altKey ? undefined : keys[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
  byId('reset').addEventListener('click', () => page.change({ camera: HOME }));
}
