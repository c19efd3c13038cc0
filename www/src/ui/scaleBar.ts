import type { Page, Part } from '../page';
import { byId, measured } from './dom';

/** The bar is at most so wide, in pixels. */
const WIDEST = 110;

/** The largest length of 1, 2 or 5 times a power of ten that is not longer. */
export function niceLength(longest: number): number {
  const power = 10 ** Math.floor(Math.log10(longest));
  const times = [5, 2, 1].find((each) => each * power <= longest) ?? 1;
  return times * power;
}

/** The bar that says how long things are, in units of the file: in 3D at the middle of the view. */
export function scaleBar(page: Page): Part {
  const bar = byId('scale-bar');
  const show = () => {
    const { viewer, summary } = page;
    const box = byId('scale');
    box.hidden = !viewer || !summary || summary.points < 2;
    if (!viewer || !summary) return;
    const perUnit = viewer.pixelsPerUnit * summary.frame.scale;
    const length = niceLength(WIDEST / perUnit);
    bar.style.width = `${length * perUnit}px`;
    byId('scale-length').textContent = measured(length);
  };
  return { drew: show, moved: show, changed: show };
}
