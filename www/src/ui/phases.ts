import type { Stats } from 'gdel-wasm';

/**
 * One colour a phase, the same in every chart: Okabe and Ito's, which stay apart with colour
 * blindness. First those of the CPU backend, then those of the GPU backend.
 */
const COLORS: Record<string, string> = {
  sort: '#0072b2',
  insert: '#56b4e9',
  lattice: '#0072b2',
  'phase 1': '#009e73',
  readback: '#cc79a7',
  splay: '#d55e00',
  flip: '#e69f00',
};

const OTHER = '#8b8f98';

export const phaseColor = (name: string): string => COLORS[name] ?? OTHER;

/** The phases of a run, and what the rest of its time went into, so that they add up to it. */
export function phasesOf({ phases, milliseconds }: Pick<Stats, 'phases' | 'milliseconds'>) {
  const rest = milliseconds - phases.reduce((sum, phase) => sum + phase.milliseconds, 0);
  return rest > 0 ? [...phases, { name: 'set-up', milliseconds: rest }] : phases;
}
