import type { AdapterInfo, Stats } from 'gdel-wasm';
import type { Summary } from '../model/model';
import { byId, count, create, duration, simplices } from './dom';

/** Says in the page's title block what came out, how long it took and what did it. */
export function showResult(summary: Summary, name: string): void {
  byId('name').textContent = name;
  document.title = `${name} · gdel`;
  const { dimension, affineDimension, points } = summary;
  const of = dimension === 3 ? 'tetrahedra' : 'triangles';
  byId('count').textContent =
    affineDimension === dimension
      ? `${count(points)} points → ${simplices(summary.simplices, dimension)}`
      : points < 2
        ? `${['No points', 'One point'][points]}, so there are no ${of}`
        : `${count(points)} points: ${FLAT[affineDimension]}, so there are no ${of}`;
  byId('took').replaceChildren(create('b', {}, duration(summary.stats.milliseconds)));
  byId('backend-used').textContent = backendOf(summary.stats);
  byId('left-out').textContent = leftOut(summary);
}

/** Says which of the file's points are not in the mesh. */
function leftOut({ noReturn }: Summary): string {
  if (noReturn === 0) return '';
  return noReturn === 1
    ? 'One point without a measurement is left out'
    : `${count(noReturn)} points without a measurement are left out`;
}

const FLAT = ['all in one place', 'all on one line', 'all in one plane'];

/** Returns the backend and its adapter in words, or why it was the CPU. */
export function backendOf({ backend, adapter, fallback }: Stats): string {
  if (backend === 'gpu') return `On the GPU: ${adapter ? nameOf(adapter) : 'WebGPU'}`;
  return fallback ? `On the CPU: ${fallback}` : 'On the CPU, in WebAssembly';
}

/** Browsers leave out much of what they know about an adapter. */
export function nameOf({ description, device, vendor, architecture }: AdapterInfo): string {
  return (
    description ||
    device ||
    [vendor, architecture].filter(Boolean).join(' ') ||
    'an adapter without a name'
  );
}
