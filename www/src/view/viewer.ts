import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { float } from 'three/tsl';
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  Group,
  IndirectStorageBufferAttribute,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  type Material,
  Matrix4,
  Mesh,
  MOUSE,
  type Object3D,
  PerspectiveCamera,
  Quaternion,
  Raycaster,
  Scene,
  Sphere,
  Spherical,
  StorageBufferAttribute,
  TOUCH,
  Vector2,
  Vector3,
  WebGPURenderer,
} from 'three/webgpu';
import type { Dimension } from '../geometry/dimension';
import { FACETS } from '../geometry/mesh';
import type { Ray } from '../geometry/pick';
import type { Pieces } from '../geometry/pieces';
import type { Surface } from '../geometry/surface';
import { fromScreen, HALF_VIEW, type Up } from '../geometry/up';
import type { Voronoi } from '../geometry/voronoi';
import type { ColorMapName } from './colormap';
import type { Cut } from './cut';
import {
  accentMaterial,
  type CutAttributes,
  cutMaterial,
  flatMaterial,
  hullMaterial,
  instancedPoints,
  Look,
  linesMaterial,
  piecesMaterial,
  pointsMaterial,
  storedPoints,
  surfaceMaterial,
  voronoiMaterial,
} from './materials';

/**
 * Where the camera is: the direction from the target as angles, the distance, and the target. In 2D
 * it looks straight down.
 */
export type CameraPose = [
  azimuth: number,
  elevation: number,
  distance: number,
  x: number,
  y: number,
  z: number,
];

const EVERYWHERE = new Sphere(new Vector3(), Infinity);

/** What can be shown and hidden. The hull and the surface have one layer for 3D and one for 2D. */
interface Layers {
  surface: Mesh;
  cut: Mesh | null;
  flat: Mesh;
  pieces: Mesh;
  hull: Mesh;
  hullEdges: Mesh;
  voronoi: Mesh;
  facets: Mesh;
  outline: Mesh;
  ruler: Mesh;
  points: Mesh | null;
}

/** Draws a mesh into a canvas, and only when something changed. */
export class Viewer {
  readonly look = new Look();
  private readonly scene = new Scene();
  /** Holds all layers, turned so that the model's own up is up. */
  private readonly model = new Group();
  private readonly camera = new PerspectiveCamera(38, 1, 0.01, 100);
  private readonly controls: OrbitControls;
  private frame = 0;
  /** Whether the camera is being placed by the page. */
  private placing = false;
  private dimension: Dimension = 3;
  private pointCount = 0;
  /** Whether nothing was to be seen in the last picture; null before there is one. */
  private isEmpty: boolean | null = null;
  /** The mesh that the GPU cuts, and how. */
  private cut: { mesh: Cut; level: number; skin: boolean } | null = null;
  private readonly layers: Layers;

  private constructor(
    private readonly renderer: WebGPURenderer,
    private readonly canvas: HTMLCanvasElement,
    private readonly onCamera: () => void,
    private readonly onSize: () => void,
  ) {
    this.scene.add(this.model);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.minDistance = 0.05;
    this.controls.maxDistance = 20;
    this.controls.addEventListener('change', () => {
      this.render();
      if (!this.placing) onCamera();
    });
    const { look } = this;
    this.layers = {
      surface: this.add(new Mesh(new BufferGeometry(), surfaceMaterial(look))),
      cut: null,
      flat: this.add(new Mesh(new BufferGeometry(), flatMaterial(look))),
      pieces: this.add(new Mesh(new BufferGeometry(), piecesMaterial(look))),
      voronoi: this.add(new Mesh(new BufferGeometry(), voronoiMaterial(look)), 1),
      hull: this.add(new Mesh(new BufferGeometry(), hullMaterial(look)), 2),
      hullEdges: this.add(
        new Mesh(new BufferGeometry(), linesMaterial(look, look.ink, 2, float(0.8))),
        2,
      ),
      facets: this.add(new Mesh(new BufferGeometry(), accentMaterial(look)), 4),
      outline: this.add(
        new Mesh(new BufferGeometry(), linesMaterial(look, look.ink, 2, float(1))),
        5,
      ),
      ruler: this.add(
        new Mesh(new BufferGeometry(), linesMaterial(look, look.accent, 3, float(1))),
        6,
      ),
      points: null,
    };
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    this.resize();
  }

