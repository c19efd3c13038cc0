import { delaunay2d } from 'gdel-wasm';

// A GeoJSON polygon: its outline, then its holes. Here a lake with islands.
const lake = await (await fetch('lake.json')).json();
const mesh = await delaunay2d([], { polygons: [lake.coordinates] });
const triangles = mesh.insideTriangles();

let area = 0;
let paths = '';
const corner = (v) => [mesh.coords[2 * v], mesh.coords[2 * v + 1]];
for (let i = 0; i < triangles.length; i += 3) {
  const [a, b, c] = Array.from(triangles.subarray(i, i + 3), corner);
  area += Math.abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
  paths += `<path d="M${[a, b, c].join('L')}Z" fill="hsl(205 60% ${60 + (i % 7) * 3}%)"/>`;
}

const [x, y] = [0, 1].map((axis) => lake.coordinates[0].map((place) => place[axis]));
const [left, top] = [Math.min(...x), Math.min(...y)];
const box = [left - 2, top - 2, Math.max(...x) - left + 4, Math.max(...y) - top + 4];
const outlines = lake.coordinates.map((ring) => `M${ring.join('L')}Z`).join('');
document.body.innerHTML = `<p>${lake.coordinates.length - 1} holes, ${triangles.length / 3} triangles,
  area ${area.toFixed(1)}</p>
<svg viewBox="${box.join(' ')}" stroke="white" stroke-width="0.2">${paths}
  <path d="${outlines}" fill="none" stroke="#1d4e79" stroke-width="0.8"/></svg>`;
