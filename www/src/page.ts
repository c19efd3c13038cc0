import type { Dimension } from './geometry/dimension';
import type { ModelClient } from './model/client';
import type { Edit } from './model/edits';
import type { Drawing, Summary } from './model/model';
import type { Found } from './model/scanned';
import type { Source } from './model/source';
import type { Settings, Tool, viewOf } from './settings';
import type { Viewer } from './view/viewer';

/** What the parts of the page may do with the whole. */
export interface Page {
  readonly settings: Settings;
  readonly model: ModelClient;
  /** Null until three.js is there, and where the browser cannot draw. */
  readonly viewer: Viewer | null;
  /** What the last run gave; null before the first has ended. */
  readonly summary: Summary | null;
  /** The surface of the points; null before it is found, and where there is none. */
  readonly surface: Found | null;
  /** Whether the radius that suits the filter `alpha` is found. */
  readonly isRadiusFound: boolean;
  /** How the points are looked at and cut, chosen or not. */
  readonly view: ReturnType<typeof viewOf>;
  /** Whether points move: then the live mode draws, not the page. */
  readonly live: boolean;
  /** Starts or ends the time in which points move. */
  goLive(on: boolean): void;
  /** Whether there is a GPU to triangulate on; null until that is known. */
  readonly hasGpu: boolean | null;
  /** What is on the screen; null before anything is. */
  readonly lastDrawing: Drawing | null;
  /**
   * Gets points and triangulates them, and takes over the settings once there is a new mesh. Says
   * what goes wrong on the page; resolves to whether there is one.
   */
  run(source: Source, settings?: Partial<Settings>): Promise<boolean>;
  /**
   * Runs the present points again, on the GPU, and keeps what happened on the way. Resolves as
   * {@link run}.
   */
  record(): Promise<boolean>;
  /** Switches to 3D or 2D, to what was there before. */
  goTo(dimension: Dimension): void;
  /**
   * Triangulates the 2D points with these changes by hand instead of the current ones. Of changes
   * that come faster than they can be triangulated, only the last count.
   */
  edit(edits: readonly Edit[]): Promise<void>;
  /** The points as drawn; null before there are any. */
  readonly positions: Float32Array | null;
  /** What a click does in 2D. */
  tool: Tool;
  /** Shows and hides layers as the settings say, after other things were given to the viewer. */
  look(): void;
  /** Changes settings and draws anew. */
  change(settings: Partial<Settings>): void;
  /** Shows the mesh of the last run again, after the live mode. */
  restore(): void;
  /** Shows the triangulation after a round of the trace; null for the result. */
  showRound(round: number | null): void;
}

/** A part of the page, which is told of what happens. */
export interface Part {
  /** There is a new mesh. */
  ran?(summary: Summary): void;
  /** There is a new mesh of points that were changed by hand: of many changes in a row, of each. */
  edited?(summary: Summary): void;
  /** Settings have changed. */
  changed?(settings: Settings): void;
  /** Points begin to move, or no longer do: what was found out about the mesh is not about them. */
  lived?(on: boolean): void;
  /** The surface of the points was found. */
  found?(surface: Found): void;
  /** There is a new drawing. */
  drew?(drawing: Drawing): void;
  /** The camera has moved, or the drawing has another size. */
  moved?(): void;
  /** A panel has come to the front. */
  showed?(panel: string): void;
}
