import { Deck, OrbitView } from '@deck.gl/core';
import { PointCloudLayer } from '@deck.gl/layers';
import { delaunay3d, readPoints } from 'gdel-wasm';

const file = await fetch('bunny.ply');
const { points } = await readPoints(await file.arrayBuffer(), { format: 'ply' });
const count = points.length / 3;

// How far the sixth nearest point is: where the scanner saw little, that is far.
const mesh = await delaunay3d(points);
const nearest = await mesh.nearest(points, { k: 7 });
const place = (i) => points.subarray(3 * i, 3 * i + 3);
const far = Float32Array.from({ length: count }, (_, i) => {
  const [x, y, z] = place(nearest[7 * i + 6]);
  const [px, py, pz] = place(i);
  return Math.hypot(x - px, y - py, z - pz);
});
const usual = far.toSorted()[(count / 2) | 0];

const colors = new Uint8Array(3 * count);
far.forEach((distance, i) => {
  const warm = Math.min(1, Math.max(0, distance / usual - 0.6));
  colors.set([60 + 180 * warm, 130 - 30 * warm, 200 - 170 * warm], 3 * i);
});

const note = document.createElement('p');
note.textContent = `${count} points; the sixth nearest is usually ${(1000 * usual).toFixed(1)} mm away`;
const canvas = document.createElement('canvas');
const frame = document.createElement('div');
frame.style = 'position: relative; height: 480px';
frame.append(canvas);
document.body.append(note, frame);

new Deck({
  canvas,
  parent: frame,
  views: new OrbitView({ orbitAxis: 'Y' }),
  controller: true,
  initialViewState: { target: [-0.02, 0.11, 0], zoom: 11, rotationX: 10, rotationOrbit: 20 },
  layers: [
    new PointCloudLayer({
      data: {
        length: count,
        attributes: {
          getPosition: { value: points, size: 3 },
          getColor: { value: colors, size: 3, normalized: true },
        },
      },
      pointSize: 2,
      material: false,
    }),
  ],
  onAfterRender: () => frame.setAttribute('data-drawn', count),
});
