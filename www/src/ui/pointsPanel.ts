import type { Backend } from 'gdel-wasm';
import type { Dimension } from '../geometry/dimension';
import { DISTRIBUTIONS, filesSource, SAMPLES, type Sample } from '../model/source';
import type { Page, Part } from '../page';
import { generator } from '../settings';
import { byId, count, create, radios } from './dom';

/** The pictures of the gallery; scripts/gallery.mjs makes them. */
const PICTURES = import.meta.glob<string>('../gallery/*.webp', {
  eager: true,
  query: '?url',
  import: 'default',
});

const QUICK = [1_000, 10_000, 100_000, 1_000_000];

/** The panel with the samples, the generators, the file button and the choice of backend. */
export function pointsPanel(page: Page): Part {
  const samples = (Object.keys(SAMPLES) as Sample[]).map((name) => {
    const { title, points } = SAMPLES[name];
    const picture = PICTURES[`../gallery/${name}.webp`];
    const button = create('button', { type: 'button', title: `${title}: ${count(points)} points` });
    if (picture) {
      const image = create('img', { src: picture, alt: '', width: 240, height: 180 });
      image.loading = 'lazy';
      button.append(image, title);
    } else {
      button.append(title, create('small', {}, `${count(points)} points, 3 MB`));
    }
    button.addEventListener('click', () =>
      page.run({ kind: 'sample', dimension: 3, sample: name }),
    );
    const item = create('li', {}, button);
    item.classList.toggle('wide', !picture);
    return { name, button, item };
  });
  byId('gallery').append(...samples.map(({ item }) => item));

  const distribution = byId<HTMLSelectElement>('distribution');
  const number = byId<HTMLInputElement>('number');
  const seed = byId<HTMLInputElement>('seed');
  const generate = () =>
    page.run(
      generator(
        page.settings.source.dimension,
        distribution.value,
        number.valueAsNumber,
        seed.valueAsNumber,
      ),
    );
  byId<HTMLFormElement>('generator').addEventListener('submit', (event) => {
    event.preventDefault();
    generate();
  });
  byId('quick').append(
    ...QUICK.map((n) => {
      const button = create('button', { type: 'button' }, count(n));
      button.addEventListener('click', () => (number.value = String(n)));
      return button;
    }),
  );

  const file = byId<HTMLInputElement>('file');
  byId('open').addEventListener('click', () => file.click());
  file.addEventListener('change', () => {
    if (file.files?.length) page.run(filesSource([...file.files], page.settings.source.dimension));
    // The same file again is a change, too.
    file.value = '';
  });

  const backends = radios('backend', (backend) => {
    const { source, edits } = page.settings;
    page.run(source, { backend: backend as Backend, edits });
  });

  let offered: Dimension | null = null;
  /** The distributions of the dimension. */
  const offer = (dimension: Dimension) => {
    if (dimension === offered) return;
    offered = dimension;
    distribution.replaceChildren(
      ...Object.entries(DISTRIBUTIONS[dimension]).map(([value, title]) =>
        create('option', { value }, title),
      ),
    );
    number.value = dimension === 3 ? '100000' : '1000';
  };

  return {
    ran() {
      // What was asked for in a link, and is the way to go on in 2D, is in sight.
      if (page.settings.source.kind === 'generator')
        byId<HTMLDetailsElement>('fold-generate').open = true;
    },
    changed({ source, backend }) {
      offer(source.dimension);
      for (const { name, button } of samples) {
        button.setAttribute(
          'aria-pressed',
          String(source.kind === 'sample' && source.sample === name),
        );
      }
      if (source.kind === 'generator' && source.count > 0) {
        distribution.value = source.distribution;
        number.value = String(source.count);
        seed.value = String(source.seed);
      }
      for (const radio of backends) {
        radio.checked = radio.value === backend;
        radio.disabled = radio.value === 'gpu' && page.hasGpu === false;
      }
      byId('backend-note').hidden = page.hasGpu !== false;
    },
  };
}
