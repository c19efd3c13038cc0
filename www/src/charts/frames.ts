import { CHART, chart } from './theme';

/** The last frames' times in milliseconds, as a line. */
export function framesChart(milliseconds: readonly number[]): Promise<Element> {
  return chart('Milliseconds to triangulate each of the last frames', (Plot) => ({
    ...CHART,
    height: 84,
    marginLeft: 28,
    marginTop: 6,
    marginBottom: 6,
    x: { axis: null },
    y: { label: null, ticks: 3, grid: true, zero: true },
    marks: [
      Plot.areaY(milliseconds, { fill: 'var(--accent)', fillOpacity: 0.15 }),
      Plot.lineY(milliseconds, { stroke: 'var(--accent)' }),
    ],
  }));
}
