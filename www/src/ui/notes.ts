import type { Summary } from '../model/model';
import type { Page, Part } from '../page';
import { byId, count } from './dom';

/** The line that says which of the file's points are not in the mesh, and which in it are not the file's. */
export function notes(page: Page): Part {
  const text = byId('note-text');
  const button = byId('bare');
  button.addEventListener('click', () => {
    const { source } = page.settings;
    if (source.kind !== 'file' && source.kind !== 'url') return;
    const { bare, ...coarse } = source;
    void page.run(bare ? coarse : { ...source, bare: true });
  });

  const show = ({ noReturn, onFaces }: Summary) => {
    byId('notes').hidden = noReturn === 0 && onFaces === null;
    text.textContent = [leftOut(noReturn), added(onFaces)].filter(Boolean).join(' ');
    button.hidden = onFaces === null;
    button.textContent = onFaces?.taken ? 'Corners only' : 'Put points on them';
  };
  return { ran: show, edited: show };
}

function leftOut(noReturn: number): string {
  if (noReturn === 0) return '';
  return noReturn === 1
    ? 'One point without a measurement is left out.'
    : `${count(noReturn)} points without a measurement are left out.`;
}

function added(onFaces: Summary['onFaces']): string {
  if (!onFaces) return '';
  return onFaces.taken
    ? `${count(onFaces.points)} points were put on the model’s large faces.`
    : 'The model’s large faces have no points.';
}
