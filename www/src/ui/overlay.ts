import type { Page } from '../page';
import { byId, create } from './dom';

/** Puts a canvas over the drawing. Returns what clears it, and begins to draw on it in the pixels of the page. */
export function overlay(id: string): () => CanvasRenderingContext2D {
  const canvas = byId('canvas');
  const sheet = create('canvas', { id, className: 'overlay' });
  sheet.setAttribute('aria-hidden', 'true');
  canvas.after(sheet);
  return () => {
    const { width, height } = canvas.getBoundingClientRect();
    sheet.width = Math.round(width * devicePixelRatio);
    sheet.height = Math.round(height * devicePixelRatio);
    const context = sheet.getContext('2d')!;
    context.scale(devicePixelRatio, devicePixelRatio);
    return context;
  };
}

/** The colour of the theme with a name. */
export const themeColor = (name: string): string =>
  getComputedStyle(document.documentElement).getPropertyValue(`--${name}`);

/** The place of a point on the canvas. */
export const onCanvas = ({ positions, viewer }: Page, i: number): [number, number] =>
  viewer!.onCanvas(positions![3 * i], positions![3 * i + 1], positions![3 * i + 2]);
