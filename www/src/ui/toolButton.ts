import type { Page } from '../page';
import type { Tool } from '../settings';
import { create } from './dom';

/** Adds a tool to those under the 2D drawing. Returns what shows whether it is chosen, and whether it can be. */
export function toolButton(
  page: Page,
  tool: Tool,
  name: string,
  title: string,
): (isPossible?: boolean) => void {
  const radio = create('input', { type: 'radio', name: 'tool', value: tool });
  const label = create('label', { title }, radio, create('span', {}, name));
  document.querySelector('.tools [role=radiogroup]')!.append(label);
  radio.addEventListener('change', () => {
    page.tool = tool;
    page.change({});
  });
  return (isPossible = true) => {
    radio.checked = page.tool === tool;
    radio.disabled = !isPossible;
  };
}
