import { treemap } from 'gdel-wasm/treemap';

// Country, continent and millions of people.
const csv = await (await fetch('countries.csv')).text();
const [, ...rows] = csv
  .trim()
  .split('\n')
  .map((line) => line.split(','));
const countries = rows.map(([name, continent, people]) => ({
  name,
  continent,
  value: Number(people),
}));
const continents = Object.entries(Object.groupBy(countries, ({ continent }) => continent));

const [width, height] = [720, 480];
const map = await treemap(
  continents.map(([name, children]) => ({ name, children })),
  { shape: [0, 0, width, height] },
);

/** How far a place is from the nearest side of a polygon. */
function roomAt(x, y, polygon) {
  const distances = polygon.map(([ax, ay], i) => {
    const [bx, by] = polygon.at(i - 1);
    return Math.abs((bx - ax) * (ay - y) - (ax - x) * (by - ay)) / Math.hypot(bx - ax, by - ay);
  });
  return Math.min(...distances);
}

let svg = '';
map.cells.forEach((continent, i) => {
  for (const cell of continent.children) {
    const { name, value } = cell.item;
    const color = `hsl(${67 * i} 45% ${70 - 3 * (cell.index % 5)}%)`;
    const title = `<title>${name}: ${value} million people</title>`;
    svg += `<polygon points="${cell.join(' ')}" fill="${color}" stroke="white">${title}</polygon>`;
    // A name in the middle of the corners, where there is room for it.
    const [x, y] = [0, 1].map((axis) => cell.reduce((sum, at) => sum + at[axis], 0) / cell.length);
    const size = Math.min(18, (2 * roomAt(x, y, cell)) / (0.6 * name.length));
    if (size > 6) svg += `<text x="${x}" y="${y + size / 3}" font-size="${size}">${name}</text>`;
  }
  const outline = continent.join(' ');
  svg += `<polygon points="${outline}" fill="none" stroke="white" stroke-width="4"/>`;
});

const people = countries.reduce((sum, { value }) => sum + value, 0);
const error = (100 * map.error).toFixed(3);
document.body.innerHTML = `<p>${countries.length} countries, ${people} million people;
  areas are off by ${error} % at most</p>
<svg viewBox="0 0 ${width} ${height}" text-anchor="middle" font-family="sans-serif">${svg}</svg>`;
