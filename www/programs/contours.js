import { delaunay2d } from 'gdel-wasm';
import * as L from 'leaflet';

// Name, longitude, latitude and a temperature, such as that of July, of each station.
const csv = await (await fetch('stations.csv')).text();
const rows = csv.trim().split('\n').slice(1);
const stations = rows
  .map((row) => row.split(','))
  .map(([name, ...rest]) => [name, ...rest.map(Number)]);

// Values between the stations: smooth, on a grid. Outside of all stations there are none.
const places = stations.map(([, x, y]) => [x, y]);
const july = stations.map(([, , , degrees]) => degrees);
const mesh = await delaunay2d(places);
const grid = [];
for (let y = 36; y <= 64; y += 0.25) for (let x = -10; x <= 31; x += 0.25) grid.push([x, y]);
const { values } = await mesh.interpolate(july, grid, { method: 'sibson-c1' });

// The lines of each degree.
const levels = Array.from({ length: 16 }, (_, i) => 14 + i);
const contours = await (await delaunay2d(grid)).contours(values, levels);

document.body.innerHTML = '<p></p><div style="height: 480px; background: none"></div>';
const [note, place] = document.body.children;
const map = L.map(place, { zoomSnap: 0, maxZoom: 8, minZoom: 2 });
map.fitBounds([
  [36, -10],
  [62, 31],
]);
map.attributionControl.addAttribution('Outlines: Natural Earth');
const outlines = await (await fetch('europe.json')).json();
L.geoJSON(outlines, { style: { color: '#888', weight: 1, fillOpacity: 0.1 } }).addTo(map);

let lines = 0;
for (const { level, vertices, lineOffsets, lines: of } of contours) {
  const color = `hsl(${220 - 14 * (level - 14)} 75% 50%)`;
  for (let i = 0; i + 1 < lineOffsets.length; i++, lines++) {
    const line = of.slice(lineOffsets[i], lineOffsets[i + 1]);
    const path = Array.from(line, (v) => [vertices[2 * v + 1], vertices[2 * v]]);
    L.polyline(path, { color, weight: 2 }).bindTooltip(`${level} °C`, { sticky: true }).addTo(map);
  }
}
for (const [name, x, y, degrees] of stations) {
  const dot = L.circleMarker([y, x], { radius: 3, color: '#777', fillOpacity: 1 });
  dot.bindTooltip(`${name}: ${degrees} °C`).addTo(map);
}
note.textContent = `${stations.length} stations, ${lines} lines of equal temperature in July`;
