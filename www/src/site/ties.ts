// The pictures of the guide on exactness. All triangles are what the package returns.

import { delaunay2dSync, load2d } from 'gdel-wasm';
import { byId } from '../ui/dom';
import './ties.css';

type Place = readonly [number, number];

/** On the circle around the origin with radius 65, exactly. The last one moves. */
const PLACES: readonly Place[] = [
  [63, 16],
  [-33, 56],
  [-52, -39],
  [25, -60],
];
const SVG = 'http://www.w3.org/2000/svg';
/** In milliseconds, for the way from one end to the other. */
const PLAYING = 4000;

/** Returns whether (a, b, c) turns to the left, 1, or to the right, −1, in floating point. */
function roundedSign([ax, ay]: Place, [bx, by]: Place, [cx, cy]: Place): number {
  return Math.sign((bx - ax) * (cy - ay) - (by - ay) * (cx - ax));
}

/** Returns the same as the package's triangle has it; 0 where there is none. */
function exactSign(a: Place, b: Place, c: Place): number {
  const { triangles } = delaunay2dSync([a, b, c]);
  if (triangles.length === 0) return 0;
  const first = triangles.indexOf(0);
  return triangles[(first + 1) % 3] === 2 ? 1 : -1;
}

/** Draws the sign at each position of a point that moves by units in the last place. */
function drawSigns(canvas: HTMLCanvasElement, sign: typeof exactSign): number[] {
  const { width, height } = canvas;
  const style = getComputedStyle(byId('rounding'));
  const colors = ['--right', '--on', '--left'].map((name) => style.getPropertyValue(name));
  const context = canvas.getContext('2d')!;
  const signs: number[] = [];
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++) {
      const found = sign([0.5 + x * 2 ** -53, 0.5 + y * 2 ** -53], [12, 12], [24, 24]);
      signs.push(found);
      context.fillStyle = colors[found + 1];
      context.fillRect(x, height - 1 - y, 1, 1);
    }
  return signs;
}

function drawRounding(): void {
  const [rounded, exact] = [roundedSign, exactSign].map((sign, i) =>
    drawSigns(document.querySelectorAll<HTMLCanvasElement>('#rounding canvas')[i], sign),
  );
  const wrong = rounded.filter((sign, i) => sign !== exact[i]).length;
  byId('wrong').textContent = `Rounding gets ${wrong} of ${exact.length} signs wrong.`;
}

function wireTies(): void {
  const figure = byId('ties');
  const way = byId<HTMLInputElement>('way');
  const play = byId('play');
  const still = matchMedia('(prefers-reduced-motion: reduce)');
  // Which index each place has.
  let numbers = [0, 1, 2, 3];
  let playing = 0;

  const draw = () => {
    const far = 1 + Number(way.value);
    const places = PLACES.map(([x, y], i) =>
      i === 3 ? ([far * x, far * y] as const) : ([x, y] as const),
    );
    const input: Place[] = [];
    for (const [i, number] of numbers.entries()) input[number] = places[i];
    const { triangles } = delaunay2dSync(input);

    let path = '';
    const corners = (t: number) => [...triangles.subarray(3 * t, 3 * t + 3)];
    for (let t = 0; t < triangles.length / 3; t++)
      path += `M${corners(t)
        .map((v) => input[v].join(' '))
        .join('L')}Z`;
    figure.querySelector('.mesh')!.setAttribute('d', path);
    figure.querySelector('.points')!.replaceChildren(...input.flatMap(dot));

    const shared = corners(0).filter((v) => corners(1).includes(v));
    const edge = shared.sort().join('–');
    const moving = numbers[3];
    const where = far === 1 ? 'exactly on' : far < 1 ? 'inside' : 'outside';
    byId('said').textContent =
      `Point ${moving} is ${where} the circle. ` +
      (far === 1
        ? `Both diagonals are Delaunay, and the order of the points decides for ${edge}, which cuts off point 0.`
        : `Only the diagonal ${edge} is Delaunay.`);
  };

  way.addEventListener('input', draw);
  byId('renumber').addEventListener('click', () => {
    numbers = numbers.map((number) => (number + 1) % 4);
    draw();
  });
  play.hidden = still.matches;
  play.addEventListener('click', () => {
    cancelAnimationFrame(playing);
    const start = performance.now();
    const step = (now: number) => {
      const share = Math.min(1, Math.max(0, now - start) / PLAYING);
      way.value = String(share - 0.5);
      draw();
      if (share < 1) playing = requestAnimationFrame(step);
    };
    playing = requestAnimationFrame(step);
  });
  draw();
}

/** Returns a point with its number beside it, away from the middle. */
function dot([x, y]: Place, number: number): Element[] {
  const circle = document.createElementNS(SVG, 'circle');
  const text = document.createElementNS(SVG, 'text');
  const away = 1 + 13 / Math.hypot(x, y);
  const attributes = { cx: x, cy: y, r: 3.5 };
  for (const [name, value] of Object.entries(attributes)) circle.setAttribute(name, String(value));
  text.setAttribute('x', String(away * x));
  text.setAttribute('y', String(away * y + 4));
  text.textContent = String(number);
  return [circle, text];
}

load2d().then(() => {
  wireTies();
  drawRounding();
});
