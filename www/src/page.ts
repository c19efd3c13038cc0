import type { ModelClient } from './model/client';
import type { Drawing, Summary } from './model/model';
import type { Source } from './model/source';
import type { Settings } from './settings';
import type { Viewer } from './view/viewer';

/** What the parts of the page may do with the whole. */
export interface Page {
  readonly settings: Settings;
  readonly model: ModelClient;
  /** Null until three.js is there, and where the browser cannot draw. */
  readonly viewer: Viewer | null;
  /** What the last run gave; null before the first has ended. */
  readonly summary: Summary | null;
  /** What is on the screen; null before anything is. */
  readonly lastDrawing: Drawing | null;
  /** Gets points and triangulates them. Says what goes wrong on the page; resolves to whether there is a new mesh. */
  run(source: Source): Promise<boolean>;
  /** Runs the present points again, on the GPU, and keeps what happened on the way. Resolves as {@link run}. */
  record(): Promise<boolean>;
  /** Changes settings and draws anew. */
  change(settings: Partial<Settings>): void;
  /** Shows the mesh of the last run again, after the live mode. */
  restore(): void;
  /** Shows the triangulation after a round of the trace; null for the result. */
  showRound(round: number | null): void;
}

/** Called when there is a new mesh, and when settings have changed. */
export interface Part {
  ran?(summary: Summary): void;
  changed?(settings: Settings): void;
  drew?(drawing: Drawing): void;
}
