// node node.mjs scan.ply, or without a file for a torus of generated points.
import { readFile, writeFile } from 'node:fs/promises';
import { delaunay3d, readPoints, verify } from 'gdel-wasm';

/** Points on a torus, evenly spread. */
function torus(count) {
  return Array.from({ length: count }, (_, i) => {
    const [u, v] = [(2 * Math.PI * i) / count, Math.PI * (Math.sqrt(5) - 1) * i];
    const r = 20 + 8 * Math.cos(v);
    return [r * Math.cos(u), r * Math.sin(u), 8 * Math.sin(v)];
  });
}

const [, , name] = process.argv;
const points = name
  ? (await readPoints(await readFile(name), { name })).points
  : Float32Array.from(torus(4000).flat());
const mesh = await delaunay3d(points);
console.log(`${mesh.tetrahedra.length / 4} tetrahedra of ${mesh.points.length / 3} points`);

const { passed, checks } = await verify(points, mesh);
console.log(`${checks.length} exact checks: ${passed ? 'passed' : 'FAILED'}`);

const surface = await mesh.surface();
console.log(
  `surface: ${surface.triangles.length / 3} triangles, ${surface.components} piece, genus ${surface.genus}`,
);
console.log(`volume: ${surface.volume.toFixed(0)} mm³, area: ${surface.area.toFixed(0)} mm²`);

await writeFile('surface.stl', await surface.toSTL());
console.log('surface.stl is for a printer');
