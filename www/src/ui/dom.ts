/** The element with an id that the page's HTML has. */
export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  const element = document.getElementById(id);
  if (!element) throw new Error(`index.html has no element with the id ${id}`);
  return element as T;
}

/** A new element with properties and children. */
export function create<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Partial<HTMLElementTagNameMap[K]> = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

/** Has the browser save a file. */
export function saveFile(name: string, content: Blob): void {
  const link = create('a', { href: URL.createObjectURL(content), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

/** The radio buttons of a name. */
export function radios(name: string, onChoice: (value: string) => void): HTMLInputElement[] {
  const all = [...document.querySelectorAll<HTMLInputElement>(`input[name=${name}]`)];
  for (const radio of all) radio.addEventListener('change', () => onChoice(radio.value));
  return all;
}

const whole = new Intl.NumberFormat('en');
const three = new Intl.NumberFormat('en', { maximumSignificantDigits: 3 });

/** A number of things: 35,947. */
export const count = (n: number): string => whole.format(n);

/** So many things: 1 tetrahedron, 2 tetrahedra. */
export const things = (n: number, one: string, many: string): string =>
  `${count(n)} ${n === 1 ? one : many}`;

/** So many tetrahedra or triangles. */
export const simplices = (n: number, dimension: 2 | 3): string =>
  dimension === 3 ? things(n, 'tetrahedron', 'tetrahedra') : things(n, 'triangle', 'triangles');

/** A measured value to three digits: 0.0124, 1.2e-9. */
export const measured = (x: number): string =>
  x === 0 || (Math.abs(x) >= 1e-3 && Math.abs(x) < 1e6)
    ? three.format(x)
    : Number.isFinite(x)
      ? x.toExponential(2)
      : '∞';

/** A time: 0.3 ms, 84 ms, 1.24 s. */
export const duration = (milliseconds: number): string =>
  milliseconds < 999.5
    ? `${milliseconds < 9.95 ? milliseconds.toFixed(1) : Math.round(milliseconds)} ms`
    : `${three.format(milliseconds / 1000)} s`;

export const share = (part: number, of: number): string =>
  of === 0
    ? '0 %'
    : `${new Intl.NumberFormat('en', { maximumSignificantDigits: 2 }).format((100 * part) / of)} %`;
