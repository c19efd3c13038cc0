import type { Summary } from '../model/model';
import { byId, create, duration } from './dom';
import { phaseColor, phasesOf } from './phases';

/** The bar along the bottom of the stage: what the milliseconds went into. */
export function showStrip({ stats }: Summary): void {
  const phases = phasesOf(stats);
  const total = phases.reduce((sum, { milliseconds }) => sum + milliseconds, 0);
  byId('strip').hidden = total === 0;
  byId('bar').replaceChildren(
    ...phases.map(({ name, milliseconds }) => {
      const piece = create('i', { title: `${name}: ${duration(milliseconds)}` });
      piece.style.flex = String(milliseconds / total);
      piece.style.setProperty('--phase', phaseColor(name));
      return piece;
    }),
  );
  byId('phases').replaceChildren(
    ...phases.map(({ name, milliseconds }) => {
      const item = create('li', {}, `${name} `, create('b', {}, duration(milliseconds)));
      item.style.setProperty('--phase', phaseColor(name));
      return item;
    }),
  );
}
