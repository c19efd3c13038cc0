import type { ColorSource } from 'gdel-wasm';
import type { Dimension } from '../geometry/dimension';
import type { FilterKind } from '../geometry/filter';
import type { ColorBy } from '../geometry/scale';
import { UPS } from '../geometry/up';
import type { Page, Part } from '../page';
import { colorsIn, LAYERS, type Layer, type Settings } from '../settings';
import { COLOR_MAPS, type ColorMapName } from '../view/colormap';
import { byId, create, radios } from './dom';
import { QUANTITIES } from './legend';
import { whyNotRecord } from './runPanel';

/** The names of the layers in 3D and 2D. */
const LAYER_NAMES: Record<Dimension, Partial<Record<Layer, string>>> = {
  3: {
    simplices: 'Tetrahedra',
    skin: 'Plain outside',
    edges: 'Edges',
    points: 'Points that are cut away',
    hull: 'Convex hull',
    facets: 'Non-Delaunay facets after Phase 1',
  },
  2: {
    simplices: 'Triangles, filled',
    skin: 'Colours of the file',
    edges: 'Delaunay edges',
    hull: 'Convex hull',
    points: 'Points',
  },
};

/** What the outside looks like, by where the colours come from. */
const SKINS: Record<ColorSource | 'none', string> = {
  rgb: 'Outside in the file’s colours',
  intensity: 'Outside coloured by intensity',
  normals: 'Outside coloured by normals',
  none: 'Plain outside',
};

const FILTER_NOTES: Record<Dimension, Record<FilterKind, string>> = {
  3: {
    all: 'Every tetrahedron. Together they fill the convex hull.',
    surface:
      'The solid inside the closed surface that the points were taken from. Needs no radius.',
    carve: 'Carved from outside with a ball of radius α. Of a scanned surface, the solid remains.',
    alpha: 'Only tetrahedra with a circumradius of at most α.',
  },
  2: {
    all: 'Every triangle. Together they fill the convex hull.',
    surface: '',
    carve: '',
    alpha: 'Only triangles with a circumradius of at most α.',
  },
};

/** What the layer of the hull shows. */
const hullName = (dimension: Dimension, { summary }: Page) =>
  dimension === 2 && summary?.given !== undefined
    ? 'Sides of polygons, and lines'
    : LAYER_NAMES[dimension].hull!;

const NORMALS: Record<string, NonNullable<Settings['normal']>> = {
  X: [1, 0, 0],
  Y: [0, 1, 0],
  Z: [0, 0, 1],
  '−X': [-1, 0, 0],
  '−Y': [0, -1, 0],
  '−Z': [0, 0, -1],
};

/** The panel that says how the mesh is drawn and cut. */
export function viewPanel(page: Page): Part {
  const color = byId<HTMLSelectElement>('color');
  color.addEventListener('change', () =>
    // What was chosen is to be seen, outside as well.
    page.change({
      color: color.value as ColorBy,
      layers: { ...page.settings.layers, skin: false },
    }),
  );

  const map = byId<HTMLSelectElement>('map');
  map.append(...Object.keys(COLOR_MAPS).map((value) => create('option', { value }, value)));
  map.addEventListener('change', () => page.change({ map: map.value as ColorMapName }));

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

  const ups = UPS.map((up) => {
    const radio = create('input', { type: 'radio', name: 'up', value: up });
    radio.addEventListener('change', () => page.change({ up, normal: null }));
    const title = up.replace('-', '−').toUpperCase();
    byId('ups').append(create('label', {}, radio, create('span', {}, title)));
    return radio;
  });
  const filters = radios('filter', (filter) => page.change({ filter: filter as FilterKind }));
  const layers = LAYERS.map((layer) => {
    const box = create('input', { type: 'checkbox' });
    box.addEventListener('change', () =>
      page.change({ layers: { ...page.settings.layers, [layer]: box.checked } }),
    );
    return { layer, box, name: create('span') };
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
    byId('layers').replaceChildren(
      ...(Object.keys(names) as Layer[]).map((layer) => {
        const { box, name } = layers.find((each) => each.layer === layer)!;
        name.textContent = names[layer]!;
        return create('label', {}, box, name);
      }),
    );
  };

  const changed = (settings: Settings) => {
    const { dimension } = settings.source;
    offer(dimension);
    color.value = settings.color;
    const phase = color.querySelector<HTMLOptionElement>('[value=phase]');
    if (phase) {
      const why = page.summary && !page.summary.trace ? whyNotRecord(page) : null;
      phase.disabled = why !== null;
      phase.title = why ?? '';
    }
    map.value = settings.map;
    const { normal: along, up } = page.view;
    for (const { radio, normal } of normals)
      radio.checked = normal.every((x, axis) => x === along[axis]);
    for (const radio of filters) radio.checked = radio.value === settings.filter;
    for (const radio of ups) radio.checked = radio.value === up;
    byId('filter-note').textContent = FILTER_NOTES[dimension][settings.filter];
    const { colorSource = null } = page.summary ?? {};
    for (const { layer, box, name } of layers) {
      box.checked = settings.layers[layer];
      if (layer === 'hull') name.textContent = hullName(dimension, page);
      if (layer !== 'skin') continue;
      if (dimension === 3) name.textContent = SKINS[colorSource ?? 'none'];
      box.disabled = dimension === 2 && colorSource === null;
      box.title = box.disabled ? 'These points have no colours of their own.' : '';
    }
  };

  return { changed, ran: () => changed(page.settings) };
}
