import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import {
  BufferAttribute, BufferGeometry, Color, Group, InstancedBufferAttribute, InstancedBufferGeometry, LineSegments, type Material, Mesh,
  type Object3D, PerspectiveCamera, Raycaster, Scene, Sphere, Spherical, Sprite, Vector2, Vector3, WebGPURenderer,
} from 'three/webgpu';
import { FACETS } from '../geometry/mesh';
import type { Ray } from '../geometry/pick';
import type { Pieces } from '../geometry/pieces';
import type { Surface } from '../geometry/surface';
import type { ColorMapName } from './colormap';
import { accentMaterial, hullMaterial, Look, outlineMaterial, piecesMaterial, pointsMaterial, surfaceMaterial } from './materials';

/** Where the camera is: the direction from the target as angles, the distance, and the target. */
export type CameraPose = [azimuth: number, elevation: number, distance: number, x: number, y: number, z: number];

const EVERYWHERE = new Sphere(new Vector3(), Infinity);

/** Draws a mesh into a canvas, and only when something changed. */
export class Viewer {
  readonly look = new Look();
  private readonly scene = new Scene();
  /** Holds all layers, turned so that the model's own up is up. */
  private readonly model = new Group();
  private readonly camera = new PerspectiveCamera(38, 1, 0.01, 100);
  private readonly controls: OrbitControls;
  private frame = 0;
  private readonly layers: {
    surface: Mesh; pieces: Mesh; hull: Mesh; facets: Mesh; outline: LineSegments; points: Sprite | null;
  };

  private constructor(
    private readonly renderer: WebGPURenderer,
    private readonly canvas: HTMLCanvasElement,
    onCamera: () => void,
  ) {
    this.scene.add(this.model);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.minDistance = 0.05;
    this.controls.maxDistance = 20;
    this.controls.addEventListener('change', () => {
      this.render();
      onCamera();
    });
    this.layers = {
      surface: this.add(new Mesh(new BufferGeometry(), surfaceMaterial(this.look))),
      pieces: this.add(new Mesh(new BufferGeometry(), piecesMaterial(this.look))),
      hull: this.add(new Mesh(new BufferGeometry(), hullMaterial(this.look)), 2),
      facets: this.add(new Mesh(new BufferGeometry(), accentMaterial(this.look)), 3),
      outline: this.add(new LineSegments(new BufferGeometry(), outlineMaterial(this.look)), 4),
      points: null,
    };
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    this.resize();
  }

  /** Fails where the browser can draw neither with WebGPU nor with WebGL 2. */
  static async create(canvas: HTMLCanvasElement, onCamera: () => void, onLost: () => void): Promise<Viewer> {
    const renderer = new WebGPURenderer({ canvas, antialias: true, alpha: true });
    renderer.onDeviceLost = onLost;
    await renderer.init();
    return new Viewer(renderer, canvas, onCamera);
  }

  /** What the drawing goes through. */
  get api(): 'WebGPU' | 'WebGL 2' {
    return 'isWebGPUBackend' in this.renderer.backend ? 'WebGPU' : 'WebGL 2';
  }

  showSurface(surface: Surface | null): void {
    this.replace(this.layers.surface, surface && triangles(surface.positions, surface.values));
  }

  showPieces(pieces: Pieces | null): void {
    this.replace(this.layers.pieces, pieces && instances(pieces));
  }

  showHull(positions: Float32Array | null): void {
    this.replace(this.layers.hull, positions && triangles(positions));
  }

  /** Points some facets out, nine coordinates each. */
  showFacets(positions: Float32Array | null): void {
    this.replace(this.layers.facets, positions && triangles(positions));
  }

  /** Outlines one tetrahedron, given by its four corners' twelve coordinates. */
  showOutline(corners: Float32Array | null): void {
    const edges = [0, 1, 0, 2, 0, 3, 1, 2, 1, 3, 2, 3];
    const lines = corners && new Float32Array(edges.flatMap((k) => [...corners.subarray(3 * k, 3 * k + 3)]));
    this.replace(this.layers.outline, lines && triangles(lines));
  }

  showPoints(positions: Float32Array | null): void {
    const old = this.layers.points;
    if (old) {
      this.model.remove(old);
      old.material.dispose();
      this.layers.points = null;
    }
    if (positions && positions.length > 0) {
      const points = new Sprite(pointsMaterial(this.look, new InstancedBufferAttribute(positions, 3)));
      points.count = positions.length / 3;
      this.look.pointSize.value = points.count < 1000 ? 4 : 1.5;
      // Many points on a small canvas would cover everything.
      const { clientWidth, clientHeight } = this.canvas;
      this.look.pointOpacity.value = Math.min(0.5, Math.max(0.04, 0.068 * Math.sqrt((clientWidth * clientHeight) / points.count)));
      points.renderOrder = 1;
      points.frustumCulled = false;
      this.model.add(points);
      this.layers.points = points;
    }
    this.render();
  }

