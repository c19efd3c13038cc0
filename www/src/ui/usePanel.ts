import { FORMATS, type Format } from '../model/save';
import { titleOf } from '../model/source';
import type { Page, Part } from '../page';
import { byId, count, create } from './dom';
import { showMessage } from './message';
import { nameOf } from './result';

/** The panel with downloads, the code, and what this machine's WebGPU can do. */
export function usePanel(page: Page): Part {
  const buttons = [...FORMATS, 'GLB' as const].map((format) => {
    const button = create('button', { type: 'button' }, format);
    button.addEventListener('click', () => void download(page, format, button));
    return button;
  });
  byId('downloads').append(...buttons);

  byId('copy').addEventListener('click', async () => {
    const copy = byId('copy');
    try {
      await navigator.clipboard.writeText(byId('code').textContent!);
      copy.textContent = 'Copied';
    } catch {
      copy.textContent = 'Not allowed here: select it';
    }
    setTimeout(() => (copy.textContent = 'Copy'), 2500);
  });
  return {
    changed: () => (byId('code').textContent = codeFor(page)),
    showed: () => byId('use').hidden || void describeMachine(page),
  };
}

async function download(page: Page, format: Format | 'GLB', button: HTMLButtonElement): Promise<void> {
  button.disabled = true;
  try {
    const files =
      format === 'GLB'
        ? [{ extension: '.glb', bytes: await (await import('../view/glb')).toGLB(page) }]
        : await page.model.save(format);
    const stem = titleOf(page.settings.source).replace(/\.[^.]*$/, '').replace(/[^\w-]+/g, '-').toLowerCase();
    for (const { extension, bytes } of files) {
      const link = create('a', {
        href: URL.createObjectURL(new Blob([bytes as Uint8Array<ArrayBuffer>])),
        download: stem + extension,
      });
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
    }
  } catch (error) {
    showMessage(`${format}: ${(error as Error).message}`);
  } finally {
    button.disabled = false;
  }
}

/** Lines that do with the package what the page has just done. */
function codeFor({ settings: { source, engine } }: Page): string {
  const options = engine === 'auto' ? '' : `, { engine: '${engine}' }`;
  const points =
    source.kind === 'generator'
      ? [
          `import { delaunay3d, generate } from 'gdel-wasm';`,
          ``,
          `const points = await generate('${source.distribution}', ${source.count}, { seed: ${source.seed} });`,
        ]
      : [
          `import { delaunay3d, readPoints } from 'gdel-wasm';`,
          ``,
          `const file = await fetch('${source.kind === 'file' ? source.file.name.replaceAll("'", "\\'") : `${source.sample}.ply`}');`,
          `const { points } = await readPoints(await file.blob(), { name: file.url });`,
        ];
  return [
    `// npm install gdel-wasm`,
    ...points,
    `const mesh = await delaunay3d(points${options});`,
    ``,
    `mesh.tetrahedra;  // Uint32Array, 4 point indices each`,
    `mesh.neighbors;   // Int32Array, -1 is outside`,
    `mesh.hull;        // Uint32Array, 3 a triangle`,
    `mesh.stats;       // engine, phases, rounds, flips`,
    ``,
    `const vtu = await mesh.toVTU();  // for ParaView`,
  ].join('\n');
}

const LIMITS = [
  'maxBufferSize', 'maxStorageBufferBindingSize', 'maxStorageBuffersPerShaderStage', 'maxComputeInvocationsPerWorkgroup',
  'maxComputeWorkgroupStorageSize', 'maxComputeWorkgroupsPerDimension',
] as const;

async function describeMachine({ model, viewer }: Page): Promise<void> {
  const { adapter, why, thread, whyThread } = await model.info();
  const rows: [string, string][] = [
    ['Adapter', adapter ? nameOf(adapter) : 'none'],
    ['Large inputs', why ? `CPU engine: ${why}` : 'GPU engine'],
    ['Work is done', thread === 'worker' ? 'in a worker' : `in the page’s worker: ${whyThread}`],
    ['Drawing', viewer ? viewer.api : 'none'],
  ];
  const limits = (await navigator.gpu?.requestAdapter())?.limits;
  if (limits) rows.push(...LIMITS.map((limit): [string, string] => [limit, count(limits[limit])]));
  byId('machine').replaceChildren(...rows.map(([name, value]) => create('tr', {}, create('th', { scope: 'row' }, name), create('td', {}, value))));
}
