import type { Page } from '../page';
import { rgbOf } from './colormap';

/** More than this would be a file that nothing opens. */
const MAX_TRIANGLES = 100_000;

/** What the page shows in 2D, as a picture: the unit square of the frame and a margin, y up. */
export async function toSVG({
  settings,
  lastDrawing,
  positions,
  summary,
  model,
}: Page): Promise<string> {
  if (!lastDrawing?.surface || !positions || !summary)
    throw new Error('There is nothing to see yet.');
  const { surface, voronoi } = lastDrawing;
  const { layers, map } = settings;
  if (surface.owners.length > MAX_TRIANGLES)
    throw new Error('A picture of so many triangles would be too large for most programs.');
  const style = getComputedStyle(document.documentElement);
  const color = (name: string) => style.getPropertyValue(`--${name}`).trim();
  const at = (array: Float32Array, i: number) =>
    `${(1000 * array[i]).toFixed(2)} ${(-1000 * array[i + 1]).toFixed(2)}`;
  const width = 1000 / Math.sqrt(Math.max(100, summary.points)) / 40;

  const parts: string[] = [];
  const edge = layers.edges
    ? ` stroke="${color('ink')}" stroke-opacity="0.6" stroke-width="${width.toFixed(2)}" stroke-linejoin="round"`
    : '';
  if (layers.simplices || layers.edges) {
    parts.push(`<g${edge}>`);
    for (let t = 0; t < surface.owners.length; t++) {
      const fill = layers.simplices ? `rgb(${rgbOf(map, surface.values[3 * t]).join()})` : 'none';
      parts.push(
        `<path fill="${fill}" d="M${[0, 3, 6].map((corner) => at(surface.positions, 9 * t + corner)).join('L')}Z"/>`,
      );
    }
    parts.push('</g>');
  }
  const lines = (ends: Float32Array, name: string, wide: number) => {
    let path = '';
    for (let i = 0; i < ends.length; i += 6) path += `M${at(ends, i)}L${at(ends, i + 3)}`;
    parts.push(
      `<path fill="none" stroke="${color(name)}" stroke-width="${(wide * width).toFixed(2)}" stroke-linecap="round" d="${path}"/>`,
    );
  };
  if (voronoi) lines(voronoi.ends, 'accent', 1.5);
  // The sides of polygons, where there are some.
  if (layers.hull) lines(await model.hull(), 'ink', 2.5);
  if (layers.points) {
    parts.push(`<g fill="${color('ink')}">`);
    for (let i = 0; i < positions.length; i += 3) {
      const [x, y] = at(positions, i).split(' ');
      parts.push(`<circle cx="${x}" cy="${y}" r="${(3 * width).toFixed(2)}"/>`);
    }
    parts.push('</g>');
  }
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="-1200 -1200 2400 2400" style="background:${color('paper')}">\n${parts.join('\n')}\n</svg>\n`;
}
