import { delaunay2d } from 'gdel-wasm';

const DOTS = 3000;
const bitmap = await createImageBitmap(await (await fetch('picture.webp')).blob());
const { width, height } = bitmap;
document.body.innerHTML = `<p></p><canvas width=${3 * width} height=${3 * height}></canvas>`;
const [note, canvas] = document.body.children;
const context = canvas.getContext('2d');

// How much ink each pixel is to have.
const small = new OffscreenCanvas(width, height).getContext('2d');
small.drawImage(bitmap, 0, 0);
const { data } = small.getImageData(0, 0, width, height);
const ink = (x, y) =>
  0.02 + (1 - data[4 * (Math.floor(y) * width + Math.floor(x)) + 1] / 255) ** 1.5;

// Dots at random, many where it is dark.
let seed = 1;
const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
let dots = [];
while (dots.length < DOTS) {
  const [x, y] = [random() * width, random() * height];
  if (random() < ink(x, y)) dots.push([x, y]);
}

// Each dot gets a cell as large as it takes for all to have the same ink, and moves to its centre.
const clip = [0, 0, width, height];
for (let round = 1; round <= 10; round++) {
  const mesh = await delaunay2d(dots);
  const masses = dots.map(([x, y]) => 1 / ink(x, y));
  const { weights, error } = await mesh.transport({ masses, normalize: true, clip });
  await mesh.updateWeights(weights);
  const { centroids } = await mesh.voronoi({ clip });
  dots = dots.map((_, i) => [centroids[2 * i], centroids[2 * i + 1]]);

  context.fillStyle = 'white';
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = 'black';
  for (const [x, y] of dots) {
    context.beginPath();
    context.arc(3 * x, 3 * y, 2.2, 0, 2 * Math.PI);
    context.fill();
  }
  note.textContent = `${dots.length} dots, round ${round}: areas are off by ${(100 * error).toFixed(2)} %`;
}
