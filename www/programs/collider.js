import RAPIER from '@dimforge/rapier3d-compat';
import { delaunay3d, readPoints } from 'gdel-wasm';
import * as THREE from 'three';

const file = await fetch('bunny.ply');
const cloud = await readPoints(await file.arrayBuffer(), { format: 'ply' });
const mesh = await delaunay3d(cloud.points);
const surface = await mesh.surface();
// Ten times as large: physics engines prefer objects of about a metre.
const vertices = Float32Array.from(surface.vertices, (x) => 10 * x);

await RAPIER.init();
const world = new RAPIER.World({ x: 0, y: -9.81, z: 0 });
world.createCollider(RAPIER.ColliderDesc.trimesh(vertices, surface.triangles));
world.createCollider(RAPIER.ColliderDesc.cuboid(2, 0.1, 2).setTranslation(0, 0.23, 0));
const balls = Array.from({ length: 80 }, (_, i) => {
  const [x, z] = [-0.9 + 0.15 * (i % 10), -0.4 + 0.1 * Math.floor(i / 10)];
  const body = RAPIER.RigidBodyDesc.dynamic().setTranslation(x, 2 + 0.012 * i, z);
  const ball = world.createRigidBody(body);
  world.createCollider(RAPIER.ColliderDesc.ball(0.04).setRestitution(0.4), ball);
  return ball;
});

const scene = new THREE.Scene();
const geometry = new THREE.BufferGeometry();
geometry.setAttribute('position', new THREE.BufferAttribute(vertices, 3));
geometry.setIndex(new THREE.BufferAttribute(surface.triangles, 1));
geometry.computeVertexNormals();
const floor = new THREE.CircleGeometry(1.6, 48).rotateX(-Math.PI / 2).translate(0, 0.33, 0);
const paint = (color) => new THREE.MeshStandardMaterial({ color });
const light = new THREE.DirectionalLight('white', 2.5);
light.position.set(-1, 2, 3);
const drawn = new THREE.InstancedMesh(new THREE.SphereGeometry(0.04, 12, 8), paint('#d2602a'), 80);
scene.add(new THREE.Mesh(geometry, paint('#d8a47f')), new THREE.Mesh(floor, paint('#9aa5b1')));
scene.add(drawn, light, new THREE.AmbientLight('white', 0.8));

const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
renderer.setSize(720, 540, false);
const note = document.createElement('p');
document.body.append(note, renderer.domElement);
const camera = new THREE.PerspectiveCamera(35, 4 / 3, 0.1, 20);
camera.position.set(-0.2, 2.6, 5.4);
camera.lookAt(-0.1, 0.95, 0);

renderer.setAnimationLoop(() => {
  world.step();
  balls.forEach((ball, i) => {
    const { x, y, z } = ball.translation();
    drawn.setMatrixAt(i, new THREE.Matrix4().makeTranslation(x, y, z));
  });
  drawn.instanceMatrix.needsUpdate = true;
  const low = balls.filter((ball) => ball.translation().y < 0.5).length;
  note.textContent = `${surface.triangles.length / 3} triangles, ${low} of 80 balls are down`;
  renderer.render(scene, camera);
});