  /** Fails where the browser can draw neither with WebGPU nor with WebGL 2. */
  static async create(
    canvas: HTMLCanvasElement,
    onCamera: () => void,
    onSize: () => void,
    onLost: () => void,
  ): Promise<Viewer> {
    const renderer = new WebGPURenderer({
      canvas,
      antialias: true,
      alpha: true,
      requiredLimits: await limitsForMeshes(),
    });
    renderer.onDeviceLost = onLost;
    await renderer.init();
    return new Viewer(renderer, canvas, onCamera, onSize);
  }

  /** What the drawing goes through. */
  get api(): 'WebGPU' | 'WebGL 2' {
    return 'isWebGPUBackend' in this.renderer.backend ? 'WebGPU' : 'WebGL 2';
  }

  /** The device that draws, if it can cut meshes by itself. */
  get device(): GPUDevice | null {
    const { backend } = this.renderer;
    const device = 'device' in backend ? (backend.device as GPUDevice | null) : null;
    return device?.features.has('core-features-and-limits') ? device : null;
  }

  /** Switches to 3D or 2D, and removes what was shown. */
  setDimension(dimension: Dimension): void {
    if (dimension === this.dimension) return;
    this.hideCut();
    this.dimension = dimension;
    const flat = dimension === 2;
    for (const layer of Object.values<Mesh | null>(this.layers as never))
      if (layer) this.replace(layer, null);
    this.showPoints(null);
    this.controls.enableRotate = !flat;
    this.controls.zoomToCursor = flat;
    this.controls.mouseButtons.LEFT = flat ? MOUSE.PAN : MOUSE.ROTATE;
    this.controls.touches.ONE = flat ? TOUCH.PAN : TOUCH.ROTATE;
    this.controls.minDistance = flat ? 0.001 : 0.05;
    this.camera.near = flat ? 1e-4 : 0.01;
    this.resize();
  }

  /** Shows triangles, or nothing; no longer those that the GPU finds. */
  showSurface(surface: Surface | null): void {
    this.hideCut();
    const layer = this.dimension === 2 ? this.layers.flat : this.layers.surface;
    this.replace(layer, surface && triangles(surface.positions, surface));
  }

  /** Shows what the GPU finds below a level, on the next frame, and with `skin` what is outside. */
  showCut(mesh: Cut, level: number, skin: boolean): void {
    if (this.cut?.mesh !== mesh) {
      this.showSurface(null);
      this.layers.cut = this.add(this.cutLayer(mesh));
      this.layers.cut.visible = true;
    }
    this.cut = { mesh, level, skin };
    this.render();
  }

  /** Moves the plane, if what is shown is what the GPU finds. */
  moveCut(level: number): void {
    if (!this.cut) return;
    this.showCut(this.cut.mesh, level, this.cut.skin);
    this.look.pointsAbove.value = Math.min(level, 1e9);
  }

  /** Who finds the surface that is shown. */
  get cutBy(): 'GPU' | 'worker' {
    return this.cut ? 'GPU' : 'worker';
  }

  private hideCut(): void {
    const { cut } = this.layers;
    this.cut = this.layers.cut = null;
    if (cut) this.drop(cut);
  }

