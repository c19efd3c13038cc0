import { FORMATS, type Format, type SavedFile } from '../model/save';
import type { Page, Part } from '../page';
import { complaintAbout } from './complaint';
import { byId, count, create } from './dom';
import { download } from './download';
import { nameOf } from './result';

/** The formats of what is to be seen. */
const VIEWS = ['GLB', 'PNG', 'SVG'] as const;

/** The panel with downloads, the code, and what this machine's WebGPU can do. */
export function usePanel(page: Page): Part {
  const buttons = [...FORMATS, ...VIEWS].map((format) => {
    const button = create('button', { type: 'button' }, format);
    button.addEventListener('click', () =>
      download(page, format, button, () => filesOf(format, page)),
    );
    if (format === 'SVG') button.classList.add('only-2d');
    return button;
  });
  byId('downloads').append(...buttons);

  byId('copy').addEventListener('click', async () => {
    const copy = byId('copy');
    try {
      await navigator.clipboard.writeText(byId('code').textContent!);
      copy.textContent = 'Copied';
    } catch {
      copy.textContent = 'Copying is blocked: select the text';
    }
    setTimeout(() => (copy.textContent = 'Copy'), 2500);
  });
  /** Counts what was asked: an earlier answer is of no interest. */
  let asked = 0;
  const tell = async () => {
    if (byId('use').hidden) return;
    const own = ++asked;
    const { codeFor } = await import('./code').catch((error: unknown) => ({
      codeFor: () => `// ${complaintAbout('The code', error)}`,
    }));
    const polygons = page.summary?.given === undefined ? null : await page.model.constrained();
    if (own === asked) byId('code').textContent = codeFor(page.settings, page.summary, polygons);
  };
  return {
    changed: () => void tell(),
    showed() {
      void tell();
      if (!byId('use').hidden) void describeMachine(page);
    },
  };
}

/** The file with what is to be seen. */
async function viewAs(format: (typeof VIEWS)[number], page: Page): Promise<SavedFile> {
  if (format === 'GLB')
    return { extension: '.glb', bytes: await (await import('../view/glb')).toGLB(page) };
  if (format === 'PNG') {
    if (!page.viewer) throw new Error('This browser cannot draw.');
    return { extension: '.png', bytes: await page.viewer.picture() };
  }
  return {
    extension: '.svg',
    bytes: new TextEncoder().encode(await (await import('../view/svg')).toSVG(page)),
  };
}

async function filesOf(format: Format | (typeof VIEWS)[number], page: Page): Promise<SavedFile[]> {
  if (format === 'GLB' || format === 'PNG' || format === 'SVG') return [await viewAs(format, page)];
  return page.model.save(format, { kind: page.settings.filter, alpha: page.settings.alpha });
}

const bytes = (n: number) =>
  n < 2 ** 20 ? `${count(n / 2 ** 10)} KiB` : `${count(Math.floor(n / 2 ** 20))} MiB`;

/** The limits of WebGPU that bound the size of the input, or its speed. */
const LIMITS = [
  ['maxBufferSize', 'Largest buffer', bytes],
  ['maxStorageBufferBindingSize', 'Largest storage buffer', bytes],
  ['maxStorageBuffersPerShaderStage', 'Storage buffers per stage', count],
  ['maxComputeInvocationsPerWorkgroup', 'Threads per workgroup', count],
  ['maxComputeWorkgroupStorageSize', 'Memory per workgroup', bytes],
  ['maxComputeWorkgroupsPerDimension', 'Workgroups per dimension', count],
] as const;

async function describeMachine({ model, viewer }: Page): Promise<void> {
  const { adapter, fallback, thread, whyThread } = await model.info();
  const rows: [string, string][] = [
    ['Adapter', adapter ? nameOf(adapter) : 'none'],
    ['Large inputs', fallback ? `CPU backend: ${fallback}` : 'GPU backend'],
    ['Work is done', thread === 'worker' ? 'in a worker' : `in the page’s worker: ${whyThread}`],
    ['Drawing', viewer ? viewer.api : 'none'],
    [
      'The cut is found',
      viewer?.cutBy === 'GPU' ? 'on the GPU that draws' : 'in the page’s worker',
    ],
  ];
  const limits = (await navigator.gpu?.requestAdapter())?.limits;
  if (limits)
    rows.push(
      ...LIMITS.map(([limit, name, show]): [string, string] => [name, show(limits[limit])]),
    );
  byId('machine').replaceChildren(
    ...rows.map(([name, value]) =>
      create('tr', {}, create('th', { scope: 'row' }, name), create('td', {}, value)),
    ),
  );
}
