import { phaseColor } from '../ui/phases';
import { CHART, chart } from './theme';

/** One run: a bar of the chart. */
export interface Run {
  title: string;
  phases: { name: string; milliseconds: number }[];
}

/** The share of each phase in each run's time: the paper's Figure 7. */
export function breakdownChart(runs: readonly Run[]): Promise<Element> {
  const rows = runs.flatMap(({ title, phases }) => phases.map((phase) => ({ title, ...phase })));
  const names = [...new Set(rows.map(({ name }) => name))];
  return chart(
    `Share of each phase in the time of ${runs.map(({ title }) => title).join('; ')}`,
    (Plot) => ({
      ...CHART,
      height: 44 + 40 * runs.length,
      marginLeft: 0,
      marginTop: 12,
      marginBottom: 26,
      x: { label: null, percent: true, tickFormat: (x: number) => `${x} %`, ticks: 5 },
      y: { axis: null, domain: runs.map(({ title }) => title), padding: 0.66 },
      color: { domain: names, range: names.map(phaseColor) },
      marks: [
        Plot.barX(
          rows,
          Plot.stackX({
            offset: 'normalize',
            y: 'title',
            x: 'milliseconds',
            fill: 'name',
            order: names,
            insetLeft: 0.5,
            insetRight: 0.5,
          }),
        ),
        Plot.text(runs, {
          y: 'title',
          x: 0,
          text: 'title',
          textAnchor: 'start',
          dy: -14,
          fill: 'currentColor',
        }),
      ],
    }),
  );
}