  private cutLayer(mesh: Cut): Mesh {
    /** Names a buffer for three.js, which would otherwise upload an array for it. */
    const named = <T extends StorageBufferAttribute>(attribute: T, buffer: GPUBuffer) => {
      (this.renderer.backend as unknown as { get(of: object): { buffer: GPUBuffer } }).get(
        attribute,
      ).buffer = buffer;
      return attribute;
    };
    const { facets, parts } = mesh;
    const { tetrahedra, positions, values, colors } = parts;
    const attributes = Object.entries({ facets, tetrahedra, positions, values, colors }).map(
      ([name, buffer]) => [name, named(new StorageBufferAttribute(new Uint32Array(1), 1), buffer)],
    );
    const geometry = new BufferGeometry();
    // What three.js asks geometries for: the material does without.
    geometry.setAttribute('position', new InstancedBufferAttribute(new Float32Array(3), 3));
    geometry.setIndirect(
      named(new IndirectStorageBufferAttribute(new Uint32Array(4), 4), mesh.draw),
    );
    geometry.boundingSphere = EVERYWHERE;
    const material = cutMaterial(this.look, Object.fromEntries(attributes) as CutAttributes);
    return new Mesh(geometry, material);
  }

  showVoronoi(diagram: Voronoi | null): void {
    this.replace(this.layers.voronoi, diagram && lines(diagram.ends));
    if (!diagram) return;
    const { low, high } = diagram.box;
    this.look.voronoiMiddle.value.set((low[0] + high[0]) / 2, (low[1] + high[1]) / 2);
    this.look.voronoiReach.value.set((high[0] - low[0]) / 2, (high[1] - low[1]) / 2);
  }

  showPieces(pieces: Pieces | null): void {
    this.replace(this.layers.pieces, pieces && instances(pieces));
  }

  /** The corners of the hull's facets: triangles in 3D, edges in 2D. */
  showHull(corners: Float32Array | null): void {
    if (this.dimension === 2) this.replace(this.layers.hullEdges, corners && lines(corners));
    else this.replace(this.layers.hull, corners && triangles(corners));
  }

  /** Points some facets out, nine coordinates each. */
  showFacets(positions: Float32Array | null): void {
    this.replace(this.layers.facets, positions && triangles(positions));
  }

  /** Lines around one simplex, two ends of three coordinates each. */
  showOutline(ends: Float32Array | null): void {
    this.replace(this.layers.outline, ends && lines(ends));
  }

  /** The lines of a measurement, two ends of three coordinates each. */
  showRuler(ends: Float32Array | null): void {
    this.replace(this.layers.ruler, ends && lines(ends));
  }

  /** Three coordinates per point, and where they have colours, red, green and blue. */
  showPoints(positions: Float32Array | null, colors: Uint8Array | null = null): void {
    const old = this.layers.points;
    if (old) {
      this.drop(old);
      this.layers.points = null;
    }
    this.pointCount = positions ? positions.length / 3 : 0;
    if (positions && this.pointCount > 0) {
      const points = this.add(this.pointsLayer(positions, colors && inFours(colors)), 1);
      const count = this.pointCount;
      this.look.pointSize.value = count < 1000 ? 4 : 1.5;
      // Many points on a small canvas would cover everything.
      const { clientWidth, clientHeight } = this.canvas;
      this.look.pointOpacity.value = Math.min(
        0.5,
        Math.max(0.04, 0.068 * Math.sqrt((clientWidth * clientHeight) / count)),
      );
      points.visible = true;
      this.layers.points = points;
    }
    this.render();
  }

