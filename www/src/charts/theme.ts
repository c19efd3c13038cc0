import { create } from '../ui/dom';

/** What all charts share: their size in the panel, and text in the colours of the theme. */
export const CHART = {
  width: 336,
  style: { background: 'none', color: 'var(--ink)', fontFamily: 'var(--sans)', fontSize: '11px' },
} as const;

/**
 * Draws a chart with Observable Plot, which is fetched when the first is wanted. To a screen reader
 * it is one picture with a description, not the parts that Plot names.
 */
export async function chart(
  description: string,
  options: (Plot: typeof import('@observablehq/plot')) => import('@observablehq/plot').PlotOptions,
): Promise<Element> {
  const Plot = await import('@observablehq/plot').catch(() => null);
  // Offline, say. The figures are in words besides.
  if (!Plot)
    return create('p', { className: 'note' }, `${description} (the chart could not be loaded)`);
  const drawn = Plot.plot(options(Plot));
  for (const part of drawn.querySelectorAll('g[aria-label]')) part.removeAttribute('aria-label');
  const svg = drawn instanceof SVGElement ? drawn : drawn.querySelector('svg:last-of-type')!;
  svg.setAttribute('role', 'img');
  svg.setAttribute('aria-label', description);
  return drawn;
}
