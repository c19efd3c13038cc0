import { delaunay2d } from 'gdel-wasm';

const lake = await (await fetch('lake.json')).json();
const coarse = await delaunay2d([], { polygons: [lake.coordinates] });

document.body.innerHTML = `<p></p>
  <label>Smallest angle <input type="range" min="0" max="34" value="30"></label>
  <label>Largest area <input type="range" min="2" max="60" value="12"></label>
  <svg stroke-width="0.15" stroke="#1d4e79"></svg>`;
const [note, { firstElementChild: angle }, { firstElementChild: area }, svg] =
  document.body.children;
const sides = [0, 1].map((axis) => coarse.coords.filter((_, i) => i % 2 === axis));
const [left, top] = sides.map((side) => Math.min(...side) - 2);
const [right, bottom] = sides.map((side) => Math.max(...side) + 2);
svg.setAttribute('viewBox', `${left} ${top} ${right - left} ${bottom - top}`);

async function draw() {
  const fine = await coarse.refine({ minAngle: angle.valueAsNumber, maxArea: area.valueAsNumber });
  const { refinement } = fine.constraints;
  const triangles = fine.insideTriangles();
  const corner = (v) => [fine.coords[2 * v], fine.coords[2 * v + 1]];
  let paths = '';
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = Array.from(triangles.subarray(i, i + 3), corner);
    const size = Math.abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
    paths += `<path d="M${[a, b, c].join('L')}Z" fill="hsl(205 60% ${Math.max(45, 92 - 3 * size)}%)"/>`;
  }
  svg.innerHTML = paths;
  const added = refinement.pointsOnSegments + refinement.pointsInside;
  const least = refinement.minAngle.toFixed(1);
  note.textContent = `${triangles.length / 3} triangles with angles of ${least}° or more, ${added} points added`;
}
angle.oninput = area.oninput = draw;
await draw();
