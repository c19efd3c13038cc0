import type { TreemapCell } from 'gdel-wasm/treemap';
import type { Palette } from './colors';
import { type Label, LEADING, labelFor } from './label';
import type { Outline } from './shapes';
import type { Item } from './table';

export type Cell = TreemapCell<Item>;

/** A cell without others in it. */
export interface Leaf {
  cell: Cell;
  /** The names of the groups around it. */
  path: string[];
  hue: number;
  shade: number;
}

/** What a picture is of. */
export interface Scene {
  leaves: Leaf[];
  /** The cells of groups, with how deep they are: 0 for the outermost. */
  groups: { cell: Cell; depth: number; name: string }[];
  outline: Outline;
}

/** Text is at least so high, in units of which the map's area is a million. */
const SMALLEST = 7;

const NUMBER = new Intl.NumberFormat('en', { maximumSignificantDigits: 6 });
const PERCENT = new Intl.NumberFormat('en', { style: 'percent', maximumSignificantDigits: 3 });

export const number = (x: number): string => NUMBER.format(x);
export const percent = (x: number): string => PERCENT.format(x);

/** The cells of a treemap, innermost and others. */
export function sceneOf(cells: readonly (Cell | null)[], outline: Outline): Scene {
  const scene: Scene = { leaves: [], groups: [], outline };
  const add = (cell: Cell | null, path: string[], hue: number, [at, of]: [number, number]) => {
    if (!cell) return;
    const { children, name } = cell.item;
    if (!children) {
      const shade = of > 1 ? (((at * 7) % of) / (of - 1)) * 2 - 1 : 0;
      scene.leaves.push({ cell, path, hue, shade });
      return;
    }
    scene.groups.push({ cell, depth: path.length, name });
    cell.children?.forEach((child, i, all) => {
      add(child, [...path, name], hue, [i, all.length]);
    });
  };
  cells.forEach((cell, i) => {
    add(cell, [], i, [0, 1]);
  });
  return scene;
}

/** How wide text of height 1 is. */
const widthOf = (() => {
  const widths = new Map<string, number>();
  let context: CanvasRenderingContext2D | null = null;
  return (text: string): number => {
    let width = widths.get(text);
    if (width === undefined) {
      context ??= document.createElement('canvas').getContext('2d')!;
      context.font = `500 100px ${FONT}`;
      width = context.measureText(text).width / 100;
      widths.set(text, width);
    }
    return width;
  };
})();

const FONT = '"Geist Variable", system-ui, -apple-system, "Segoe UI", sans-serif';

const digits = (x: number) => String(Math.round(100 * x) / 100);

/** The path of a polygon. */
export const pathOf = (polygon: readonly [number, number][]): string =>
  polygon.length ? `M${polygon.map(([x, y]) => `${digits(x)} ${digits(y)}`).join('L')}Z` : '';

const escaped = (text: string) =>
  text.replace(
    /[&<>"]/g,
    (letter) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' })[letter]!,
  );

/** What a cell is called in full. */
export const titleOf = ({ cell, path }: Leaf, sum: number): string =>
  `${[...path, cell.item.name].join(' › ')}: ${number(cell.value)} (${percent(cell.value / sum)})`;

function textOf({ lines, at: [x, y], size }: Label): string {
  const first = y - ((lines.length - 1) / 2) * LEADING * size + 0.35 * size;
  const spans = lines.map(
    (line, i) =>
      `<tspan x="${digits(x)}" y="${digits(first + i * LEADING * size)}">${escaped(line)}</tspan>`,
  );
  return `<text font-size="${digits(size)}">${spans.join('')}</text>`;
}

/** How a picture is described. */
export interface Description {
  title: string;
  text: string;
}

/**
 * The picture as SVG. As a file it has a title, a description, and the name of each cell; on the page, the cells have
 * their numbers in `data-cell` instead.
 */
export function svgOf(
  { leaves, groups, outline }: Scene,
  colors: Palette,
  { title, text }: Description,
  isFile: boolean,
): string {
  const sum = leaves.reduce((sum, { cell }) => sum + cell.value, 0);
  const thin = Math.min(2, 40 / Math.sqrt(leaves.length));
  const cells = leaves.map((leaf, i) => {
    const path = `fill="${colors.cell(leaf.hue, leaf.shade)}" d="${pathOf(leaf.cell)}"`;
    return isFile
      ? `<path ${path}><title>${escaped(titleOf(leaf, sum))}</title></path>`
      : `<path data-cell="${i}" ${path}/>`;
  });
  const borders = groups.map(
    ({ cell, depth }) =>
      `<path stroke-width="${digits(thin + Math.max(1, 5 - 2 * depth))}" d="${pathOf(cell)}"/>`,
  );
  const labels = leaves
    .map(({ cell }) => labelFor(cell, cell.item.name, widthOf, { smallest: SMALLEST, area: 1e6 }))
    .map((label) => (label ? textOf(label) : ''));
  const edge = 4;
  const box = [-edge, -edge, outline.width + 2 * edge, outline.height + 2 * edge].map(digits);
  const named = isFile
    ? 'aria-labelledby="title description"'
    : `aria-label="${escaped(`${title}. ${text}`)}"`;
  return [
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="${box.join(' ')}" role="img" ${named}>`,
    ...(isFile
      ? [
          `<title id="title">${escaped(title)}</title>`,
          `<desc id="description">${escaped(text)}</desc>`,
          `<rect x="${box[0]}" y="${box[1]}" width="${box[2]}" height="${box[3]}" fill="${colors.paper}"/>`,
        ]
      : []),
    `<g stroke="${colors.line}" stroke-width="${digits(thin)}" stroke-linejoin="round">`,
    ...cells,
    '</g>',
    `<g fill="none" stroke="${colors.line}" stroke-linejoin="round" pointer-events="none">`,
    ...borders,
    '</g>',
    `<g fill="${colors.text}" font-family="${escaped(FONT)}" font-weight="500" text-anchor="middle" pointer-events="none">`,
    ...labels.filter((label) => label !== ''),
    '</g>',
    '</svg>',
    '',
  ].join('\n');
}
