import type { Page, Part } from '../page';
import { byId, count, simplices } from './dom';
import { recall, remember } from './storage';

/** Says in words, once, what this machine has just done. */
export function firstVisit(page: Page): Part {
  const line = byId('first');
  const isFirst = recall('visited') === null;
  let runs = 0;
  return {
    ran({ dimension, points, simplices: made, stats }) {
      runs++;
      line.hidden = !isFirst || runs > 1 || made === 0 || page.settings.embed;
      if (line.hidden) return;
      const time = inWords(stats.milliseconds);
      line.textContent = `Your machine just turned ${count(points)} points into ${simplices(made, dimension)} in ${time}, all of them exact.`;
      remember('visited', '1');
    },
  };
}

const NUMBERS = ['two', 'three', 'four', 'five', 'six', 'seven', 'eight', 'nine', 'ten'];

/** A time as people say it. */
export function inWords(milliseconds: number): string {
  const known: [number, string][] = [
    [70, 'less than a tenth of a second'],
    [180, 'a tenth of a second'],
    [290, 'a quarter of a second'],
    [410, 'a third of a second'],
    [750, 'half a second'],
    [1500, 'about a second'],
  ];
  const words = known.find(([below]) => milliseconds < below)?.[1];
  const seconds = Math.round(milliseconds / 1000);
  return words ?? `about ${NUMBERS[seconds - 2] ?? count(seconds)} seconds`;
}
