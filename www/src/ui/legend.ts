import type { Dimension } from '../geometry/dimension';
import type { ColorBy } from '../geometry/scale';
import type { Drawing } from '../model/model';
import type { Settings } from '../settings';
import { gradient, PHASE_COLORS } from '../view/colormap';
import { byId, count, measured } from './dom';

/** What a quantity is called, and in which units. */
export const QUANTITIES: Record<ColorBy, Record<Dimension, [name: string, unit: string]>> = {
  quality: {
    3: ['Radius ratio', '3 r/R, 1 is regular'],
    2: ['Radius ratio', '2 r/R, 1 is regular'],
  },
  volume: { 3: ['Volume', 'file units³'], 2: ['Area', 'file units²'] },
  circumradius: { 3: ['Circumradius', 'file units'], 2: ['Circumradius', 'file units'] },
  phase: { 3: ['Phase of creation', ''], 2: ['Phase of creation', ''] },
};

/** What the colours mean, and how much of the mesh is to be seen. */
export function showLegend(
  { scale, shown, total, leftOut, milliseconds, cells, open, round }: Drawing,
  { map, source, layers }: Settings,
  hasColors: boolean,
): void {
  const { dimension } = source;
  const isInside = layers.skin && dimension === 3 && !cells && round === null;
  const isCovered = layers.skin && dimension === 2 && hasColors;
  byId('legend').hidden =
    total === 0 || !layers.simplices || isCovered || Boolean(isInside && open);
  const [quantity, unit] = QUANTITIES[scale.by][dimension];
  const name = cells ? `${quantity} of the cell` : quantity;
  const title = isInside ? `Inside: ${name.toLowerCase()}` : name;
  byId('legend-title').textContent = [title, unit].filter(Boolean).join(', ');
  const [low, high] = scale.domain;
  const phases = scale.kind === 'phases';
  byId('ramp').style.background = phases
    ? `linear-gradient(to right, ${PHASE_COLORS[0]} 50%, ${PHASE_COLORS[1]} 50%)`
    : gradient(map);
  byId('legend-low').textContent = phases ? '1: inserted, flipped' : measured(low);
  byId('legend-high').textContent = phases ? '2: splayed' : measured(high);
  byId('shown').title = `${milliseconds.toFixed(1)} ms to cut`;
  const missing = leftOut > 0 ? `, ${count(leftOut)} facets left out` : '';
  byId('shown').textContent =
    (shown === total ? `all ${count(total)} shown` : `${count(shown)} of ${count(total)} shown`) +
    missing;
}
