import { byId } from './dom';

const HEIGHTS = [undefined, 'half', 'full'] as const;

/** Makes the panel on a phone, a sheet at the bottom, as tall as is wanted. */
export function wireSheet(): { open(): void } {
  const panel = byId('panel');
  const handle = byId('handle');
  const show = (height: (typeof HEIGHTS)[number]) => {
    if (height) panel.dataset.height = height;
    else delete panel.dataset.height;
    panel.scrollTop = 0;
    handle.setAttribute(
      'aria-label',
      height === 'full' ? 'Fold the panel' : 'Make the panel taller',
    );
  };
  handle.addEventListener('click', () => {
    const now = HEIGHTS.indexOf(panel.dataset.height as (typeof HEIGHTS)[number]);
    show(HEIGHTS[(now + 1) % HEIGHTS.length]);
  });
  byId('canvas').addEventListener('pointerdown', () => show(undefined));
  return { open: () => panel.dataset.height ?? show('half') };
}
