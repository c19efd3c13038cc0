import type { SavedFile } from '../model/save';
import { stemOf } from '../model/source';
import type { Page } from '../page';
import { complaintAbout } from './complaint';
import { saveFile } from './dom';
import { showMessage } from './message';

/**
 * Has the browser save files of the points that are shown, once they are made. Says what goes wrong,
 * and keeps the button from being pressed meanwhile.
 */
export async function download(
  page: Page,
  format: string,
  button: HTMLButtonElement,
  make: () => Promise<SavedFile[]>,
): Promise<void> {
  button.disabled = true;
  showMessage(null);
  try {
    const files = await make();
    const stem = stemOf(page.settings.source);
    for (const { extension, bytes } of files) {
      saveFile(stem + extension, new Blob([bytes as Uint8Array<ArrayBuffer>]));
    }
  } catch (error) {
    showMessage(complaintAbout(format, error));
  } finally {
    button.disabled = false;
  }
}
