import type { Page } from '../page';

/** How near to something the pointer has to be, in pixels. */
export const reachOf = ({ pointerType }: Pick<PointerEvent, 'pointerType'>): number =>
  pointerType === 'mouse' ? 10 : 24;

/**
 * The 2D point that is nearest to a place on the canvas, within some pixels, or null. It is one of those that were
 * given. How far it is may be told by more than its distance.
 */
export function nearest(
  { viewer, positions, summary }: Page,
  x: number,
  y: number,
  reach: number,
  offOf = (distance: number, _point: number) => distance,
): number | null {
  if (!viewer || !positions) return null;
  const [px, py] = viewer.at2d(x, y);
  const pixels = 1 / (viewer.at2d(x + 1, y)[0] - px);
  const end = Math.min(positions.length, 3 * (summary?.given ?? Infinity));
  let least = reach;
  let found: number | null = null;
  for (let i = 0; i < end; i += 3) {
    const [dx, dy] = [positions[i] - px, positions[i + 1] - py];
    const off = offOf(pixels * Math.sqrt(dx * dx + dy * dy), i / 3);
    if (off <= least) [least, found] = [off, i / 3];
  }
  return found;
}

/**
 * A place on the canvas in the input's units, rounded to a fraction of a pixel: so links stay
 * short.
 */
export function placeAt({ viewer, summary }: Page, x: number, y: number): [number, number] {
  const { center, scale } = summary!.frame;
  const toInput = ([fx, fy]: [number, number]) =>
    [fx / scale + center[0], fy / scale + center[1]] as const;
  const [ix, iy] = toInput(viewer!.at2d(x, y));
  const pixel = toInput(viewer!.at2d(x + 1, y))[0] - ix;
  const digits = Math.min(15, Math.max(0, 1 - Math.floor(Math.log10(pixel))));
  return [Number(ix.toFixed(digits)), Number(iy.toFixed(digits))];
}

/** The place of the cross. */
export const middleOf = ({ clientWidth, clientHeight }: HTMLElement) =>
  [clientWidth / 2, clientHeight / 2] as const;

/** Whether there are 2D points that a hand can change. */
export const isFlat = ({ settings, live, summary }: Page): boolean =>
  settings.source.dimension === 2 && !live && summary !== null;
