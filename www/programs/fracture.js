import { delaunay3d, generate } from 'gdel-wasm';
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const SHARDS = 60;
// Nearer to one corner, so that shards are smaller where the block was hit.
const seeds = (await generate('uniform', SHARDS, { seed: 3 })).map((x) => x ** 1.7);
const mesh = await delaunay3d(seeds);
const voronoi = await mesh.voronoi({ clip: [0, 0, 0, 1, 1, 1] });
const { vertices, cells, facets, facetOffsets, centroids, volumes } = voronoi;

/** The triangles of a cell, around its centre. */
function shard(cell) {
  const corners = [];
  const centre = centroids.subarray(3 * cell, 3 * cell + 3);
  for (let facet = cells[cell]; facet < cells[cell + 1]; facet++) {
    const [first, ...others] = facets.subarray(facetOffsets[facet], facetOffsets[facet + 1]);
    // Facets are convex.
    for (let i = 0; i + 1 < others.length; i++)
      for (const v of [first, others[i], others[i + 1]])
        for (let axis = 0; axis < 3; axis++) corners.push(vertices[3 * v + axis] - centre[axis]);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners, 3));
  geometry.computeVertexNormals();
  const color = new THREE.Color().setHSL(0.06 + 0.002 * cell, 0.45, 0.6);
  return new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ color, roughness: 0.8 }));
}

const scene = new THREE.Scene();
const shards = Array.from({ length: SHARDS }, (_, cell) => shard(cell));
const light = new THREE.DirectionalLight('white', 3);
light.position.set(3, 5, 2);
scene.add(...shards, light, new THREE.AmbientLight('white', 0.8));

document.body.innerHTML = `<p></p>
  <label>Apart <input type="range" min="1" max="2" step="0.01" value="1.25"></label>`;
const [note, { firstElementChild: slider }] = document.body.children;
const volume = volumes.reduce((sum, v) => sum + v);
note.textContent = `${shards.length} shards, whose volumes add up to ${volume.toFixed(6)}`;
const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
renderer.setSize(720, 540, false);
document.body.append(renderer.domElement);
const camera = new THREE.PerspectiveCamera(35, 4 / 3, 0.1, 20);
camera.position.set(-2, 1.6, 2.6);
function draw() {
  shards.forEach((shard, i) => {
    shard.position
      .fromArray(centroids, 3 * i)
      .subScalar(0.5)
      .multiplyScalar(slider.valueAsNumber);
  });
  renderer.render(scene, camera);
}
slider.oninput = draw;
new OrbitControls(camera, renderer.domElement).addEventListener('change', draw);
draw();
