import { delaunay2d } from 'gdel-wasm';

const [width, height] = [720, 480];
document.body.innerHTML = `<p></p>
  <canvas width=${width} height=${height} tabindex=0 role=application aria-label="Circles"></canvas>
  <p>Drag circles. Or choose one with Space, move it with arrows, and resize it with + and −.</p>`;
const [note, canvas] = document.body.children;
const context = canvas.getContext('2d');

const circles = Array.from({ length: 14 }, (_, i) => ({
  x: 90 + 135 * (i % 5) + 60 * Math.sin(5 * i),
  y: 90 + 150 * Math.floor(i / 5) + 50 * Math.cos(3 * i),
  radius: 25 + 12 * (i % 4),
}));
let [chosen, turn] = [circles[0], 0];

async function draw() {
  const mine = ++turn;
  // The cell of a circle is where its power distance, |x − p|² − r², is the least.
  const radii = circles.map(({ radius }) => radius);
  const mesh = await delaunay2d(circles, { point: ({ x, y }) => [x, y], radii });
  const voronoi = await mesh.voronoi({ clip: [0, 0, width, height] });
  if (mine !== turn) return;
  const polygons = [...voronoi.cellPolygons()];
  for (const polygon of polygons) {
    const path = new Path2D(`M${polygon.join('L')}Z`);
    Object.assign(context, { fillStyle: `hsl(${47 * polygon.index} 50% 65%)`, lineWidth: 1 });
    context.fill(path);
    context.stroke(path);
  }
  for (const circle of circles) {
    context.beginPath();
    context.arc(circle.x, circle.y, Math.abs(circle.radius), 0, 2 * Math.PI);
    context.lineWidth = circle === chosen ? 4 : 1;
    context.stroke();
  }
  note.textContent = `${circles.length} circles, ${polygons.length} cells, ${mesh.hidden.length} hidden`;
}

canvas.style.touchAction = 'none';
canvas.onpointerdown = canvas.onpointermove = ({ type, buttons, pointerId, offsetX, offsetY }) => {
  if (buttons === 0) return;
  const [x, y] = [(offsetX * width) / canvas.clientWidth, (offsetY * height) / canvas.clientHeight];
  const distance = (circle) => Math.hypot(circle.x - x, circle.y - y) - circle.radius;
  const nearer = (a, b) => (distance(a) <= distance(b) ? a : b);
  if (type === 'pointerdown') chosen = circles.reduce(nearer);
  canvas.setPointerCapture(pointerId);
  Object.assign(chosen, { x, y });
  draw();
};
const keys = ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', '-', '+'];
canvas.onkeydown = ({ key }) => {
  const at = keys.indexOf(key);
  if (key === ' ') chosen = circles[(circles.indexOf(chosen) + 1) % circles.length];
  else if (at < 0) return true;
  else chosen[['x', 'y', 'radius'][at >> 1]] += at % 2 ? 8 : -8;
  draw();
  return false;
};
await draw();
