import { byId } from './dom';

/** The box with the progress bar. */
export function showBusy(progress: { phase: string; fraction: number } | null): void {
  byId('busy').hidden = progress === null;
  byId('stage').setAttribute('aria-busy', String(progress !== null));
  if (!progress) return;
  const phase = byId('busy-phase');
  // The status is read out, so it changes only when it has to.
  if (phase.textContent !== progress.phase) phase.textContent = progress.phase;
  const bar = byId<HTMLProgressElement>('busy-progress');
  if (progress.fraction > 0) bar.value = progress.fraction;
  else bar.removeAttribute('value');
}
