import type { Page } from '../page';
import { toHash } from '../settings';
import { byId } from './dom';

/** The button that copies a link to the view. */
export function wireShare(page: Page): void {
  const button = byId('share');
  button.addEventListener('click', async () => {
    const hash = toHash(page.settings);
    history.replaceState(null, '', `#${hash}`);
    try {
      await navigator.clipboard.writeText(location.href);
      button.textContent =
        page.settings.source.kind === 'file' ? 'Copied, without the file' : 'Link copied';
    } catch {
      // No permission, or no secure page: the link is in the address bar.
      button.textContent = 'Link is in the address bar';
    }
    setTimeout(() => (button.textContent = 'Share'), 2500);
  });
}
