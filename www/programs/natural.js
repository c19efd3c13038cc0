import { delaunay2d } from 'gdel-wasm';

const SIZE = 200;
const truth = (x, y) => Math.sin(4 * x) * Math.cos(3 * y) + 0.6 * x * y;

// Samples at random places and at the corners of the square.
let seed = 7;
const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
const points = [0, 1].flatMap((x) => [0, 1].map((y) => [x, y]));
while (points.length < 60) points.push([random(), random()]);
const values = points.map(([x, y]) => truth(x, y));

const mesh = await delaunay2d(points);
const grid = { width: SIZE, height: SIZE, bounds: [0, 0, 1, 1] };
const natural = await mesh.interpolateGrid(values, { ...grid, method: 'sibson-c1' });

/** The mean of the values with the squares of inverse distances as weights. */
function inverseDistance(x, y) {
  let [sum, weights] = [0, 0];
  points.forEach(([px, py], i) => {
    const weight = 1 / ((x - px) ** 2 + (y - py) ** 2);
    sum += weight * values[i];
    weights += weight;
  });
  return sum / weights;
}

/** The value at the centre of each cell. */
function onGrid(f) {
  const cells = new Float64Array(SIZE * SIZE);
  for (let i = 0; i < cells.length; i++)
    cells[i] = f(((i % SIZE) + 0.5) / SIZE, (Math.floor(i / SIZE) + 0.5) / SIZE);
  return cells;
}

function show(title, cells, exact) {
  const error = Math.sqrt(cells.reduce((sum, v, i) => sum + (v - exact[i]) ** 2, 0) / cells.length);
  const figure = document.body.appendChild(document.createElement('div'));
  figure.innerHTML = `<canvas width=${SIZE} height=${SIZE}></canvas><p></p>`;
  const [canvas, caption] = figure.children;
  caption.textContent = exact === cells ? title : `${title}: off by ${error.toFixed(3)}`;
  const context = canvas.getContext('2d');
  const image = context.createImageData(SIZE, SIZE);
  cells.forEach((v, i) => {
    // Bands of colour show the shape.
    const warm = 18 * Math.floor(5 * (v + 1.3));
    image.data.set([40 + warm, 150 - warm / 4, 235 - warm, 255], 4 * i);
  });
  context.putImageData(image, 0, 0);
  context.fillStyle = 'black';
  for (const [x, y] of points) context.fillRect(SIZE * x - 1, SIZE * y - 1, 3, 3);
}

document.body.style =
  'display: grid; gap: 12px; grid-template-columns: repeat(auto-fit, minmax(180px, 1fr))';
const exact = onGrid(truth);
show('What was sampled', exact, exact);
show('Natural neighbours', natural.values, exact);
show('Inverse distance', onGrid(inverseDistance), exact);
