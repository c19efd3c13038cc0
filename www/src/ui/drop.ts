import { filesSource } from '../model/source';
import type { Page } from '../page';
import { byId } from './dom';

/** Takes files that are dropped anywhere on the page. */
export function wireDrop(page: Page): void {
  const hint = byId('drop');
  const holdsFiles = (event: DragEvent) => event.dataTransfer?.types.includes('Files') ?? false;
  window.addEventListener('dragover', (event) => {
    if (!holdsFiles(event)) return;
    event.preventDefault();
    hint.hidden = false;
  });
  window.addEventListener('dragleave', (event) => {
    // Leaving the window, not just an element of it.
    if (event.relatedTarget === null) hint.hidden = true;
  });
  window.addEventListener('drop', (event) => {
    hint.hidden = true;
    if (!holdsFiles(event)) return;
    event.preventDefault();
    const files = [...event.dataTransfer!.files];
    // A dropped folder of an application may hold none.
    if (files.length > 0) page.run(filesSource(files, page.settings.source.dimension));
  });
}
