import { byId } from './dom';

let pending = 0;

/**
 * Marks the stage as busy until `work` is done. Assistive technology then announces results once, when they and the drawing
 * belong together, and tests wait for it.
 */
export async function whileBusy<T>(work: Promise<T>): Promise<T> {
  pending++;
  mark();
  try {
    return await work;
  } finally {
    pending--;
    mark();
  }
}

function mark(): void {
  byId('stage').setAttribute('aria-busy', String(pending > 0));
}

/** Shows the box with the progress bar; null hides it. */
export function showBusy(progress: { phase: string; fraction: number } | null): void {
  byId('busy').hidden = progress === null;
  if (!progress) return;
  const phase = byId('busy-phase');
  // The status is read out, so it changes only when it has to.
  if (phase.textContent !== progress.phase) phase.textContent = progress.phase;
  const bar = byId<HTMLProgressElement>('busy-progress');
  if (progress.fraction > 0) bar.value = progress.fraction;
  else bar.removeAttribute('value');
}
