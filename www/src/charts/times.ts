import { duration } from '../ui/dom';
import { CHART, chart } from './theme';

export interface Time {
  engine: string;
  milliseconds: number;
  /** The page's own engines are set off from the others. */
  ours: boolean;
}

/** Times side by side. */
export function timesChart(times: readonly Time[]): Promise<Element> {
  return chart(
    times.map(({ engine, milliseconds }) => `${engine}: ${duration(milliseconds)}`).join(', '),
    (Plot) => ({
      ...CHART,
      height: 20 + 44 * times.length,
      marginLeft: 0,
      marginRight: 56,
      marginTop: 8,
      marginBottom: 4,
      x: { axis: null },
      y: { axis: null, domain: times.map(({ engine }) => engine), padding: 0.62 },
      marks: [
        Plot.barX(times, {
          y: 'engine',
          x: 'milliseconds',
          fill: (d) => (d.ours ? 'var(--accent)' : 'var(--muted)'),
        }),
        Plot.text(times, {
          y: 'engine',
          x: 0,
          text: 'engine',
          textAnchor: 'start',
          dy: -15,
          fill: 'currentColor',
        }),
        Plot.text(times, {
          y: 'engine',
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
