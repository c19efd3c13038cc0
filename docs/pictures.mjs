// Draws the pictures of answers.md from what the npm package returns: `node docs/pictures.mjs`,
// after `npm run build`.

import { writeFileSync } from 'node:fs';
import { delaunay2d } from '../web/dist/index.js';

const SIDE = 200;
const COLORS = ['#4477aa', '#ee6677', '#228833', '#ccbb44', '#66ccee', '#aa3377'];

/** The same numbers in every run, 0 to 1. */
function random(seed) {
  return () => {
    seed = (Math.imul(seed, 1664525) + 1013904223) | 0;
    return (seed >>> 0) / 2 ** 32;
  };
}

/** Points in the unit square that a condition holds for, none very near to another. */
function scattered(count, seed, holds = () => true, distance = 0.03) {
  const next = random(seed);
  const points = [];
  while (points.length < count) {
    const [x, y] = [0.05 + 0.9 * next(), 0.05 + 0.9 * next()];
    const isFree = points.every(([px, py]) => Math.hypot(px - x, py - y) > distance);
    if (isFree && holds(x, y)) points.push([x, y]);
  }
  return points;
}

const number = (x) => String(Math.round(SIDE * 10 * x) / 10);
const at = ([x, y]) => `${number(x)} ${number(y)}`;
const path = (points, style, close = 'z') =>
  `<path d="M${points.map(at).join('L')}${close}" ${style}/>`;
const dots = (points, style = 'fill="#222"', radius = 2) =>
  points
    .map(([x, y]) => `<circle cx="${number(x)}" cy="${number(y)}" r="${radius}" ${style}/>`)
    .join('');
const pointsOf = (mesh, indices) =>
  Array.from(indices, (v) => [mesh.coords[2 * v], mesh.coords[2 * v + 1]]);
const triangle = (mesh, t) => pointsOf(mesh, mesh.triangles.subarray(3 * t, 3 * t + 3));
const THIN = 'fill="none" stroke="#bbb" stroke-width="0.7"';

function edges(mesh, style = THIN) {
  const all = Array.from({ length: mesh.triangles.length / 3 }, (_, t) => triangle(mesh, t));
  return `<path d="${all.map((corners) => `M${corners.map(at).join('L')}z`).join('')}" ${style}/>`;
}

/** Panels beside each other, each with a title. */
function write(name, panels) {
  const step = SIDE + 12;
  const content = panels.map(
    ([title, body], k) =>
      `<g transform="translate(${k * step} 0)"><svg width="${SIDE}" height="${SIDE}">${body}</svg>` +
      `<text x="${SIDE / 2}" y="${SIDE + 15}" text-anchor="middle">${title}</text></g>`,
  );
  const size = `width="${panels.length * step - 12}" height="${SIDE + 22}"`;
  const text = 'font-family="sans-serif" font-size="12"';
  const back = `<rect width="100%" height="100%" fill="#fff"/>`;
  const svg = `<svg xmlns="http://www.w3.org/2000/svg" ${size} ${text}>${back}${content.join('')}</svg>\n`;
  writeFileSync(new URL(`answers/${name}.svg`, import.meta.url), svg);
}

const points = scattered(40, 1, undefined, 0.08);
const mesh = await delaunay2d(points);

// Location and nearest vertices.
const queries = [
  [0.31, 0.62],
  [0.72, 0.35],
  [0.03, 0.03],
];
const { triangles, halfedges } = await mesh.locate(queries);
const nearest = await mesh.nearest(queries);
const located = Array.from(triangles).filter((t) => t >= 0);
const seen = Array.from(halfedges).filter((e) => e >= 0);
const next = (e) => (e % 3 === 2 ? e - 2 : e + 1);
write('locate', [
  [
    'locate',
    located.map((t) => path(triangle(mesh, t), 'fill="#cce0ee"')).join('') +
      edges(mesh) +
      seen
        .map((e) => pointsOf(mesh, [mesh.triangles[e], mesh.triangles[next(e)]]))
        .map((ends) => path(ends, 'stroke="#ee6677" stroke-width="3"', ''))
        .join('') +
      dots(points) +
      dots(queries, 'fill="#ee6677"', 3.5),
  ],
  [
    'nearest',
    edges(mesh) +
      queries
        .map((query, q) => [query, ...pointsOf(mesh, [nearest[q]])])
        .map((ends) => path(ends, 'stroke="#ee6677" stroke-width="1.5"', ''))
        .join('') +
      dots(points) +
      dots(queries, 'fill="#ee6677"', 3.5),
  ],
]);

