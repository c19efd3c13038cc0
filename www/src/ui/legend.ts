import type { Drawing } from '../model/model';
import type { ColorBy } from '../geometry/scale';
import { type ColorMapName, gradient, PHASE_COLORS } from '../view/colormap';
import { byId, count, measured } from './dom';

export const QUANTITIES: Record<ColorBy, string> = {
  quality: 'Radius ratio',
  volume: 'Volume',
  circumradius: 'Circumradius',
  phase: 'Phase of creation',
};

const UNITS: Record<ColorBy, string> = {
  quality: '3 r/R, 1 is regular',
  volume: 'file units³',
  circumradius: 'file units',
  phase: '',
};

/** What the colours mean, and how much of the mesh is to be seen. */
export function showLegend({ scale, shown, total, leftOut, milliseconds }: Drawing, map: ColorMapName): void {
  byId('legend').hidden = total === 0;
  const unit = UNITS[scale.by];
  byId('legend-title').textContent = QUANTITIES[scale.by] + (unit && `, ${unit}`);
  const [low, high] = scale.domain;
  const phases = scale.kind === 'phases';
  byId('ramp').style.background = phases
    ? `linear-gradient(to right, ${PHASE_COLORS[0]} 50%, ${PHASE_COLORS[1]} 50%)`
    : gradient(map);
  byId('legend-low').textContent = phases ? '1: inserted, flipped' : measured(low);
  byId('legend-high').textContent = phases ? '2: splayed' : measured(high);
  byId('shown').title = `${milliseconds.toFixed(1)} ms to cut`;
  const missing = leftOut > 0 ? `, ${count(leftOut)} facets left out` : '';
  byId('shown').textContent = (shown === total ? `all ${count(total)} shown` : `${count(shown)} of ${count(total)} shown`) + missing;
}
