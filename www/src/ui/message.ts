import { byId } from './dom';

/** Says what went wrong, until it is closed or the next run begins. */
export function showMessage(text: string | null): void {
  byId('message').hidden = text === null;
  byId('message-text').textContent = text ?? '';
}

export function wireMessage(): void {
  byId('message-close').addEventListener('click', () => showMessage(null));
}
