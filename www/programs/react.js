import { delaunay2d } from 'gdel-wasm';
import htm from 'htm';
import { createElement, useEffect, useState } from 'react';
import { createRoot } from 'react-dom/client';

// JSX without a build step.
const html = htm.bind(createElement);
const BOX = [0, 0, 720, 440];

/** The Voronoi cells of points, which come a moment after the points. */
function useVoronoi(points) {
  const [cells, setCells] = useState([]);
  useEffect(() => {
    let current = true;
    (async () => {
      const mesh = await delaunay2d(points);
      const voronoi = await mesh.voronoi({ clip: BOX });
      if (current) setCells([...voronoi.cellPolygons()]);
    })();
    return () => {
      current = false;
    };
  }, [points]);
  return cells;
}

function Cells({ points, onPoint }) {
  const cells = useVoronoi(points);
  const click = ({ currentTarget, clientX, clientY }) => {
    const place = new DOMPoint(clientX, clientY).matrixTransform(
      currentTarget.getScreenCTM().inverse(),
    );
    onPoint([place.x, place.y]);
  };
  return html`<svg viewBox=${BOX.join(' ')} onClick=${click} stroke="white" strokeWidth="2">
    ${cells.map(
      (cell) => html`<polygon key=${cell.index} points=${cell.join(' ')}
      fill="hsl(${cell.index * 137.5} 50% 65%)" />`,
    )}
    ${points.map(([cx, cy], i) => html`<circle key=${i} cx=${cx} cy=${cy} r="4" fill="#222" />`)}
  </svg>`;
}

const somewhere = () => [BOX[2] * Math.random(), BOX[3] * Math.random()];

function App() {
  const [points, setPoints] = useState(() => Array.from({ length: 24 }, somewhere));
  const add = (point) => setPoints([...points, point]);
  return html`<p>${points.length} points. A click on the picture adds one.</p>
    <button onClick=${() => add(somewhere())}>Add a point anywhere</button>
    <${Cells} points=${points} onPoint=${add} />`;
}

createRoot(document.body.appendChild(document.createElement('main'))).render(html`<${App} />`);