  /** Shows or hides what a layer holds, without giving it up. */
  setVisible(layer: 'surface' | 'pieces' | 'hull' | 'facets' | 'points', visible: boolean): void {
    const object = this.layers[layer];
    if (object) object.visible = visible && (layer === 'points' || object.geometry.hasAttribute('position'));
    this.render();
  }

  setColorMap(map: ColorMapName | 'phases'): void {
    this.look.setMap(map);
    this.render();
  }

  setTheme(ink: string, accent: string): void {
    this.look.ink.value = new Color(ink);
    this.look.accent.value = new Color(accent);
    this.render();
  }

  /** Which of the model's axes points up. */
  setUp(up: 'y' | 'z'): void {
    this.model.rotation.x = up === 'z' ? -Math.PI / 2 : 0;
    this.model.updateMatrixWorld();
    this.render();
  }

  get pose(): CameraPose {
    const { x, y, z } = this.controls.target;
    const around = new Spherical().setFromVector3(this.camera.position.clone().sub(this.controls.target));
    return [around.theta, Math.PI / 2 - around.phi, around.radius, x, y, z];
  }

  set pose([azimuth, elevation, distance, x, y, z]: CameraPose) {
    this.controls.target.set(x, y, z);
    const phi = Math.min(Math.PI - 1e-3, Math.max(1e-3, Math.PI / 2 - elevation));
    this.camera.position.setFromSpherical(new Spherical(distance, phi, azimuth)).add(this.controls.target);
    this.controls.update();
    this.render();
  }

  /** Turns and approaches, as the arrow keys ask. */
  orbit(azimuth: number, elevation: number, zoom: number): void {
    const [a, e, d, ...target] = this.pose;
    this.pose = [a + azimuth, Math.min(1.55, Math.max(-1.55, e + elevation)), d * zoom, ...target];
  }

  /** The direction from the model to the camera, in the model's axes, of length 1. */
  get towardsCamera(): [number, number, number] {
    const direction = this.camera.position.clone().sub(this.controls.target).normalize();
    return direction.applyQuaternion(this.model.quaternion.clone().invert()).toArray();
  }

  /** The ray through a place on the canvas, in CSS pixels from its top left corner, in the model's axes. */
  ray(x: number, y: number): Ray {
    const { clientWidth, clientHeight } = this.canvas;
    const caster = new Raycaster();
    this.camera.updateMatrixWorld();
    caster.setFromCamera(new Vector2((x / clientWidth) * 2 - 1, 1 - (y / clientHeight) * 2), this.camera);
    const { origin, direction } = caster.ray.applyMatrix4(this.model.matrixWorld.clone().invert());
    return { origin: origin.toArray(), direction: direction.toArray() };
  }

  /** Draws soon, once however often it is called before. */
  render(): void {
    this.frame ||= requestAnimationFrame(() => {
      this.frame = 0;
      this.renderer.render(this.scene, this.camera);
    });
  }

  /** Resolves after the next drawing has been handed to the browser. */
  drawn(): Promise<void> {
    this.render();
    return new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(() => resolve())));
  }

  private add<T extends Object3D>(object: T, order = 0): T {
    object.renderOrder = order;
    object.visible = false;
    object.frustumCulled = false;
    this.model.add(object);
    return object;
  }

  private replace(layer: Object3D & { geometry: BufferGeometry; material: Material | Material[] }, geometry: BufferGeometry | null) {
    layer.geometry.dispose();
    layer.geometry = geometry ?? new BufferGeometry();
    layer.visible = geometry !== null;
    this.render();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas.parentElement!;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(clientWidth, clientHeight);
    this.camera.aspect = clientWidth / clientHeight;
    // The smaller side of the canvas sees the same angle, whichever side it is.
    this.camera.fov = (360 / Math.PI) * Math.atan(Math.tan(Math.PI / 9.5) / Math.min(1, this.camera.aspect));
    // The title is at the top left: the model makes room, sidewards where there is width, else downwards.
    const [right, down] = clientWidth > 700 ? [0.07 * clientWidth, 0.02 * clientHeight] : [0, 0.05 * clientHeight];
    this.camera.setViewOffset(clientWidth, clientHeight, -right, -down, clientWidth, clientHeight);
    this.render();
  }
}

function triangles(positions: Float32Array, values?: Float32Array): BufferGeometry | null {
  if (positions.length === 0) return null;
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  if (values) geometry.setAttribute('value', new BufferAttribute(values, 1));
  geometry.boundingSphere = EVERYWHERE;
  return geometry;
}

function instances({ a, b, c, d, values, owners }: Pieces): BufferGeometry | null {
  if (owners.length === 0) return null;
  const geometry = new InstancedBufferGeometry();
  const corners = new Float32Array(36);
  FACETS.forEach((corner, i) => (corners[3 * i] = corner));
  geometry.setAttribute('position', new BufferAttribute(corners, 3));
  for (const [name, array] of Object.entries({ a, b, c, d })) geometry.setAttribute(name, new InstancedBufferAttribute(array, 3));
  geometry.setAttribute('value', new InstancedBufferAttribute(values, 1));
  geometry.instanceCount = owners.length;
  geometry.boundingSphere = EVERYWHERE;
  return geometry;
}
