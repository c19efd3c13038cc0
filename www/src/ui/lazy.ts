import type { Page, Part } from '../page';
import type { Settings } from '../settings';
import { complaintAbout } from './complaint';
import { showMessage } from './message';

/** A part of the page in a chunk of its own, which is loaded once it is wanted. */
function lazy(
  load: () => Promise<Part>,
  isWanted: (settings: Settings) => boolean,
  panel?: string,
): Part {
  let part: Part | null = null;
  let isLoading = false;
  const begin = async () => {
    if (isLoading) return;
    isLoading = true;
    try {
      part = await load();
    } catch (error) {
      isLoading = false;
      showMessage(complaintAbout('A part of the page', error));
    }
  };
  return {
    changed(settings) {
      if (isWanted(settings)) void begin();
      part?.changed?.(settings);
    },
    showed(shown) {
      if (shown === panel) void begin();
      part?.showed?.(shown);
    },
    ran: (summary) => part?.ran?.(summary),
    edited: (summary) => part?.edited?.(summary),
    lived: (on) => part?.lived?.(on),
    moved: () => part?.moved?.(),
  };
}

const isFlat = ({ source }: Settings) => source.dimension === 2;

/** Weights of points: wanted in 2D, and where somebody looks for them. */
export const weights = (page: Page): Part =>
  lazy(
    async () => (await import('./weighing')).weighing(page),
    (settings) => isFlat(settings) || settings.weights !== null,
    'view',
  );

/** Polygons: wanted in 2D. */
export const polygons = (page: Page): Part =>
  lazy(async () => (await import('./polygons')).polygons(page), isFlat);
