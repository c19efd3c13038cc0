import { CHART, chart } from './theme';

/** What happened in one round of Phase 1. */
export interface Round {
  inserted: number;
  flips: number;
  milliseconds: number;
}

const format = (n: number) => (n < 1000 ? String(n) : n < 1e6 ? `${n / 1000}k` : `${n / 1e6}M`);

/** 0 and the powers of ten up to the largest of some counts. */
const powers = (counts: readonly number[]) => [
  0,
  ...Array.from({ length: 1 + Math.log10(Math.max(1, ...counts)) }, (_, i) => 10 ** i),
];

/** Points inserted and flips made, round by round. */
export function roundsChart(rounds: readonly Round[]): Promise<Element> {
  const rows = rounds.flatMap(({ inserted, flips }, i) => [
    { round: i + 1, what: 'inserted', count: inserted },
    { round: i + 1, what: 'flips', count: flips },
  ]);
  return chart('Points inserted and flips made in each round', (Plot) => ({
    ...CHART,
    height: 190,
    marginLeft: 44,
    marginTop: 12,
    marginBottom: 32,
    x: { label: 'round', ticks: Math.min(rounds.length, 10), tickFormat: 'd' },
    y: {
      label: null,
      grid: true,
      tickFormat: (n: number) => (n === 0 ? '0' : format(n)),
      ticks: powers(rows.map(({ count }) => count)),
      type: 'symlog',
    },
    color: { domain: ['inserted', 'flips'], range: ['#56b4e9', '#009e73'], legend: true },
    marks: [
      Plot.ruleY([0]),
      Plot.line(rows, { x: 'round', y: 'count', stroke: 'what', strokeWidth: 1.5 }),
      Plot.dot(rows, {
        x: 'round',
        y: 'count',
        fill: 'what',
        r: 2.5,
        title: (d) => `round ${d.round}: ${d.count} ${d.what}`,
      }),
    ],
  }));
}

/** The milliseconds of each round, on a common time axis. */
export function timelineChart(rounds: readonly Round[]): Promise<Element> {
  let end = 0;
  const rows = rounds.map(({ milliseconds }, i) => ({
    round: i + 1,
    from: end,
    to: (end += milliseconds),
  }));
  return chart('When each round took place', (Plot) => ({
    ...CHART,
    height: 74,
    marginLeft: 0,
    marginBottom: 32,
    x: { label: 'milliseconds since Phase 1 began', ticks: 5 },
    y: { axis: null },
    marks: [
      Plot.rect(rows, {
        x1: 'from',
        x2: 'to',
        y1: 0,
        y2: 1,
        fill: 'currentColor',
        fillOpacity: (d) => (d.round % 2 ? 0.42 : 0.24),
        inset: 0.5,
        title: (d) => `round ${d.round}: ${(d.to - d.from).toFixed(1)} ms`,
      }),
    ],
  }));
}
