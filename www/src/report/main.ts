import '@fontsource-variable/geist/wght.css';
import '@fontsource-variable/geist-mono/wght.css';
import '../styles/base.css';
import '../styles/panel.css';
import '../styles/report.css';
import { byId } from '../ui/dom';
import { wireTheme } from '../ui/theme';
import { blockOf, hashOf, issueOf, type Outcome } from './block';
import { measure } from './measure';

const COUNTS = [10_000, 100_000, 1_000_000];

const VERDICTS: Record<Outcome, string> = {
  right: 'Everything is right: the GPU and the CPU make the same meshes.',
  incomplete: 'Nothing is wrong, but not everything could be compared.',
  WRONG: 'This GPU, or its driver, computes wrongly. Please send the report.',
};

/** Returns the numbers of points that the address asks for: `?points=1000,5000`. */
function countsOf(search: string): number[] {
  const given = new URLSearchParams(search).get('points');
  const counts = (given ?? '')
    .split(',')
    .map(Number)
    .filter((n) => Number.isInteger(n) && n > 0);
  return counts.length ? counts.sort((a, b) => a - b) : COUNTS;
}

const state = byId('state');
const block = byId('block');
let controller: AbortController | undefined;

/** Shows a report, and puts it in the address. */
function show(text: string): void {
  block.textContent = text;
  byId('result').hidden = text === '';
  byId<HTMLAnchorElement>('issue').href = issueOf(import.meta.env.VITE_REPOSITORY, text);
}

function say(text: string, verdict = ''): void {
  state.textContent = text;
  state.dataset.verdict = verdict.toLowerCase();
}

async function run(): Promise<void> {
  controller = new AbortController();
  const lines: string[] = [];
  const add = (line: string) => {
    lines.push(line);
    show(lines.join('\n'));
    // Also of what is not done: a page that runs out of memory is loaded anew.
    history.replaceState(null, '', `#${hashOf(lines.join('\n'))}`);
  };
  byId('run').hidden = true;
  for (const id of ['stop', 'going']) byId(id).hidden = false;
  show('');
  say('Opening the GPU …');
  try {
    const outcome = await measure({
      counts: countsOf(location.search),
      signal: controller.signal,
      onLine: add,
      onStep(what, fraction) {
        byId<HTMLProgressElement>('progress').value = fraction;
        say(`${what} …`);
      },
    });
    add(`result: ${outcome}`);
    say(VERDICTS[outcome], outcome);
  } catch (error) {
    add('result: incomplete');
    if (controller.signal.aborted) say('Stopped.');
    else say(`It failed: ${error instanceof Error ? error.message : String(error)}`, 'wrong');
  }
  for (const id of ['stop', 'going']) byId(id).hidden = true;
  byId('run').textContent = 'Run it again';
  byId('run').hidden = false;
}

/** Shows the report that the address holds. */
function showAddress(): void {
  const text = blockOf(location.hash);
  if (text === null) return;
  show(text);
  say('This is a report from the address of the page.');
  byId('run').textContent = 'Test this machine';
}

byId('run').addEventListener('click', () => void run());
byId('stop').addEventListener('click', () => controller?.abort());
byId('copy').addEventListener('click', async () => {
  const button = byId('copy');
  try {
    await navigator.clipboard.writeText(block.textContent ?? '');
    button.textContent = 'Copied';
  } catch {
    // No permission: it can be copied by hand.
    getSelection()?.selectAllChildren(block);
    button.textContent = 'Selected, to be copied';
  }
  setTimeout(() => (button.textContent = 'Copy the report'), 2500);
});
addEventListener('hashchange', showAddress);
wireTheme(() => {});
showAddress();