  /**
   * Points as triangles. An instance for each would leave GPUs idle, which work on many vertices of
   * an instance at once: so there is none where vertices can read the buffers by themselves.
   */
  private pointsLayer(positions: Float32Array, colors: Uint8Array | null): Mesh {
    const { device, look } = this;
    const count = positions.length / 3;
    const geometry = new InstancedBufferGeometry();
    geometry.boundingSphere = EVERYWHERE;
    if (!device || positions.byteLength > device.limits.maxStorageBufferBindingSize) {
      geometry.setAttribute('place', new InstancedBufferAttribute(positions, 3));
      if (colors) geometry.setAttribute('color', new InstancedBufferAttribute(colors, 4, true));
      geometry.setDrawRange(0, 6);
      geometry.instanceCount = count;
      return new Mesh(geometry, pointsMaterial(look, instancedPoints(colors !== null)));
    }
    const places = new StorageBufferAttribute(positions, 1);
    const bytes = colors && new StorageBufferAttribute(new Uint32Array(colors.buffer), 1);
    // With the geometry, the buffers are freed.
    geometry.setAttribute('place', places);
    if (bytes) geometry.setAttribute('color', bytes);
    geometry.setDrawRange(0, 6 * count);
    geometry.instanceCount = 1;
    return new Mesh(geometry, pointsMaterial(look, storedPoints(places, bytes)));
  }

  /** Shows or hides what a layer holds, without giving it up. */
  setVisible(layer: Exclude<keyof Layers, 'outline' | 'ruler'>, visible: boolean): void {
    const object = this.layers[layer];
    if (object)
      object.visible = visible && (layer === 'points' || object.geometry.hasAttribute('position'));
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
  setUp(up: Up): void {
    this.model.quaternion.copy(turnTo(up));
    this.model.updateMatrixWorld();
    this.render();
  }

  get pose(): CameraPose {
    const { x, y, z } = this.controls.target;
    const around = new Spherical().setFromVector3(
      this.camera.position.clone().sub(this.controls.target),
    );
    return [around.theta, Math.PI / 2 - around.phi, around.radius, x, y, z];
  }

  set pose([azimuth, elevation, distance, x, y, z]: CameraPose) {
    this.controls.target.set(x, y, z);
    const phi = Math.min(Math.PI - 1e-3, Math.max(1e-3, Math.PI / 2 - elevation));
    this.camera.position
      .setFromSpherical(new Spherical(distance, phi, azimuth))
      .add(this.controls.target);
    this.placing = true;
    this.controls.update();
    this.placing = false;
    this.render();
  }

  /** Turns and approaches, as the arrow keys ask. */
  orbit(azimuth: number, elevation: number, zoom: number): void {
    const [a, e, d, ...target] = this.pose;
    this.pose = [a + azimuth, Math.min(1.55, Math.max(-1.55, e + elevation)), d * zoom, ...target];
    this.onCamera();
  }

  /** Moves the 2D view, by shares of what is visible. */
  pan(right: number, up: number): void {
    const [a, e, d, x, y, z] = this.pose;
    const [width, height] = this.seen;
    this.pose = [a, e, d, x + right * width, y + up * height, z];
    this.onCamera();
  }

  /** How much of the frame is visible, in 3D at the distance of what the camera looks at. */
  get seen(): [width: number, height: number] {
    const height = 2 * this.pose[2] * Math.tan((Math.PI / 360) * this.camera.fov);
    return [height * this.camera.aspect, height];
  }

  /** How many pixels a unit of the frame is long, at the distance of what the camera looks at. */
  get pixelsPerUnit(): number {
    return this.canvas.clientHeight / this.seen[1];
  }

  /** Returns the 2D place under a place on the canvas. */
  at2d(x: number, y: number): [x: number, y: number] {
    const { origin, direction } = this.ray(x, y);
    const t = -origin[2] / direction[2];
    return [origin[0] + t * direction[0], origin[1] + t * direction[1]];
  }

  /** Returns the place on the canvas of a place in the frame. */
  onCanvas(x: number, y: number, z = 0): [x: number, y: number] {
    this.camera.updateMatrixWorld();
    const projected = this.model.localToWorld(new Vector3(x, y, z)).project(this.camera);
    return [
      ((projected.x + 1) / 2) * this.canvas.clientWidth,
      ((1 - projected.y) / 2) * this.canvas.clientHeight,
    ];
  }

  /** The direction from the model to the camera, in the model's axes, of length 1. */
  get towardsCamera(): [number, number, number] {
    const direction = this.camera.position.clone().sub(this.controls.target).normalize();
    return direction.applyQuaternion(this.model.quaternion.clone().invert()).toArray();
  }

  /** Where the model's axes point on the screen: right, down, and towards the eye. */
  get axes(): [right: number, down: number, near: number][] {
    const turn = this.camera.quaternion.clone().invert().multiply(this.model.quaternion);
    return [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)].map((axis) => {
      const { x, y, z } = axis.applyQuaternion(turn);
      return [x, -y, z];
    });
  }

