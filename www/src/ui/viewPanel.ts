import type { Filter } from '../geometry/filter';
import type { ColorBy } from '../geometry/scale';
import { MOST_PIECES } from '../model/model';
import type { Dimension } from '../model/source';
import type { Page, Part } from '../page';
import { colorsIn, LAYERS, type Layer, type Settings, type Up } from '../settings';
import { COLOR_MAPS, type ColorMapName } from '../view/colormap';
import { byId, count, create, measured, radios } from './dom';
import { QUANTITIES } from './legend';

/** What the layers of space and those of the plane are called. */
const LAYER_NAMES: Record<Dimension, Partial<Record<Layer, string>>> = {
  3: {
    simplices: 'Tetrahedra',
    edges: 'Edges',
    points: 'Points where nothing else is',
    hull: 'Convex hull',
    facets: 'Non-Delaunay facets after Phase 1',
  },
  2: {
    simplices: 'Triangles, filled',
    edges: 'Delaunay edges',
    voronoi: 'Voronoi diagram',
    hull: 'Convex hull',
    points: 'Points',
  },
};

const FILTER_NOTES: Record<Dimension, Record<Filter['kind'], string>> = {
  3: {
    all: 'Every tetrahedron. Together they fill the convex hull.',
    carve:
      'Carved from outside with a ball of radius α. Of a scanned surface, this leaves the solid.',
    alpha: 'Only tetrahedra with a circumradius of at most α.',
  },
  2: {
    all: 'Every triangle. Together they fill the convex hull.',
    carve: '',
    alpha: 'Only triangles with a circumradius of at most α.',
  },
};

const NORMALS: Record<string, Settings['normal']> = {
  X: [1, 0, 0],
  Y: [0, 1, 0],
  Z: [0, 0, 1],
  '−X': [-1, 0, 0],
  '−Y': [0, -1, 0],
  '−Z': [0, 0, -1],
};

/** The panel that says how the mesh is drawn, and the slider for the plane on the stage. */
export function viewPanel(page: Page): Part {
  const color = byId<HTMLSelectElement>('color');
  color.addEventListener('change', () => page.change({ color: color.value as ColorBy }));

  const map = byId<HTMLSelectElement>('map');
  map.append(...Object.keys(COLOR_MAPS).map((value) => create('option', { value }, value)));
  map.addEventListener('change', () => page.change({ map: map.value as ColorMapName }));

  const keep = byId<HTMLInputElement>('keep');
  keep.addEventListener('input', () => page.change({ keep: keep.valueAsNumber }));

  const normals = Object.entries(NORMALS).map(([title, normal]) => {
    const radio = create('input', { type: 'radio', name: 'normal', value: title });
    radio.addEventListener('change', () => page.change({ normal }));
    byId('normals').append(create('label', {}, radio, create('span', {}, title)));
    return { radio, normal };
  });
  byId('face').addEventListener(
    'click',
    () => page.viewer && page.change({ normal: page.viewer.towardsCamera }),
  );

  const ups = radios('up', (up) => page.change({ up: up as Up }));
  const filters = radios('filter', (filter) => page.change({ filter: filter as Filter['kind'] }));
  const alpha = byId<HTMLInputElement>('alpha');
  alpha.addEventListener('input', () => page.change({ alpha: alphaAt(alpha.valueAsNumber, page) }));

  const apart = byId<HTMLInputElement>('apart');
  apart.addEventListener('input', () => page.change({ apart: apart.valueAsNumber }));

  const layers = LAYERS.map((layer) => {
    const box = create('input', { type: 'checkbox' });
    box.addEventListener('change', () =>
      page.change({ layers: { ...page.settings.layers, [layer]: box.checked } }),
    );
    return { layer, box };
  });

  let offered: Dimension | null = null;
  /** What there is in the dimension. */
  const offer = (dimension: Dimension) => {
    if (dimension === offered) return;
    offered = dimension;
    color.replaceChildren(
      ...colorsIn(dimension).map((value) =>
        create('option', { value }, QUANTITIES[value][dimension][0]),
      ),
    );
    const names = LAYER_NAMES[dimension];
    const offers = Object.keys(names) as Layer[];
    byId('layers').replaceChildren(
      ...offers.map((layer) =>
        create('label', {}, layers.find((each) => each.layer === layer)!.box, names[layer]!),
      ),
    );
  };

  const changed = (settings: Settings) => {
    const { dimension } = settings.source;
    offer(dimension);
    color.value = settings.color;
    map.value = settings.map;
    keep.value = String(settings.keep);
    for (const { radio, normal } of normals)
      radio.checked = normal.join() === settings.normal.join();
    for (const radio of filters) radio.checked = radio.value === settings.filter;
    for (const radio of ups) radio.checked = radio.value === settings.up;
    byId('filter-note').textContent = FILTER_NOTES[dimension][settings.filter];
    alpha.disabled = settings.filter === 'all';
    if (page.summary) {
      const value = settings.alpha ?? page.summary.alpha.typical;
      alpha.value = String(positionOf(value, page));
      byId('alpha-value').textContent = settings.filter === 'all' ? '' : measured(value);
    }
    apart.value = String(settings.apart);
    for (const { layer, box } of layers) box.checked = settings.layers[layer];
  };

  return {
    changed,
    ran: () => changed(page.settings),
    drew({ pieces, shown }) {
      byId('apart-note').textContent =
        pieces && pieces.owners.length < shown
          ? `The outermost ${count(pieces.owners.length)} of ${count(shown)} are drawn: at most ${count(MOST_PIECES)} at a time.`
          : '';
    },
  };
}

// The slider is logarithmic: radii span orders of magnitude.
function alphaAt(position: number, { summary }: Page): number {
  const [low, high] = summary!.alpha.range;
  return low * (high / low) ** position;
}

function positionOf(value: number, { summary }: Page): number {
  const [low, high] = summary!.alpha.range;
  return high > low ? Math.log(value / low) / Math.log(high / low) : 0;
}
