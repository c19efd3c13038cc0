import { MAX_CELLS } from '../model/model';
import type { Page, Part } from '../page';
import type { Settings } from '../settings';
import { byId, count, measured, radios } from './dom';

/** What the slider under the drawing changes. */
type Mode = 'solid' | 'slice' | 'explode';

/**
 * The controls under the drawing: how much the ball carves away, how much the plane cuts off, and
 * how far the tetrahedra are apart. One slider shows at a time.
 */
export function dock(page: Page): Part {
  const box = byId('dock');
  let mode: Mode = 'slice';
  const modes = radios('mode', (value) => {
    mode = value as Mode;
    changed(page.settings);
  });

  const keep = byId<HTMLInputElement>('keep');
  keep.addEventListener('input', () => page.change({ keep: keep.valueAsNumber }));

  const alpha = byId<HTMLInputElement>('alpha');
  alpha.addEventListener('input', () => {
    const range = page.lastDrawing?.alpha?.range;
    if (alpha.valueAsNumber === 1) page.change({ filter: 'all', alpha: null });
    else if (range) page.change({ alpha: alphaAt(alpha.valueAsNumber, range) });
    // From all tetrahedra to those that suit; from there, the slider goes on.
    else page.change({ filter: page.settings.source.dimension === 3 ? 'carve' : 'alpha' });
  });

  const apart = byId<HTMLInputElement>('apart');
  apart.addEventListener('input', () => page.change({ apart: apart.valueAsNumber }));

  const voronoi = byId<HTMLInputElement>('voronoi');
  voronoi.addEventListener('change', () =>
    page.change({ layers: { ...page.settings.layers, voronoi: voronoi.checked } }),
  );

  const changed = ({ source, filter, apart: distance, layers }: Settings) => {
    const flat = source.dimension === 2;
    voronoi.checked = layers.voronoi;
    voronoi.disabled = !flat && (page.summary?.points ?? 0) > MAX_CELLS;
    voronoi.parentElement!.title = voronoi.disabled
      ? `Voronoi cells are drawn for up to ${count(MAX_CELLS)} points.`
      : flat
        ? 'Draw the Voronoi diagram'
        : 'Draw Voronoi cells instead of tetrahedra';
    box.dataset.mode = flat ? (filter === 'alpha' ? 'solid' : '') : mode;
    for (const radio of modes) radio.checked = radio.value === mode;
    apart.value = String(distance);
  };

  return {
    changed,
    ran: () => changed(page.settings),
    drew({ pieces, shown, keep: kept, alpha: used }) {
      keep.value = String(kept);
      alpha.value = String(used ? positionOf(used.value, used.range) : 1);
      byId('alpha-value').textContent = used ? `α = ${measured(used.value)}` : 'everything';
      byId('apart-note').textContent =
        pieces && pieces.owners.length < shown
          ? `outermost ${count(pieces.owners.length)} of ${count(shown)}`
          : '';
    },
  };
}

// The slider is logarithmic: radii span orders of magnitude.
function alphaAt(position: number, [low, high]: [number, number]): number {
  return low * (high / low) ** position;
}

function positionOf(value: number, [low, high]: [number, number]): number {
  return high > low ? Math.log(value / low) / Math.log(high / low) : 0;
}