  /**
   * The ray through a place on the canvas, in CSS pixels from its top left corner, in the model's
   * axes.
   */
  ray(x: number, y: number): Ray {
    const { clientWidth, clientHeight } = this.canvas;
    const caster = new Raycaster();
    this.camera.updateMatrixWorld();
    caster.setFromCamera(
      new Vector2((x / clientWidth) * 2 - 1, 1 - (y / clientHeight) * 2),
      this.camera,
    );
    const { origin, direction } = caster.ray.applyMatrix4(this.model.matrixWorld.clone().invert());
    return { origin: origin.toArray(), direction: direction.toArray() };
  }

  /** Draws soon, once however often it is called before. */
  render(): void {
    this.frame ||= requestAnimationFrame(() => {
      this.frame = 0;
      const wasEmpty = this.isEmpty;
      this.isEmpty = !this.model.children.some(({ visible }) => visible);
      // The first picture of nothing is drawn: it prepares what all need.
      if (wasEmpty && this.isEmpty) return;
      if (this.dimension === 2) this.thinOut();
      this.cut?.mesh.at(this.cut.level, this.cut.skin);
      this.renderer.render(this.scene, this.camera);
    });
  }

  /** The drawing on the paper of the theme, as a PNG file. */
  async picture(): Promise<Uint8Array> {
    const { canvas } = this;
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext('2d')!;
    context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue('--paper');
    context.fillRect(0, 0, copy.width, copy.height);
    // What was drawn can be read until the browser shows it.
    this.renderer.render(this.scene, this.camera);
    context.drawImage(canvas, 0, 0);
    const blob = await new Promise<Blob | null>((resolve) => copy.toBlob(resolve, 'image/png'));
    if (!blob) throw new Error('The picture is too large.');
    return new Uint8Array(await blob.arrayBuffer());
  }

  /** Resolves after the next drawing has been handed to the browser. */
  drawn(): Promise<void> {
    this.render();
    return new Promise((resolve) =>
      requestAnimationFrame(() => requestAnimationFrame(() => resolve())),
    );
  }

  /**
   * In 2D, points and Voronoi diagram become smaller and paler where many of them are seen, and
   * come back near by.
   */
  private thinOut(): void {
    const count = Math.max(1, this.pointCount);
    // In pixels, of points spread over the unit circle.
    const apart = (this.canvas.clientHeight / this.seen[1]) * Math.sqrt(Math.PI / count);
    const { pointSize, pointOpacity, voronoiOpacity } = this.look;
    pointSize.value = Math.min(7, Math.max(1.2, 0.25 * apart));
    pointOpacity.value = Math.min(0.95, Math.max(0.1, apart / 14));
    voronoiOpacity.value = Math.min(0.95, Math.max(0, apart / 16 - 0.1));
  }

  private add<T extends Object3D>(object: T, order = 0): T {
    object.renderOrder = order;
    object.visible = false;
    object.frustumCulled = false;
    this.model.add(object);
    return object;
  }

  private drop(layer: Mesh): void {
    this.model.remove(layer);
    layer.geometry.dispose();
    (layer.material as Material).dispose();
  }

