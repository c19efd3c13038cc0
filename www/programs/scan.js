import { delaunay3d, readPoints } from 'gdel-wasm';
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

// Points of a scan: without triangles, and without normals.
const file = await fetch('bunny.ply');
const { points } = await readPoints(await file.arrayBuffer(), { format: 'ply' });
const mesh = await delaunay3d(points);
const surface = await mesh.surface();

document.body.innerHTML = '<p></p><button>Save for a printer (STL)</button>';
const [note, button] = document.body.children;
const kind = surface.closed ? 'watertight' : 'open';
const volume = (1e6 * surface.volume).toFixed(0);
note.textContent = `${points.length / 3} points, ${surface.triangles.length / 3} triangles: ${kind}, ${volume} cm³`;

button.onclick = async () => {
  const stl = new Blob([await surface.toSTL()], { type: 'model/stl' });
  const link = document.createElement('a');
  link.href = URL.createObjectURL(stl);
  link.download = 'bunny.stl';
  link.click();
};

const geometry = new THREE.BufferGeometry();
geometry.setAttribute('position', new THREE.BufferAttribute(surface.vertices, 3));
geometry.setIndex(new THREE.BufferAttribute(surface.triangles, 1));
geometry.computeVertexNormals();
geometry.center();

const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
renderer.setSize(720, 540, false);
document.body.append(renderer.domElement);

const scene = new THREE.Scene();
scene.add(new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ color: '#d8a47f' })));
const light = new THREE.DirectionalLight('white', 2.5);
light.position.set(-1, 2, 3);
scene.add(light, new THREE.AmbientLight('white', 0.6));

const camera = new THREE.PerspectiveCamera(35, 4 / 3, 0.01, 10);
camera.position.set(0.05, 0.08, 0.32);
const draw = () => renderer.render(scene, camera);
new OrbitControls(camera, renderer.domElement).addEventListener('change', draw);
draw();
