import { delaunay2d } from 'gdel-wasm';

// Points in two rings that are linked by a bridge.
const points = [];
let seed = 5;
const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
while (points.length < 900) {
  const [x, y] = [720 * random(), 420 * random()];
  const rings = [
    [200, 210],
    [510, 210],
  ].map(([cx, cy]) => Math.hypot(x - cx, y - cy));
  if (rings.some((r) => r > 80 && r < 150)) points.push([x, y]);
}
const mesh = await delaunay2d(points);
// The least radius at which all points belong to one part.
const { alpha: least } = await mesh.alphaShape();

document.body.innerHTML = `<p></p>
  <label>Radius <input type="range" min="2" max="90" step="0.5" value="${least}"></label>
  <svg viewBox="0 0 720 420"><path fill="#e8a06a"/><path fill="none" stroke="#b3400f" stroke-width="2"/>
    <path stroke="currentColor" stroke-width="4" stroke-linecap="round"/></svg>`;
const [note, { firstElementChild: slider }, svg] = document.body.children;
const [solid, border, dots] = svg.children;
dots.setAttribute('d', points.map((point) => `M${point}h0`).join(''));

async function draw() {
  // The triangles whose circumcircles have this radius or less.
  const shape = await mesh.alphaShape({ alpha: slider.valueAsNumber });
  const triangle = (t) => Array.from(mesh.triangles.subarray(3 * t, 3 * t + 3), (v) => points[v]);
  solid.setAttribute('d', Array.from(shape.solid, (t) => `M${triangle(t).join('L')}Z`).join(''));
  let d = '';
  for (let i = 0; i < shape.surface.length; i += 2)
    d += `M${points[shape.surface[i]]}L${points[shape.surface[i + 1]]}`;
  border.setAttribute('d', d);
  const parts = `${shape.components} ${shape.components === 1 ? 'part' : 'parts'}`;
  note.textContent = `Radius ${shape.alpha.toFixed(1)}: ${shape.solid.length} triangles in ${parts}`;
}
slider.oninput = draw;
await draw();
