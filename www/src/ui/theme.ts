import type { Viewer } from '../view/viewer';
import { byId } from './dom';

const KEY = 'gdel-theme';

/** Light or dark: the visitor's choice, else the system's. */
export function wireTheme(onChange: () => void): void {
  const system = matchMedia('(prefers-color-scheme: dark)');
  const apply = () => {
    const stored = localStorage.getItem(KEY);
    document.documentElement.dataset.theme = stored ?? (system.matches ? 'dark' : 'light');
    onChange();
  };
  system.addEventListener('change', apply);
  byId('theme').addEventListener('click', () => {
    localStorage.setItem(KEY, document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark');
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
