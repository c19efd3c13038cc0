import type { Page, Part } from '../page';
import { byId } from './dom';
import { recordFew, whyNotRecord } from './runPanel';

/** The short story for those who are new to this, which they can watch on their own points. */
export function about(page: Page): Part {
  const dialog = byId<HTMLDialogElement>('about');
  byId('help').addEventListener('click', () => dialog.showModal());

  byId('watch').addEventListener('click', async () => {
    dialog.close();
    byId('tab-run').click();
    const recorded =
      page.summary?.trace ||
      (await (whyNotRecord(page) === null ? page.record() : recordFew(page)));
    if (recorded && !matchMedia('(prefers-reduced-motion: reduce)').matches) byId('play').click();
  });

  const changed = () => {
    byId<HTMLButtonElement>('watch').disabled = page.hasGpu === false || !page.summary;
    byId('watch-note').textContent =
      page.hasGpu === false
        ? 'That needs a GPU, and this browser offers none through WebGPU.'
        : whyNotRecord(page) === null
          ? 'On the points that are open, which are triangulated once more for it.'
          : 'On 3,000 points in a thin shell: those that are open cannot be recorded.';
  };
  return { changed, ran: changed };
}
