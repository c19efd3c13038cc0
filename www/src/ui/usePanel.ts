import { FORMATS, type Format } from '../model/save';
import { titleOf } from '../model/source';
import type { Page, Part } from '../page';
import { byId, count, create } from './dom';
import { showMessage } from './message';

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
  void describeMachine(page);
  return {
    changed: () => (byId('code').textContent = codeFor(page)),
    ran: () => void describeMachine(page),
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

async function describeMachine({ viewer }: Page): Promise<void> {
  const adapter = await navigator.gpu?.requestAdapter();
  const drawing: [string, string][] = viewer ? [['Drawing', viewer.api]] : [];
  const rows: [string, string][] = adapter
    ? [
        ['Adapter', adapter.info.description || [adapter.info.vendor, adapter.info.architecture].filter(Boolean).join(' ') || 'unnamed'],
        ...drawing,
        ...LIMITS.map((limit): [string, string] => [limit, count(adapter.limits[limit])]),
      ]
    : [['WebGPU', navigator.gpu ? 'no adapter: the CPU engine does the work' : 'not in this browser: the CPU engine does the work'], ...drawing];
  byId('machine').replaceChildren(...rows.map(([name, value]) => create('tr', {}, create('th', { scope: 'row' }, name), create('td', {}, value))));
}
