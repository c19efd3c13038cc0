import type { UpdateStats } from 'gdel-wasm';
import { things } from './dom';

/** Says in one line how a frame of the live mode was made from the one before. */
export function updateOf(update: UpdateStats | null, dimension: 2 | 3): string {
  if (!update) return 'The first frame, from scratch';
  const { restarted, inverted, flips, stars, inserted } = update;
  const [one, many] = dimension === 3 ? ['tetrahedron', 'tetrahedra'] : ['triangle', 'triangles'];
  if (restarted) return `From scratch: ${REASONS[restarted]?.(many) ?? restarted}`;
  const done = [
    `${things(inverted, one, many)} inverted`,
    things(flips, 'flip', 'flips'),
    stars && things(stars, 'star mended', 'stars mended'),
    inserted && things(inserted, 'duplicate parted', 'duplicates parted'),
  ];
  return `Mesh kept: ${done.filter(Boolean).join(', ')}`;
}

const REASONS: Readonly<Record<string, (many: string) => string>> = {
  degenerate: () => 'the points are flat, or were',
  inverted: (many) => `too many ${many} are inverted`,
  changed: () => 'too much has changed',
  stuck: () => 'flips do not lead to the mesh',
  coincident: () => 'points have met',
  parted: () => 'too many duplicates have parted',
  'not-resident': () => 'the frame before is not on the GPU',
};
