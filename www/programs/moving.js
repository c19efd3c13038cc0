import { delaunay2d } from 'gdel-wasm';

const [width, height, COUNT] = [720, 480, 400];
document.body.innerHTML = `<p></p><canvas width=${width} height=${height}></canvas>
  <label><input type="checkbox" checked> Move</label>`;
const [note, canvas, label] = document.body.children;
const context = canvas.getContext('2d');

const points = new Float64Array(2 * COUNT).map((_, i) => Math.random() * (i % 2 ? height : width));
const speeds = points.map(() => Math.random() - 0.5);
const mesh = await delaunay2d(points);

function simulate() {
  points.forEach((at, i) => {
    const end = i % 2 ? height : width;
    if (at + speeds[i] < 0 || at + speeds[i] > end) speeds[i] = -speeds[i];
    points[i] = at + speeds[i];
  });
}

function draw() {
  const { coords, triangles, halfedges } = mesh;
  context.clearRect(0, 0, width, height);
  context.beginPath();
  // Each edge once: its two half-edges are opposites of each other.
  for (let e = 0; e < triangles.length; e++) {
    if (halfedges[e] > e) continue;
    const [a, b] = [triangles[e], triangles[e % 3 === 2 ? e - 2 : e + 1]];
    context.moveTo(coords[2 * a], coords[2 * a + 1]);
    context.lineTo(coords[2 * b], coords[2 * b + 1]);
  }
  context.strokeStyle = '#888';
  context.stroke();
  context.fillStyle = '#d2602a';
  for (let i = 0; i < coords.length; i += 2)
    context.fillRect(coords[i] - 2, coords[i + 1] - 2, 4, 4);
}

let updates = 0;
requestAnimationFrame(async function next() {
  if (label.firstChild.checked) {
    simulate();
    await mesh.update(points);
    note.textContent = `${COUNT} points, ${mesh.triangles.length / 3} triangles, ${++updates} updates`;
    draw();
  }
  requestAnimationFrame(next);
});
