import { type Time, timesChart } from '../charts/times';
import { runOther } from '../compare/other';
import type { Page, Part } from '../page';
import { byId, count, create, duration, measured, simplices } from './dom';
import { nameOf } from './result';

/** The panel that runs the same points with other libraries, and the one that proves the mesh. */
export function comparePanel(page: Page): Part {
  byId('compare-run').addEventListener('click', () => void compare(page));
  for (const id of ['verify-run', 'verify-here'])
    byId(id).addEventListener('click', () => void prove(page));
  const forget = () => {
    abort?.abort();
    proof++;
    byId('times').replaceChildren();
    byId('times-note').textContent = '';
    byId('verdicts').replaceChildren();
    byId('verify-note').textContent = '';
    byId('verify-here').textContent = 'Verify';
    byId('ratio').textContent = '';
  };
  return {
    ran: forget,
    edited: forget,
    lived(on) {
      forget();
      for (const id of ['compare-run', 'verify-run', 'verify-here']) {
        const button = byId<HTMLButtonElement>(id);
        button.disabled = on;
        button.title = on ? 'Not while the points move.' : '';
      }
    },
  };
}

let abort: AbortController | null = null;

/** Counts the meshes and the proofs: what is found out about an earlier mesh is not said of the next. */
let proof = 0;

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
      ? `${name}: ${simplices(found, dimension)}, the same number.`
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
    if (fastest) {
      const ratio = theirs.milliseconds / fastest.milliseconds;
      byId('ratio').textContent = `${measured(ratio)} × ${other}’s speed`;
      notes.push(`${other} took ${ratio.toFixed(1)} times as long as the ${fastest.name}.`);
    }
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

/** What each check proves, in words. */
const CHECKS: Record<string, string> = {
  dimension: 'The points span as many dimensions as stated',
  duplicates: 'Points in one place are counted once',
  indices: 'Every index names a point',
  vertices: 'Every distinct point is a vertex',
  orientation: 'No cell is flat or turned inside out',
  facets: 'No facet belongs to more than two cells',
  neighbors: 'Neighbours name each other',
  delaunay: 'No circumsphere has a point inside',
  'canonical-ties': 'Ties are broken by the order of the points',
  hull: 'The hull bounds the cells',
  'hull-closed': 'The hull is closed',
  'hull-convex': 'The hull is convex',
  'euler-characteristic': 'The mesh has no holes',
  hidden: 'Hidden points are covered by heavier ones',
  covering: 'The cells fill the hull without overlap',
  constraints: 'Constraints are edges',
};

function verdictOf(name: string, passed: boolean, detail: string): string {
  const claim = CHECKS[name] ?? name;
  return passed || !detail ? claim : `${claim}: no, ${detail}`;
}

async function prove(page: Page): Promise<void> {
  const buttons = ['verify-run', 'verify-here'].map((id) => byId<HTMLButtonElement>(id));
  const here = buttons[1];
  const note = byId('verify-note');
  const mine = ++proof;
  for (const button of buttons) button.disabled = true;
  here.textContent = 'Checking …';
  note.textContent = 'Checking …';
  const started = performance.now();
  try {
    const checks = await page.model.verify();
    if (mine !== proof) return;
    byId('verdicts').replaceChildren(
      ...checks.map(({ name, passed, detail }) => {
        const verdict = create('li', { className: passed ? 'pass' : 'fail' });
        verdict.append(
          create(
            'span',
            {},
            create('span', { className: 'hidden' }, passed ? 'Passed: ' : 'Failed: '),
            verdictOf(name, passed, detail),
          ),
        );
        return verdict;
      }),
    );
    const all = checks.every(({ passed }) => passed);
    here.textContent = all ? '✓ Proven' : '✕ Not proven';
    note.textContent = `${all ? 'Proven' : 'Not proven'} in ${duration(performance.now() - started)}.`;
  } catch (error) {
    if (mine !== proof) return;
    here.textContent = 'Verify';
    note.textContent = (error as Error).message;
  } finally {
    for (const button of buttons) button.disabled = page.live;
  }
}
