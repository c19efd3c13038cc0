import { duration } from '../ui/dom';
import { CHART, chart } from './theme';

export interface Time {
  name: string;
  milliseconds: number;
  /** The page's own backends are set off from the others. */
  ours: boolean;
}

/** Times side by side. */
export function timesChart(times: readonly Time[]): Promise<Element> {
  return chart(
    times.map(({ name, milliseconds }) => `${name}: ${duration(milliseconds)}`).join(', '),
    (Plot) => ({
      ...CHART,
      height: 20 + 44 * times.length,
      marginLeft: 0,
      marginRight: 56,
      marginTop: 8,
      marginBottom: 4,
      x: { axis: null },
      y: { axis: null, domain: times.map(({ name }) => name), padding: 0.62 },
      marks: [
        Plot.barX(times, {
          y: 'name',
          x: 'milliseconds',
          fill: (d) => (d.ours ? 'var(--accent)' : 'var(--muted)'),
        }),
        Plot.text(times, {
          y: 'name',
          x: 0,
          text: 'name',
          textAnchor: 'start',
          dy: -15,
          fill: 'currentColor',
        }),
        Plot.text(times, {
          y: 'name',
          x: 'milliseconds',
          text: (d) => duration(d.milliseconds),
          textAnchor: 'start',
          dx: 6,
          fill: 'currentColor',
        }),
      ],
    }),
  );
}
