import { create } from '../ui/dom';
import { wireTheme } from '../ui/theme';
import { ROOT } from './root';
import { wireSearch } from './search';

/** Gives each block of code a button that copies it. */
function wireCopying(): void {
  // Not over plain HTTP.
  if (!navigator.clipboard) return;
  for (const code of document.querySelectorAll<HTMLElement>('.code')) {
    const button = create('button', { type: 'button', textContent: 'Copy' });
    button.addEventListener('click', async () => {
      await navigator.clipboard.writeText(code.querySelector('pre')?.textContent ?? '');
      button.textContent = 'Copied';
      setTimeout(() => (button.textContent = 'Copy'), 1500);
    });
    code.append(button);
  }
}

wireTheme(() => {});
wireCopying();
wireSearch();
if (import.meta.env.PROD) {
  // Not over plain HTTP, and not in the sandboxed frames of other pages.
  navigator.serviceWorker?.register(new URL('offline.js', ROOT)).catch(() => {});
}
