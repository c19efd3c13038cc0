import assert from 'node:assert/strict';
import { test } from 'node:test';
import { delaunay2d, generate2d } from 'gdel-wasm';
import { frameOf } from '../../src/geometry/mesh';
import { voronoiEdges } from '../../src/geometry/voronoi';
import { columnsIn, powerEdges } from '../../src/model/weighted';

const BOX = { low: [-2, -2], high: [2, 2] } as const;

/** Made before the server ends that loads the parts of the package. */
const weighted = await (async () => {
  const points = await generate2d('uniform', 100, { seed: 5 });
  const weights = Float64Array.from({ length: 100 }, (_, i) => ((i * 37) % 100) / 8000);
  return { points, weights, mesh: await delaunay2d(points, { weights }) };
})();

test('columns of radii and weights are found by their names', () => {
  const of = (text: string) =>
    columnsIn(text).map(({ name, isWeight, values }) => [name, isWeight, [...values]]);
  assert.deepEqual(of('x,y,z,radius\n1,2,3,0.5\n4,5,6,1\n'), [['radius', false, [0.5, 1]]]);
  assert.deepEqual(of('# x y z weight r\n1 2 3 -4 5\n\n// end\n6 7 8 9 10'), [
    ['weight', true, [-4, 9]],
    ['r', false, [5, 10]],
  ]);
  assert.deepEqual(of('"x";"y";"diameter"\n1;2;3\n'), [['diameter', false, [1.5]]]);
  for (const text of [
    '',
    'x,y,z\n1,2,3',
    '1,2,3,4\n5,6,7,8',
    'x,y,r\n1,2,-3',
    'x,y,r\n1,2,\n3,4,5',
  ])
    assert.deepEqual(of(text), [], text);
});

test('without weights, the power diagram is the Voronoi diagram', async () => {
  const points = await generate2d('uniform', 200, { seed: 4 });
  const mesh = await delaunay2d(points);
  const frame = frameOf(points, 2);
  const drawn = { positions: new Float32Array(), ...mesh, triangles: mesh.triangles };
  const one = voronoiEdges(points, frame, drawn, BOX).ends;
  const other = powerEdges(points, new Float64Array(200), frame, drawn, BOX).ends;
  assert.equal(one.length, other.length);
  one.forEach((x, i) => {
    assert.ok(Math.abs(x - other[i]) < 1e-4, `${x} ${other[i]}`);
  });
});

test('the edges of a power diagram are those of the package', async () => {
  const { points, weights, mesh } = weighted;
  assert.ok(mesh.hidden.length > 0);
  const frame = { center: [0, 0, 0] as [number, number, number], scale: 1 };
  const box = { low: [0, 0], high: [1, 1] } as const;
  const drawn = { positions: new Float32Array(), ...mesh, triangles: mesh.triangles };
  const { ends } = powerEdges(points, weights, frame, drawn, box);
  let length = 0;
  for (let i = 0; i < ends.length; i += 6)
    length += Math.hypot(ends[i] - ends[i + 3], ends[i + 1] - ends[i + 4]);
  const { areas, neighbors } = await mesh.voronoi({ clip: [0, 0, 1, 1] });
  const inside = areas.reduce((sum, own, f) => sum + (neighbors[f] >= 0 ? own / 2 : 0), 0);
  assert.ok(Math.abs(length - inside) < 1e-4, `${length} ${inside}`);
});
