import type { Page, Part } from '../page';
import { byId } from './dom';

/** How long an axis is, of the 40 units that the picture is wide. */
const LENGTH = 13;

/** The picture of how the axes of the file lie, beside the scale bar. */
export function axes(page: Page): Part {
  const box = byId('axes');
  const arms = ['x', 'y', 'z'].map((name) => {
    const line = svg('line', { x1: '20', y1: '20' });
    const label = svg('text', {});
    label.textContent = name;
    return { line, label };
  });
  const show = () => {
    const { viewer, summary } = page;
    box.toggleAttribute('hidden', !viewer || summary?.dimension !== 3);
    if (!viewer) return;
    const turned = viewer.axes.map(([right, down, near], i) => ({ right, down, near, ...arms[i] }));
    // Those that point towards the eye lie over the others.
    turned.sort((a, b) => a.near - b.near);
    for (const { right, down, line, label } of turned) {
      line.setAttribute('x2', String(20 + LENGTH * right));
      line.setAttribute('y2', String(20 + LENGTH * down));
      label.setAttribute('x', String(20 + (LENGTH + 5) * right));
      label.setAttribute('y', String(20 + (LENGTH + 5) * down));
    }
    box.replaceChildren(...turned.flatMap(({ line, label }) => [line, label]));
  };
  return { drew: show, moved: show, changed: show };
}

function svg(name: 'line' | 'text', attributes: Record<string, string>): SVGElement {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
}
