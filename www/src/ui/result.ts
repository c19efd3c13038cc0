import type { AdapterInfo, Stats } from 'gdel-wasm';
import type { Summary } from '../model/model';
import { byId, count, create, duration } from './dom';

/** Says in the page's title block what came out, how long it took and what did it. */
export function showResult(summary: Summary): void {
  const { space, dimension, points, simplices } = summary;
  const of = space === 3 ? 'tetrahedra' : 'triangles';
  byId('count').textContent =
    dimension === space
      ? `${count(points)} points → ${count(simplices)} ${of}`
      : points < 2
        ? `${['No points', 'One point'][points]}, so there are no ${of}`
        : `${count(points)} points: ${FLAT[dimension]}, so there are no ${of}`;
  byId('took').replaceChildren(create('b', {}, duration(summary.stats.milliseconds)));
  byId('engine-used').textContent = engineOf(summary.stats);
}

const FLAT = ['all in one place', 'all on one line', 'all in one plane'];

/** The engine and its adapter in words, and why the CPU engine where it took over. */
export function engineOf({ engine, adapter, why }: Stats): string {
  if (engine === 'gpu') return `On the GPU: ${adapter ? nameOf(adapter) : 'WebGPU'}`;
  return why ? `On the CPU: ${why}` : 'On the CPU, in WebAssembly';
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
