import { byId } from './dom';

/** The short story for those who are new to this. */
export function wireAbout(): void {
  byId('help').addEventListener('click', () => byId<HTMLDialogElement>('about').showModal());
}
