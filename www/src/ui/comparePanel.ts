import { type Time, timesChart } from '../charts/times';
import { runOther } from '../compare/other';
import type { Page, Part } from '../page';
import { byId, count, create, duration, simplices } from './dom';
import { nameOf } from './result';

/** The panel that runs the same points with other libraries, and the one that proves the mesh. */
export function comparePanel(page: Page): Part {
  byId('compare-run').addEventListener('click', () => void compare(page));
  byId('verify-run').addEventListener('click', () => void prove(page));
  const forget = () => {
    abort?.abort();
    byId('times').replaceChildren();
    byId('times-note').textContent = '';
    byId('verdicts').replaceChildren();
    byId('verify-note').textContent = '';
  };
  return { ran: forget, edited: forget };
}

let abort: AbortController | null = null;

async function compare(page: Page): Promise<void> {
  const button = byId<HTMLButtonElement>('compare-run');
  if (abort) {
    abort.abort();
    return;
  }
  const { signal } = (abort = new AbortController());
  signal.addEventListener('abort', () => page.model.cancel());
  const { dimension, simplices: expected } = page.summary!;
  const other = dimension === 3 ? 'qhull-wasm' : 'delaunator';
  const times: Time[] = [];
  const notes: string[] = [];
  const add = async (time: Time, note: string) => {
    times.push(time);
    notes.push(note);
    byId('times').replaceChildren(await timesChart(times));
    byId('times-note').textContent = notes.join(' ');
  };
  const agree = (name: string, found: number) =>
    found === expected
      ? `${name}: ${simplices(found, dimension)}, as many.`
      : `${name}: ${simplices(found, dimension)}, not ${count(expected)}.`;

  button.textContent = 'Stop';
  try {
    const { adapter } = await page.model.info();
    for (const [backend, name] of [
      ['gpu', 'GPU backend'],
      ['cpu', 'CPU backend'],
    ] as const) {
      if (backend === 'gpu' && adapter?.software) {
        notes.push(
          `GPU backend: left out, because the adapter is only software (${nameOf(adapter)}).`,
        );
        continue;
      }
      say(`Running the ${name} …`);
      try {
        const { milliseconds, simplices: found } = await page.model.time(backend);
        await add({ name, milliseconds, ours: true }, agree(name, found));
      } catch (error) {
        if (signal.aborted) throw error;
        notes.push(`${name}: ${(error as Error).message}`);
      }
    }
    say(
      `Running ${other}${dimension === 3 ? ', which takes seconds for 100,000 points and almost a minute for a million' : ''} …`,
    );
    const theirs = await runOther(other, await page.model.points(), signal);
    const flat = theirs.flat
      ? ` ${count(theirs.flat)} of them have no ${dimension === 3 ? 'volume' : 'area'}.`
      : '';
    await add(
      { name: other, milliseconds: theirs.milliseconds, ours: false },
      agree(other, theirs.simplices) + flat,
    );
    const fastest = times
      .filter(({ ours }) => ours)
      .sort((a, b) => a.milliseconds - b.milliseconds)[0];
    if (fastest)
      notes.push(
        `${other} took ${(theirs.milliseconds / fastest.milliseconds).toFixed(1)} times as long as the ${fastest.name}.`,
      );
    byId('times-note').textContent = notes.join(' ');
  } catch (error) {
    notes.push(signal.aborted ? 'Stopped.' : `${other}: ${(error as Error).message}`);
    byId('times-note').textContent = notes.join(' ');
  } finally {
    abort = null;
    button.textContent = 'Run the comparison';
    say('');
  }
}

function say(text: string): void {
  byId('compare-status').textContent = text;
}

async function prove(page: Page): Promise<void> {
  const button = byId<HTMLButtonElement>('verify-run');
  const note = byId('verify-note');
  button.disabled = true;
  note.textContent = 'Checking …';
  const started = performance.now();
  try {
    const checks = await page.model.verify();
    byId('verdicts').replaceChildren(
      ...checks.map(({ name, passed, detail }) => {
        const verdict = create('li', { className: passed ? 'pass' : 'fail' });
        verdict.append(
          create(
            'span',
            {},
            create('span', { className: 'hidden' }, passed ? 'Passed: ' : 'Failed: '),
            detail ? `${name}: ${detail}` : name,
          ),
        );
        return verdict;
      }),
    );
    const all = checks.every(({ passed }) => passed);
    note.textContent = `${all ? 'Proven' : 'Not proven'} in ${duration(performance.now() - started)}.`;
  } catch (error) {
    note.textContent = (error as Error).message;
  } finally {
    button.disabled = false;
  }
}
