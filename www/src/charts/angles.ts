import { CHART, chart } from './theme';

/** How many angles there are from each multiple of a step to the next, and where those that are asked for begin. */
export function anglesChart(
  counts: readonly number[],
  step: number,
  least: number,
): Promise<Element> {
  const rows = counts.map((count, i) => ({ from: step * i, to: step * (i + 1), count }));
  return chart('How many angles of the triangles have how many degrees', (Plot) => ({
    ...CHART,
    height: 130,
    marginLeft: 8,
    marginRight: 14,
    marginTop: 8,
    marginBottom: 24,
    x: {
      label: null,
      domain: [0, 180],
      ticks: [0, 30, 60, 90, 120, 150, 180],
      tickFormat: (x: number) => `${x}°`,
    },
    y: { axis: null },
    marks: [
      Plot.rectY(rows, {
        x1: 'from',
        x2: 'to',
        y: 'count',
        insetLeft: 0.5,
        insetRight: 0.5,
        fill: 'var(--accent)',
        title: (d) => `${d.from}° to ${d.to}°: ${d.count}`,
      }),
      ...(least > 0 ? [Plot.ruleX([least], { stroke: 'var(--ink)', strokeDasharray: '3 3' })] : []),
      Plot.ruleY([0]),
    ],
  }));
}
