import type { Page, Part } from '../page';
import { complaintAbout } from './complaint';
import { showMessage } from './message';

/** Weights of points, in a chunk of its own: it is loaded in 2D, and where somebody looks for it. */
export function weights(page: Page): Part {
  let part: Part | null = null;
  let isLoading = false;
  const load = async () => {
    if (isLoading) return;
    isLoading = true;
    try {
      part = (await import('./weighing')).weighing(page);
    } catch (error) {
      isLoading = false;
      showMessage(complaintAbout('A part of the page', error));
    }
  };
  return {
    changed(settings) {
      if (settings.source.dimension === 2 || settings.weights) void load();
      part?.changed?.(settings);
    },
    showed: (panel) => void (panel === 'view' && load()),
    ran: (summary) => part?.ran?.(summary),
    edited: (summary) => part?.edited?.(summary),
    lived: (on) => part?.lived?.(on),
    moved: () => part?.moved?.(),
  };
}
