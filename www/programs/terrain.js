import { tin } from 'gdel-wasm/tin';
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

// Measured heights: hills, and a dam with steep sides along a curve.
const along = (x) => 12 * Math.sin(x / 25);
const ground = (x, y) => 6 * Math.sin(x / 18) * Math.cos(y / 14) + 3 * Math.sin(x / 7 + y / 9);
const height = (x, y) => Math.max(ground(x, y), 9 - 3 * Math.max(0, Math.abs(y - along(x)) - 2));
const points = [];
for (let x = -60; x <= 60; x += 1.5)
  for (let y = -40; y <= 40; y += 1.5) points.push([x, y, height(x, y)]);

// The edges of its crown are lines that were measured, too.
const breaklines = [];
for (const side of [-2, 2]) {
  for (let x = -60; x <= 60; x += 2) {
    if (x > -60) breaklines.push([points.length - 1, points.length]);
    points.push([x, along(x) + side, 9]);
  }
}

const terrain = await tin(points, { maxError: 0.25, edges: breaklines });
const { vertices, triangles, edges } = terrain;

const note = document.createElement('p');
const error = terrain.maxError.toFixed(2);
const counts = `${vertices.length / 3} of ${points.length} points`;
note.textContent = `${counts} are within ${error} m of all, with ${edges.length / 2} edges of breaklines`;
const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
renderer.setSize(720, 480, false);
document.body.append(note, renderer.domElement);

const geometry = new THREE.BufferGeometry();
geometry.setAttribute('position', new THREE.BufferAttribute(Float32Array.from(vertices), 3));
geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
const lines = new THREE.BufferGeometry();
lines.setAttribute('position', geometry.getAttribute('position'));
lines.setIndex(new THREE.BufferAttribute(edges, 1));

const scene = new THREE.Scene();
const grass = new THREE.MeshStandardMaterial({ color: '#8fa876', flatShading: true });
// A little behind the lines on it.
Object.assign(grass, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
const wires = new THREE.MeshBasicMaterial({ color: '#647a52', wireframe: true });
scene.add(new THREE.Mesh(geometry, grass), new THREE.Mesh(geometry, wires));
scene.add(new THREE.LineSegments(lines, new THREE.LineBasicMaterial({ color: '#ff7a30' })));
const light = new THREE.DirectionalLight('white', 2.5);
light.position.set(-2, 1, 2);
scene.add(light, new THREE.AmbientLight('white', 0.8));

const camera = new THREE.PerspectiveCamera(35, 3 / 2, 1, 1000);
camera.up.set(0, 0, 1);
camera.position.set(45, -100, 75);
const draw = () => renderer.render(scene, camera);
new OrbitControls(camera, renderer.domElement).addEventListener('change', draw);
draw();
