// The tables of benches/results with a chart each, drawn here so that the page needs no script.

import * as Plot from '@observablehq/plot';
import { parseHTML } from 'linkedom';
import { tables } from '../../../scripts/results.mjs';

const { document } = parseHTML('<!doctype html><html><body></body></html>');
const WIDTH = 860;
const ROW = 24;
const COLORS = ['var(--accent)', 'var(--ink)', 'var(--muted)'];
const SYMBOLS = ['circle', 'square', 'triangle'];

/** Returns the unit at the end of a heading, such as `ms` of `whole, ms`. */
const unitOf = (heading) => /^(?:(.*), )?(ms|s)$/.exec(heading)?.[2];

/** Returns a dot for each measured time: the median, with the range of processes. */
function dotsOf({ lines, values }) {
  const unit = values.map(unitOf).find((found) => found);
  return lines.flatMap(({ keys, values: cells, letter }, row) =>
    cells.flatMap(({ median, range }, i) =>
      unitOf(values[i]) === unit && median > 0
        ? [
            {
              row,
              label: [...keys.filter((key) => key !== ''), letter].filter(Boolean).join(' · '),
              series: values[i].replace(/, m?s$/, ''),
              median,
              low: range[0],
              high: range[1],
            },
          ]
        : [],
    ),
  );
}

function chartOf(table) {
  const dots = dotsOf(table);
  const rows = [...new Set(dots.map(({ row }) => row))];
  const labels = new Map(dots.map(({ row, label }) => [row, label]));
  const series = [...new Set(dots.map((dot) => dot.series))];
  const unit = table.values.map(unitOf).find((found) => found);
  const chart = Plot.plot({
    document,
    width: WIDTH,
    height: ROW * rows.length + 50,
    marginLeft: 280,
    marginRight: 40,
    marginTop: 8,
    marginBottom: 42,
    ariaLabel: `${table.title}: a chart of the times in the table below`,
    style: { fontFamily: 'inherit', fontSize: '13px', color: 'inherit', background: 'none' },
    x: {
      type: 'log',
      label: unit === 's' ? 'seconds' : 'milliseconds',
      labelArrow: 'none',
      labelAnchor: 'center',
      nice: true,
      grid: true,
      ticks: 5,
      tickFormat: (tick) => tick.toLocaleString('en-US'),
    },
    y: { domain: rows, label: null, tickFormat: (row) => labels.get(row), tickSize: 0 },
    color: { domain: series, range: COLORS },
    symbol: { domain: series, range: SYMBOLS },
    marks: [
      Plot.ruleY(dots, { x1: 'low', x2: 'high', y: 'row', stroke: 'series', strokeWidth: 2 }),
      Plot.dot(dots, { x: 'median', y: 'row', fill: 'series', symbol: 'series', r: 4.5 }),
    ],
  });
  chart.setAttribute('role', 'img');
  // A picture has one name; those of its parts would be read as well.
  for (const part of chart.querySelectorAll('[aria-label]')) part.removeAttribute('aria-label');
  const legend = series.map((name, i) => ({
    name: name === unit ? '' : name,
    color: COLORS[i],
    symbol: SYMBOLS[i],
  }));
  return { svg: chart.outerHTML, legend: series.length > 1 ? legend : [] };
}

/** Marks what is code in the words of a file of results. */
const withCode = (text) =>
  text
    .replaceAll('&', '&amp;')
    .replaceAll('<', '&lt;')
    .replace(/`([^`]+)`/g, '<code>$1</code>');

export default () =>
  tables().map((table) => ({ ...table, about: withCode(table.about), ...chartOf(table) }));
