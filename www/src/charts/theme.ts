/** What all charts share: their size in the panel, and text in the colours of the theme. */
export const CHART = {
  width: 336,
  style: { background: 'none', color: 'var(--ink)', fontFamily: 'var(--sans)', fontSize: '11px' },
} as const;

/** Observable Plot, fetched when the first chart is wanted. */
export const plot = () => import('@observablehq/plot');
