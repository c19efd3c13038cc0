import { delaunay2d } from 'gdel-wasm';

// Points around seven places.
let seed = 11;
const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
const places = [
  [110, 110],
  [310, 90],
  [560, 120],
  [150, 340],
  [360, 260],
  [460, 400],
  [620, 320],
];
const points = places.flatMap(([x, y]) =>
  Array.from({ length: 60 }, () => {
    const [r, angle] = [58 * random(), 2 * Math.PI * random()];
    return [x + r * Math.cos(angle), y + r * Math.sin(angle)];
  }),
);

const mesh = await delaunay2d(points);
const tree = await mesh.spanningTree();
const length = tree.lengths.reduce((sum, l) => sum + l);

document.body.innerHTML = `<p></p>
  <label>Clusters <input type="number" min="1" max="20" value="7"></label>
  <svg viewBox="0 0 720 480" stroke-linecap="round"></svg>`;
const [note, { firstElementChild: input }, svg] = document.body.children;

function draw() {
  // Without its longest edges, the tree falls into as many parts: single-linkage clusters.
  const of = tree.clusters(input.valueAsNumber || 1);
  const color = (cluster) => `hsl(${cluster * 137.5} 60% 50%)`;
  let paths = '';
  for (let i = 0; i < tree.lengths.length; i++) {
    const [a, b] = tree.edges.subarray(2 * i, 2 * i + 2);
    const style = of[a] === of[b] ? color(of[a]) : '#8886';
    paths += `<path d="M${points[a]}L${points[b]}" stroke="${style}" stroke-width="1.5"/>`;
  }
  points.forEach((point, i) => {
    paths += `<path d="M${point}h0" stroke="${color(of[i])}" stroke-width="6"/>`;
  });
  svg.innerHTML = paths;
  const count = new Set(of).size;
  note.textContent = `${points.length} points, a tree of length ${length.toFixed(0)}, ${count} clusters`;
}
input.oninput = draw;
draw();