  private replace(
    layer: Object3D & { geometry: BufferGeometry; material: Material | Material[] },
    geometry: BufferGeometry | null,
  ) {
    if (!geometry && !layer.geometry.hasAttribute('position')) return;
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
    this.look.size.value.set(clientWidth, clientHeight);
    this.camera.aspect = clientWidth / clientHeight;
    // The smaller side of the canvas sees the same angle, whichever side it is.
    this.camera.fov = (360 / Math.PI) * Math.atan(HALF_VIEW / Math.min(1, this.camera.aspect));
    this.camera.updateProjectionMatrix();
    this.onSize();
    this.render();
  }
}

/**
 * The largest buffers that a device can have here: by themselves, devices allow smaller ones than
 * large meshes need.
 */
async function limitsForMeshes(): Promise<Record<string, number>> {
  const options = { featureLevel: 'compatibility' } as GPURequestAdapterOptions;
  const adapter = await navigator.gpu?.requestAdapter(options);
  if (!adapter) return {};
  const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
  return { maxBufferSize, maxStorageBufferBindingSize };
}

/** The turn that takes the input's axes to those of the screen. */
export function turnTo(up: Up): Quaternion {
  const axes = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ] as const;
  const [x, y, z] = axes.map((axis) => new Vector3(...fromScreen(up, axis)));
  return new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(x, y, z)).invert();
}

/** Colours of three bytes with a fourth: GPUs have no attributes of three. */
function inFours(colors: Uint8Array): Uint8Array {
  const fours = new Uint8Array((colors.length / 3) * 4);
  for (let i = 0, at = 0; i < colors.length; i += 3, at += 4) {
    fours[at] = colors[i];
    fours[at + 1] = colors[i + 1];
    fours[at + 2] = colors[i + 2];
    fours[at + 3] = 255;
  }
  return fours;
}

function triangles(
  positions: Float32Array,
  look?: Pick<Surface, 'values' | 'skin'>,
): BufferGeometry | null {
  if (positions.length === 0) return null;
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  if (look) {
    geometry.setAttribute('value', new BufferAttribute(look.values, 1));
    geometry.setAttribute('skin', new BufferAttribute(look.skin, 4, true));
  }
  geometry.boundingSphere = EVERYWHERE;
  return geometry;
}

/** Each line as two triangles: in x which end a corner belongs to, in y which side. */
const SIDES = Float32Array.of(0, -1, 0, 1, -1, 0, 1, 1, 0, 0, -1, 0, 1, 1, 0, 0, 1, 0);

function lines(ends: Float32Array): BufferGeometry | null {
  if (ends.length === 0) return null;
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(SIDES, 3));
  const pairs = new InstancedInterleavedBuffer(ends, 6);
  geometry.setAttribute('a', new InterleavedBufferAttribute(pairs, 3, 0));
  geometry.setAttribute('b', new InterleavedBufferAttribute(pairs, 3, 3));
  geometry.instanceCount = ends.length / 6;
  geometry.boundingSphere = EVERYWHERE;
  return geometry;
}

function instances({ a, b, c, d, values, skin, owners }: Pieces): BufferGeometry | null {
  if (owners.length === 0) return null;
  const geometry = new InstancedBufferGeometry();
  const corners = new Float32Array(36);
  for (const [i, corner] of FACETS.entries()) corners[3 * i] = corner;
  geometry.setAttribute('position', new BufferAttribute(corners, 3));
  for (const [name, array] of Object.entries({ a, b, c, d }))
    geometry.setAttribute(name, new InstancedBufferAttribute(array, 3));
  geometry.setAttribute('value', new InstancedBufferAttribute(values, 1));
  const skins = new InstancedInterleavedBuffer(skin, 16);
  for (const [k, end] of ['A', 'B', 'C', 'D'].entries())
    geometry.setAttribute(`skin${end}`, new InterleavedBufferAttribute(skins, 4, 4 * k, true));
  geometry.instanceCount = owners.length;
  geometry.boundingSphere = EVERYWHERE;
  return geometry;
}
