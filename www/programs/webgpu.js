import { createTriangulator } from 'gdel-wasm';
import * as THREE from 'three/webgpu';

const adapter = await navigator.gpu?.requestAdapter();
if (adapter) await show(await adapter.requestDevice());
else document.body.textContent = 'This browser offers no WebGPU, which this example needs.';

async function show(device) {
  // three.js and the triangulation use one device.
  const renderer = new THREE.WebGPURenderer({ device, antialias: true, alpha: true });
  await renderer.init();
  renderer.setSize(600, 600, false);
  const note = document.createElement('p');
  renderer.domElement.style = 'max-width: 500px';
  document.body.append(note, renderer.domElement);

  // A ball with bumps.
  const points = new Float32Array(3 * 3000);
  for (let i = 0; i < points.length; i += 3) {
    const direction = new THREE.Vector3().randomDirection();
    const { x, y, z } = direction;
    const bumps = 1 + 0.03 * Math.sin(9 * x) * Math.sin(9 * y) * Math.sin(9 * z);
    direction.multiplyScalar(bumps).toArray(points, i);
  }
  const triangulator = await createTriangulator({ device, backend: 'gpu' });
  const mesh = await triangulator.delaunay3d(points, { resident: true });
  note.textContent = `${mesh.hullCount} triangles of the hull never left the GPU`;

  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(points, 3));
  // three.js asks an index for its length, and uploads its array unless it has a buffer for it.
  const index = new THREE.BufferAttribute(new Uint32Array(3 * mesh.hullCount), 1);
  renderer.backend.get(index).buffer = mesh.buffers.hull;
  geometry.setIndex(index);

  const material = new THREE.MeshStandardMaterial({ color: '#d2803a', flatShading: true });
  const ball = new THREE.Mesh(geometry, material);
  const light = new THREE.DirectionalLight('white', 3);
  light.position.set(2, 3, 4);
  const scene = new THREE.Scene();
  scene.add(ball, light, new THREE.AmbientLight('white', 0.5));
  const camera = new THREE.PerspectiveCamera(35, 1, 0.1, 20);
  camera.position.z = 4;
  const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
  const draw = (time) => {
    ball.rotation.y = time / 4000;
    renderer.render(scene, camera);
  };
  if (still) draw(0);
  else renderer.setAnimationLoop(draw);
}
