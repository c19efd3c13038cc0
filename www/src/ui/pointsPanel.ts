import type { Backend } from 'gdel-wasm';
import { DISTRIBUTIONS, type Dimension, SAMPLES, type Sample } from '../model/source';
import type { Page, Part } from '../page';
import { generator } from '../settings';
import { byId, count, create, radios } from './dom';

const QUICK = [1_000, 10_000, 100_000, 1_000_000];

/** The panel with the samples, the generators, the file button and the choice of backend. */
export function pointsPanel(page: Page): Part {
  const samples = Object.entries(SAMPLES).map(([name, { title, points }]) => {
    const button = create(
      'button',
      { type: 'button' },
      title,
      create('small', {}, `${count(points)} points`),
    );
    button.addEventListener('click', () =>
      page.run({ kind: 'sample', dimension: 3, sample: name as Sample }),
    );
    return { name, button };
  });
  byId('samples').append(...samples.map(({ button }) => button));

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
    if (file.files?.[0])
      page.run({ kind: 'file', dimension: page.settings.source.dimension, file: file.files[0] });
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
