import { MAX_CELLS } from '../model/model';
import type { Page, Part } from '../page';
import type { Settings } from '../settings';
import { byId, count, measured, radios } from './dom';

/** What the slider under the drawing changes. */
type Mode = 'solid' | 'slice' | 'explode';

/** What Auto chooses. */
const ALPHA_SUITS =
  'The radius that suits: the smallest at which all points hang together in one solid';
const CARVING_SUITS =
  'The radius that suits: the smallest at which nearly all points hang together and the solid is closed';

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
    // Each position is a critical value, where more simplices come in, and the last one everything.
    const stops = page.lastDrawing?.alpha?.stops ?? [];
    if (page.settings.filter === 'surface') return toSolid();
    const at = Math.round(alpha.valueAsNumber * stops.length);
    if (at < stops.length) page.change({ alpha: stops[at] });
    else if (page.settings.filter !== 'all') page.change({ filter: 'all', alpha: null });
    // From all tetrahedra to those that suit; from there, the slider goes on.
    else if (alpha.valueAsNumber < 1) toSolid();
  });

  /** Shows the solid, with the alpha that suits. */
  const toSolid = () => {
    const { filter, source } = page.settings;
    const solid = source.dimension === 3 ? 'carve' : 'alpha';
    page.change({ filter: filter === 'all' || filter === 'surface' ? solid : filter, alpha: null });
  };
  const auto = byId<HTMLButtonElement>('alpha-auto');
  auto.addEventListener('click', toSolid);

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
    auto.title = filter === 'alpha' ? ALPHA_SUITS : CARVING_SUITS;
    box.dataset.mode = flat ? (filter === 'alpha' ? 'solid' : '') : mode;
    for (const radio of modes) radio.checked = radio.value === mode;
    apart.value = String(distance);
  };

  return {
    changed,
    ran: () => changed(page.settings),
    drew({ pieces, shown, keep: kept, alpha: used }) {
      keep.value = String(kept);
      const stops = used?.stops.length ?? 0;
      alpha.step = String(1 / (stops || 1000));
      // Until it is found, all is shown.
      const bounds = used !== null && used.value < Infinity;
      alpha.value = String(bounds && stops ? positionOf(used.value, used.stops) : 1);
      auto.setAttribute('aria-pressed', String(used?.isAuto ?? false));
      byId('alpha-value').textContent = bounds
        ? `α = ${measured(used.value)}`
        : page.settings.filter === 'surface'
          ? 'the surface'
          : 'everything';
      byId('apart-note').textContent =
        pieces && pieces.owners.length < shown
          ? `outermost ${count(pieces.owners.length)} of ${count(shown)}`
          : '';
    },
  };
}

/** The position of the last critical value that is not larger than alpha. */
function positionOf(value: number, stops: Float32Array): number {
  // Stops are rounded.
  const after = stops.findIndex((stop) => stop > Math.fround(value));
  return Math.max(0, (after < 0 ? stops.length : after) - 1) / stops.length;
}
