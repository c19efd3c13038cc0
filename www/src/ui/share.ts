import { pack } from '../model/packed';
import type { Page } from '../page';
import { toHash } from '../settings';
import { whileBusy } from './busy';
import { byId } from './dom';

/** The button that copies a link to the view. */
export function wireShare(page: Page): void {
  byId('whole').addEventListener('click', (event) => {
    (event.currentTarget as HTMLAnchorElement).href =
      `#${toHash({ ...page.settings, embed: false })}`;
  });
  const button = byId('share');
  button.addEventListener('click', async () => {
    const { source } = page.settings;
    if (source.kind === 'file' && source.files.length === 1)
      source.packed ??= (await whileBusy(pack(source.files[0]))) ?? undefined;
    const hash = toHash(page.settings);
    history.replaceState(null, '', `#${hash}`);
    try {
      await navigator.clipboard.writeText(location.href);
      button.textContent =
        source.kind === 'file' && !source.packed
          ? source.files.length > 1
            ? 'Copied, without the files'
            : 'Copied, without the file'
          : 'Link copied';
    } catch {
      // No permission, or no secure page: the link is in the address bar.
      button.textContent = 'Link is in the address bar';
    }
    setTimeout(() => (button.textContent = 'Share'), 2500);
  });
}
