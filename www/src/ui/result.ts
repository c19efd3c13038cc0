import type { AdapterInfo, Stats } from 'gdel-wasm';
import type { Summary } from '../model/model';
import { byId, count, duration, simplices } from './dom';

/** Says in the line under the drawing what came out, how long it took and what did it. */
export function showResult(summary: Summary, name: string): void {
  byId('name').textContent = name;
  document.title = `${name} · gdel`;
  const { dimension, affineDimension, points } = summary;
  const of = dimension === 3 ? 'tetrahedra' : 'triangles';
  byId('count').textContent =
    affineDimension === dimension
      ? `${count(points)} points → ${simplices(summary.simplices, dimension)}`
      : points === 0
        ? `No points yet${dimension === 2 ? ': click on the sheet to add some' : ''}`
        : points === 1
          ? `One point, so there are no ${of}`
          : `${count(points)} points: ${FLAT[affineDimension]}, so there are no ${of}`;
  byId('took').textContent = duration(summary.stats.milliseconds);
  byId('backend-used').textContent = backendOf(summary.stats);
  // The line may be too short for the reason.
  byId('backend-used').title = backendOf(summary.stats);
}

const FLAT = ['all in one place', 'all on one line', 'all in one plane'];

/** Returns the backend and its adapter in words, or why it was the CPU. */
export function backendOf({ backend, adapter, fallback, threads }: Stats): string {
  if (backend === 'gpu') return `On the GPU: ${adapter ? nameOf(adapter) : 'WebGPU'}`;
  const cpu = threads > 1 ? `On the CPU, by ${threads} workers` : 'On the CPU';
  if (!fallback) return threads > 1 ? cpu : `${cpu}, in WebAssembly`;
  // The package's numbers have no separators.
  return `${cpu}: ${fallback.replace(/\b\d{4,}\b/g, (digits) => count(Number(digits)))}`;
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
