import { type Distribution, DISTRIBUTIONS, type Sample, SAMPLES } from '../model/source';
import type { Page, Part } from '../page';
import { byId, count, create } from './dom';

const QUICK = [1_000, 10_000, 100_000, 1_000_000];

/** The panel with the samples, the generators, the file button and the choice of engine. */
export function pointsPanel(page: Page): Part {
  const samples = Object.entries(SAMPLES).map(([name, { title, points }]) => {
    const button = create('button', { type: 'button' }, title, create('small', {}, `${count(points)} points`));
    button.addEventListener('click', () => page.run({ kind: 'sample', sample: name as Sample }));
    return { name, button };
  });
  byId('samples').append(...samples.map(({ button }) => button));

  const distribution = byId<HTMLSelectElement>('distribution');
  distribution.append(...Object.entries(DISTRIBUTIONS).map(([value, title]) => create('option', { value }, title)));
  const number = byId<HTMLInputElement>('number');
  const seed = byId<HTMLInputElement>('seed');
  const generate = () =>
    page.run({
      kind: 'generator',
      distribution: distribution.value as Distribution,
      count: number.valueAsNumber,
      seed: seed.valueAsNumber,
    });
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
    if (file.files?.[0]) page.run({ kind: 'file', file: file.files[0] });
    // The same file again is a change, too.
    file.value = '';
  });

  const engines = [...document.querySelectorAll<HTMLInputElement>('input[name=engine]')];
  for (const radio of engines) {
    radio.addEventListener('change', () => {
      page.settings.engine = radio.value as typeof page.settings.engine;
      page.run(page.settings.source);
    });
  }

  return {
    changed({ source, engine }) {
      for (const { name, button } of samples) {
        button.setAttribute('aria-pressed', String(source.kind === 'sample' && source.sample === name));
      }
      if (source.kind === 'generator') {
        distribution.value = source.distribution;
        number.value = String(source.count);
        seed.value = String(source.seed);
      }
      for (const radio of engines) radio.checked = radio.value === engine;
    },
  };
}
