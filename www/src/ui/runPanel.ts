import { breakdownChart, type Run } from '../charts/breakdown';
import { roundsChart, timelineChart } from '../charts/rounds';
import { MAX_POINTS_TO_RECORD, type Summary } from '../model/model';
import { titleOf } from '../model/source';
import type { Page, Part } from '../page';
import { byId, count, create } from './dom';
import { phasesOf } from './phases';
import { repairOf } from './repair';

/** At most so many runs stand side by side in the breakdown. */
const RUNS = 6;

/** The panel that explains the last run. */
export function runPanel(page: Page): Part {
  const runs: Run[] = [];
  const stepper = stepMode(page);
  const shade = byId<HTMLInputElement>('shade');
  shade.addEventListener('change', () =>
    page.change({ layers: { ...page.settings.layers, facets: shade.checked } }),
  );

  /** Charts wait until somebody looks: their library is as large as the rest of the page. */
  let charted = true;
  const chart = async () => {
    if (charted || byId('run').hidden) return;
    charted = true;
    const rounds = page.summary?.stats.gpu?.rounds ?? [];
    byId('breakdown').replaceChildren(await breakdownChart(runs));
    byId('rounds-section').hidden = rounds.length === 0;
    if (rounds.length > 0)
      byId('rounds-chart').replaceChildren(await roundsChart(rounds), await timelineChart(rounds));
  };

  const ran = (summary: Summary) => {
    stepper(summary);
    showFigures(summary);
    showRepair(page);
    const title = `${titleOf(page.settings.source)}, ${count(summary.points)}, ${summary.stats.backend.toUpperCase()}`;
    const again = runs.findIndex((run) => run.title === title);
    if (again >= 0) runs.splice(again, 1);
    runs.unshift({ title, phases: phasesOf(summary.stats) });
    runs.length = Math.min(runs.length, RUNS);
    charted = false;
  };
  return {
    ran,
    edited: ran,
    // Follows every run; of changes by hand in a row, the last.
    changed({ layers }) {
      shade.checked = layers.facets;
      if (page.summary) showRepair(page);
      void chart();
    },
    showed: () => void chart(),
  };
}

function showFigures({
  dimension,
  points,
  duplicates,
  simplices,
  hullFacets,
  stats,
}: Summary): void {
  const { gpu, splay, exact } = stats;
  const rows: [string, number | null | undefined][] = [
    ['Points', points],
    ['of them exact duplicates', duplicates],
    [dimension === 3 ? 'Tetrahedra' : 'Triangles', simplices],
    [dimension === 3 ? 'Triangles of the hull' : 'Edges of the hull', hullFacets],
    ['Rounds of Phase 1', gpu?.rounds.length],
    ['Flips', gpu && gpu.flips23 + gpu.flips32],
    ['Failed vertices', gpu?.failedVertices],
    ['Stars built for them', splay?.built],
    ['Stars pulled in as well', splay?.pulled],
    ['Signs decided by exact integers', exact.integer],
    ['by expansions', exact.expansion],
    ['by the symbolic perturbation', exact.symbolic],
  ];
  byId('figures').replaceChildren(
    ...rows
      .filter(([, value]) => value != null)
      .map(([name, value]) =>
        create('tr', {}, create('th', { scope: 'row' }, name), create('td', {}, count(value!))),
      ),
  );
}

/** Why a run of these points cannot be recorded, in a sentence; null where it can. */
export function whyNotRecord({ summary, hasGpu, settings }: Page): string | null {
  if (!summary || summary.dimension === 2) return 'Only runs in 3D can be recorded.';
  if (hasGpu === false)
    return 'Runs are recorded on the GPU, and this browser offers none through WebGPU.';
  if (settings.weights) return 'Points with weights are triangulated by the CPU.';
  if (summary.points > MAX_POINTS_TO_RECORD)
    return `Runs of up to ${count(MAX_POINTS_TO_RECORD)} points can be recorded.`;
  return null;
}

/** Records a run of a few points on which much happens. Resolves to whether it did. */
export async function recordFew(page: Page): Promise<boolean> {
  const few = { kind: 'generator', dimension: 3, distribution: 'thin-sphere' } as const;
  return (await page.run({ ...few, count: 3_000, seed: 1 })) && (await page.record());
}

function showRepair(page: Page): void {
  const { trace } = page.summary!;
  const why = whyNotRecord(page);
  for (const id of ['record', 'record-few'])
    byId<HTMLButtonElement>(id).disabled = page.hasGpu === false;
  byId<HTMLButtonElement>('record').hidden = why !== null && page.hasGpu !== false;
  byId('record-section').hidden = trace !== null;
  byId('recorded').hidden = trace === null;
  if (!trace) {
    byId('repair').textContent =
      'Phase 1 flips in parallel on the GPU and gets stuck in a few places, which Phase 2 repairs by splaying stars. ' +
      (why ??
        'A recorded run shows these places, and every round on the way there. It takes several times as long.');
    return;
  }
  byId('repair').textContent = repairOf(trace, page.summary!);
}

/** The slider over the rounds of the trace. Returns what to do with a new mesh. */
function stepMode(page: Page): (summary: Summary) => void {
  const slider = byId<HTMLInputElement>('step');
  const label = byId('step-label');
  const play = byId<HTMLButtonElement>('play');
  let rounds = 0;
  let timer = 0;

  const to = (step: number) => {
    slider.value = String(step);
    label.textContent = step < rounds ? `After round ${step + 1} of ${rounds}` : 'The result';
    page.showRound(step < rounds ? step : null);
  };
  const stop = () => {
    clearInterval(timer);
    timer = 0;
    play.textContent = 'Play';
  };
  slider.addEventListener('input', () => {
    stop();
    to(slider.valueAsNumber);
  });
  play.addEventListener('click', () => {
    if (timer) return stop();
    play.textContent = 'Pause';
    if (slider.valueAsNumber >= rounds) to(0);
    timer = window.setInterval(() => {
      to(slider.valueAsNumber + 1);
      if (slider.valueAsNumber >= rounds) stop();
    }, 700);
  });
  byId('record').addEventListener('click', () => page.record());
  byId('record-few').addEventListener('click', () => recordFew(page));

  return ({ trace }) => {
    stop();
    rounds = trace?.rounds ?? 0;
    slider.max = String(rounds);
    slider.value = String(rounds);
    label.textContent = 'The result';
  };
}
