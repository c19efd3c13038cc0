import type { Dimension } from '../geometry/dimension';
import type { Page, Part } from '../page';
import { radios } from './dom';

/** The switch between 3D and 2D, which also tells the style sheet what to show. */
export function dimensionSwitch(page: Page): Part {
  const buttons = radios('dimension', (value) => page.goTo(Number(value) as Dimension));
  return {
    changed({ source: { dimension } }) {
      document.documentElement.dataset.dimension = String(dimension);
      for (const button of buttons) button.checked = button.value === String(dimension);
    },
  };
}
