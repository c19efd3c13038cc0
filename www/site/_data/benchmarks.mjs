// The tables of benches/results with a chart each, drawn here so that the page needs no script.

import * as Plot from '@observablehq/plot';
import { parseHTML } from 'linkedom';
import { tables } from '../../../scripts/results.mjs';

const { document } = parseHTML('<!doctype html><html><body></body></html>');
/** In pixels: for pages that have room for labels beside the dots, and for phones, where they are above. */
const SIZES = {
  wide: { width: 860, row: 24, marginLeft: 280 },
  narrow: { width: 358, row: 44, marginLeft: 12 },
};
const COLORS = ['var(--accent)', 'var(--ink)', 'var(--muted)'];
const SYMBOLS = ['circle', 'square', 'triangle'];

/** Returns the unit at the end of a heading, such as `ms` of `whole, ms`. */
const unitOf = (heading) => /^(?:(.*), )?(ms|s)$/.exec(heading)?.[2];

const unitIn = ({ values }) => values.map(unitOf).find((unit) => unit);

/** Returns what a key says without its heading. */
function named(heading, key) {
  if (heading === 'dimension') return `${key}D`;
  if (heading === 'threads') return `${key} ${key === '1' ? 'thread' : 'threads'}`;
  return key;
}

/** Returns a dot for each measured time: the median, with the range of processes. */
function dotsOf({ lines, keys: heads, values }) {
  const unit = unitIn({ values });
  return lines.flatMap(({ keys, values: cells, letter }, row) =>
    cells.flatMap(({ median, range }, i) =>
      unitOf(values[i]) === unit && median > 0
        ? [
            {
              row,
              label: [...keys.map((key, k) => named(heads[k], key)), letter]
                .filter(Boolean)
                .join(' · '),
              series: values[i] === unit ? 'time' : values[i].replace(/, m?s$/, ''),
              median,
              low: range[0],
              high: range[1],
            },
          ]
        : [],
    ),
  );
}

/** Draws a chart in one of the sizes. */
function draw(table, dots, series, { width, row, marginLeft }) {
  const rows = [...new Map(dots.map((dot) => [dot.row, dot])).values()];
  const above = marginLeft < 100;
  const labels = { y: 'row', text: 'label', fill: 'currentColor' };
  const chart = Plot.plot({
    document,
    width,
    height: row * rows.length + 54,
    marginLeft,
    marginRight: 30,
    marginTop: above ? 18 : 8,
    marginBottom: 42,
    ariaLabel: `${table.title}: a chart of the times in the table below`,
    style: { fontFamily: 'inherit', fontSize: '13px', color: 'inherit', background: 'none' },
    x: {
      type: 'log',
      label: unitIn(table) === 's' ? 'seconds' : 'milliseconds',
      labelArrow: 'none',
      labelAnchor: 'center',
      nice: true,
      grid: true,
      ticks: 5,
      tickFormat: (tick) => tick.toLocaleString('en-US'),
    },
    y: { axis: null, domain: rows.map((each) => each.row) },
    color: { domain: series, range: COLORS },
    symbol: { domain: series, range: SYMBOLS },
    marks: [
      above
        ? Plot.text(rows, {
            ...labels,
            frameAnchor: 'left',
            dx: -marginLeft,
            dy: -15,
            textAnchor: 'start',
          })
        : Plot.text(rows, { ...labels, frameAnchor: 'left', dx: -10, textAnchor: 'end' }),
      Plot.ruleY(dots, { x1: 'low', x2: 'high', y: 'row', stroke: 'series', strokeWidth: 2 }),
      Plot.dot(dots, { x: 'median', y: 'row', fill: 'series', symbol: 'series', r: 4.5 }),
    ],
  });
  chart.setAttribute('role', 'img');
  // A picture has one name; those of its parts would be read as well.
  for (const part of chart.querySelectorAll('[aria-label]')) part.removeAttribute('aria-label');
  return chart.outerHTML;
}

function chartsOf(table) {
  const dots = dotsOf(table);
  const series = [...new Set(dots.map((dot) => dot.series))];
  const legend = series.map((name, i) => ({ name, color: COLORS[i], symbol: SYMBOLS[i] }));
  return {
    wide: draw(table, dots, series, SIZES.wide),
    narrow: draw(table, dots, series, SIZES.narrow),
    legend: series.length > 1 ? legend : [],
  };
}

/** Marks what is code in the words of a file of results. */
const withCode = (text) =>
  text
    .replaceAll('&', '&amp;')
    .replaceAll('<', '&lt;')
    .replace(/`([^`]+)`/g, '<code>$1</code>');

export default () =>
  tables().map((table) => ({ ...table, about: withCode(table.about), ...chartsOf(table) }));
