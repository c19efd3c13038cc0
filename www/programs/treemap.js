import { treemap } from 'gdel-wasm/treemap';

// Country, continent and millions of people.
const csv = await (await fetch('countries.csv')).text();
const [, ...rows] = csv.trim().split('\n').map((line) => line.split(','));
const countries = rows.map(([name, continent, people]) => ({ name, continent, value: Number(people) }));
const continents = Object.entries(Object.groupBy(countries, ({ continent }) => continent));

const [width, height] = [720, 480];
const map = await treemap(
  continents.map(([name, children]) => ({ name, children })),
  { shape: [0, 0, width, height] },
);

const SVG = 'http://www.w3.org/2000/svg';
function element(name, attributes, text = '') {
  const created = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) created.setAttribute(key, value);
  created.textContent = text;
  return created;
}

const svg = element('svg', { viewBox: `0 0 ${width} ${height}`, 'font-family': 'sans-serif' });
const people = countries.reduce((sum, { value }) => sum + value, 0);
map.cells.forEach((continent, i) => {
  for (const cell of continent.children) {
    const color = `hsl(${i * 67} 45% ${70 - (cell.index % 5) * 3}%)`;
    const polygon = element('polygon', { points: cell.join(' '), fill: color, stroke: 'white' });
    polygon.append(element('title', {}, `${cell.item.name}: ${cell.value} million people`));
    svg.append(polygon);
    // A name where there is room for it.
    const size = Math.min(18, Math.sqrt(cell.area) / (0.62 * cell.item.name.length));
    const [x, y] = cell.reduce(([sx, sy], [cx, cy]) => [sx + cx / cell.length, sy + cy / cell.length], [0, 0]);
    const place = { x, y: y + size / 3, 'font-size': size, 'text-anchor': 'middle' };
    if (size > 6) svg.append(element('text', { ...place, 'pointer-events': 'none' }, cell.item.name));
  }
  svg.append(element('polygon', { points: continent.join(' '), fill: 'none', stroke: 'white', 'stroke-width': 4 }));
});

const note = document.createElement('p');
note.textContent = `${countries.length} countries, ${people} million people; areas are off by ${(
  100 * map.error
).toFixed(3)} % at most`;
document.body.append(note, svg);
