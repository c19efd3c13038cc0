import { PRINT_FORMATS } from '../model/save';
import type { Found } from '../model/scanned';
import type { Page, Part } from '../page';
import { byId, count, create, measured, things } from './dom';
import { download } from './download';

/** The line that says how large the surface of a scan is, and saves it for a printer. */
export function surfaceLine(page: Page): Part {
  const line = byId('surface');
  const text = byId('surface-text');
  const buttons = PRINT_FORMATS.map((format) => {
    const button = create('button', { type: 'button', className: 'small' }, format);
    button.setAttribute('aria-label', `Save for printing as ${format}`);
    button.addEventListener('click', () =>
      download(page, format, button, async () => [await page.model.print(format)]),
    );
    return button;
  });
  byId('prints').append(...buttons);

  const changed = () => {
    const { surface, settings } = page;
    const isShown = surface !== null && settings.filter === 'surface' && !page.live;
    line.hidden = !isShown;
    // Printers need a closed one.
    byId('prints').hidden = !surface?.closed;
    // The status is read out, so it changes only when it has to.
    const words = isShown ? wordsOf(surface) : '';
    if (text.textContent !== words) text.textContent = words;
  };
  return { changed, ran: changed, found: changed, lived: changed };
}

function wordsOf({ components, volume, area, isolated, smoothed, closed }: Found): string {
  const parts = components > 1 ? ` in ${count(components)} parts` : '';
  const kind = `${closed ? 'Closed' : 'Open'} surface${parts}`;
  const inside = closed ? `volume ${measured(volume)} file units³, ` : '';
  return [
    `${kind}: ${inside}area ${measured(area)} file units².`,
    isolated > 0 ? `${things(isolated, 'stray point', 'stray points')} left out.` : '',
    smoothed ? 'Noise was smoothed.' : '',
  ]
    .filter(Boolean)
    .join(' ');
}
