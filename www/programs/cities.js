import { geoOrthographic, geoPath } from 'd3-geo';
import { delaunaySphere } from 'gdel-wasm';

const cities = await (await fetch('cities.json')).json();
const land = await (await fetch('land.json')).json();
const places = cities.map(([, longitude, latitude]) => [longitude, latitude]);
const sphere = await delaunaySphere(places);
const voronoi = await sphere.voronoi();
// d3-geo wants the orientation that RFC 7946 does not.
const cells = cities.map((_, i) => voronoi.cellPolygon(i).reverse());

const SIZE = 600;
document.body.innerHTML = `<p></p><canvas width=${SIZE} height=${SIZE} style="max-width: 500px"></canvas>`;
const [note, canvas] = document.body.children;
const context = canvas.getContext('2d');
const globe = geoOrthographic()
  .translate([SIZE / 2, SIZE / 2])
  .scale(SIZE / 2 - 4)
  .rotate([-15, -35]);
const path = geoPath(globe, context).pointRadius(3);

function draw(nearest) {
  const paint = (shape, fill, stroke) => {
    context.beginPath();
    path(shape);
    Object.assign(context, { fillStyle: fill, strokeStyle: stroke });
    context.fill();
    context.stroke();
  };
  context.clearRect(0, 0, SIZE, SIZE);
  paint({ type: 'Sphere' }, '#bcd3e6', '#789');
  paint(land, '#d9cfae', '#a98');
  paint({ type: 'Polygon', coordinates: [cells[nearest]] }, '#e8702a88', '#b3400f');
  for (const cell of cells)
    paint({ type: 'LineString', coordinates: cell }, 'transparent', '#b3400f66');
  paint({ type: 'MultiPoint', coordinates: places }, '#333', '#333');
  const area = (voronoi.areas[nearest] * 6371 ** 2) / 1e6;
  note.textContent = `${cities[nearest][0]} is nearest, one of ${cities.length}, to ${area.toFixed(1)} million km²`;
}

canvas.style.touchAction = 'none';
canvas.onpointermove = ({ buttons, movementX, movementY, offsetX, offsetY }) => {
  const [longitude, latitude] = globe.rotate();
  if (buttons) globe.rotate([longitude + movementX / 3, latitude - movementY / 3]);
  const scale = SIZE / canvas.clientWidth;
  const place = globe.invert([offsetX * scale, offsetY * scale]);
  if (place.every(Number.isFinite)) draw(sphere.find(...place));
};
draw(sphere.find(2.3, 48.9));
