import type { Viewer } from '../view/viewer';
import { byId } from './dom';
import { recall, remember } from './storage';

const KEY = 'gdel-theme';

/** Light or dark: the visitor's choice, else the system's. */
export function wireTheme(onChange: () => void): void {
  const system = matchMedia('(prefers-color-scheme: dark)');
  let chosen = recall(KEY);
  const apply = () => {
    document.documentElement.dataset.theme = chosen ?? (system.matches ? 'dark' : 'light');
    onChange();
  };
  system.addEventListener('change', apply);
  byId('theme').addEventListener('click', () => {
    chosen = document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark';
    remember(KEY, chosen);
    apply();
  });
  apply();
}

/** Gives the theme's colours to the drawing. */
export function paint(viewer: Viewer): void {
  const style = getComputedStyle(document.documentElement);
  viewer.setTheme(
    style.getPropertyValue('--ink').trim(),
    style.getPropertyValue('--accent').trim(),
  );
}
