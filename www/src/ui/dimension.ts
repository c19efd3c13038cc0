import type { Dimension } from '../model/source';
import type { Page, Part } from '../page';
import { radios } from './dom';

/** The switch between space and the plane, which also says to the page's style what is to be seen. */
export function dimensionSwitch(page: Page): Part {
  const buttons = radios('dimension', (value) => page.goTo(Number(value) as Dimension));
  return {
    changed({ source: { dimension } }) {
      document.documentElement.dataset.dimension = String(dimension);
      for (const button of buttons) button.checked = button.value === String(dimension);
    },
  };
}
