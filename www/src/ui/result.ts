import type { AdapterInfo, Stats } from 'gdel-wasm';
import type { Summary } from '../model/model';
import { byId, count, create, duration } from './dom';

/** Says in the page's title block what came out, how long it took and what did it. */
export function showResult(summary: Summary): void {
  byId('count').textContent =
    summary.dimension === 3
      ? `${count(summary.points)} points → ${count(summary.tetrahedra)} tetrahedra`
      : `${count(summary.points)} points: ${FLAT[summary.dimension]}, so there are no tetrahedra`;
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
  return description || device || [vendor, architecture].filter(Boolean).join(' ') || 'an adapter without a name';
}