// Interpolation: a grid of values in levels of color.
const values = points.map(([x, y]) => Math.sin(7 * x) * Math.cos(6 * y));
const CELLS = 64;
const LEVELS = 14;
const grid = Array.from({ length: CELLS ** 2 }, (_, i) => [
  ((i % CELLS) + 0.5) / CELLS,
  (Math.floor(i / CELLS) + 0.5) / CELLS,
]);
const panels = [];
for (const method of ['linear', 'laplace', 'sibson']) {
  const { values: found } = await mesh.interpolate(values, grid, { method });
  const levels = Array.from({ length: LEVELS }, () => '');
  const level = (i) => Math.min(LEVELS - 1, Math.floor(((found[i] + 1) / 2) * LEVELS));
  for (let i = 0; i < grid.length; ) {
    let end = i + 1;
    while (end % CELLS !== 0 && level(end) === level(i)) end++;
    if (!Number.isNaN(found[i]))
      levels[level(i)] += `M${i % CELLS} ${Math.floor(i / CELLS)}h${end - i}v1h${i - end}z`;
    i = end;
  }
  const color = (k) => `hsl(${220 - (200 * k) / (LEVELS - 1)} 60% 60%)`;
  const fields = levels.map((d, k) => (d ? `<path d="${d}" fill="${color(k)}"/>` : '')).join('');
  const scaled = `<g transform="scale(${SIDE / CELLS})" shape-rendering="crispEdges">${fields}</g>`;
  panels.push([method, scaled + dots(points, 'fill="#222"', 1.5)]);
}
write('interpolate', panels);

// Voronoi cells.
const cells = [];
for (const clip of ['none', 'hull', [0, 0, 1, 1]]) {
  const voronoi = await mesh.voronoi({ clip });
  const polygons = [...voronoi.cellPolygons()];
  const shapes = polygons.map((polygon) =>
    path(
      polygon,
      `fill="${COLORS[polygon.index % 6]}" fill-opacity="0.3" stroke="#555" stroke-width="0.7"`,
    ),
  );
  const title = { none: 'bounded cells', hull: "clip: 'hull'" }[clip] ?? 'clip: a box';
  cells.push([title, shapes.join('') + dots(points)]);
}
write('voronoi', cells);

// Alpha shapes of a ring and a disk.
const inRing = (x, y) => Math.abs(Math.hypot(x - 0.42, y - 0.42) - 0.28) < 0.09;
const inDisk = (x, y) => Math.hypot(x - 0.84, y - 0.84) < 0.11;
const ring = await delaunay2d(scattered(190, 2, (x, y) => inRing(x, y) || inDisk(x, y), 0.02));
const shapes = [];
for (const [title, options] of [
  ['alpha: 0.02', { alpha: 0.02 }],
  ["alpha: 'auto', components: 2", { components: 2 }],
  ['alpha: Infinity', { alpha: Number.POSITIVE_INFINITY }],
]) {
  const { solid, surface } = await ring.alphaShape(options);
  const inside = Array.from(solid, (t) => `M${triangle(ring, t).map(at).join('L')}z`).join('');
  const border = Array.from({ length: surface.length / 2 }, (_, e) =>
    pointsOf(ring, surface.subarray(2 * e, 2 * e + 2)),
  ).map((ends) => `M${ends.map(at).join('L')}`);
  shapes.push([
    title,
    `<path d="${inside}" fill="#cce0ee"/>` +
      `<path d="${border.join('')}" fill="none" stroke="#4477aa" stroke-width="2"/>` +
      dots(pointsOf(ring, ring.duplicateOf.keys()), 'fill="#222"', 1.3),
  ]);
}
write('alpha', shapes);

// The spanning tree and clusters.
const tree = await ring.spanningTree();
const lines = (from) =>
  Array.from({ length: from }, (_, e) => pointsOf(ring, tree.edges.subarray(2 * e, 2 * e + 2)))
    .map((ends) => `M${ends.map(at).join('L')}`)
    .join('');
const labels = tree.clusters(2);
const all = pointsOf(ring, labels.keys());
write('tree', [
  [
    'spanningTree',
    `<path d="${lines(tree.lengths.length)}" fill="none" stroke="#4477aa"/>${dots(all, 'fill="#222"', 1.3)}`,
  ],
  ['clusters(2)', all.map((p, i) => dots([p], `fill="${COLORS[labels[i]]}"`, 2.5)).join('')],
]);
