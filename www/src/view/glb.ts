import { GLTFExporter } from 'three/addons/exporters/GLTFExporter.js';
import { BufferAttribute, BufferGeometry, Color, Mesh, MeshStandardMaterial } from 'three/webgpu';
import { skinOf, trianglesOf } from '../geometry/pieces';
import type { Page } from '../page';
import { rgbOf } from './colormap';
import { turnTo } from './viewer';

/** What the page shows, as a binary glTF file: the surface with its colours. */
export async function toGLB(page: Page): Promise<Uint8Array> {
  const { settings, view, summary, lastDrawing, model } = page;
  if (!lastDrawing || !summary) throw new Error('There is nothing to see yet.');
  const { pieces, scale } = lastDrawing;
  const surface = lastDrawing.surface ?? (pieces ? null : await model.drawnSurface());
  if (!surface && !pieces) throw new Error('There is nothing to see yet.');
  const positions = surface ? surface.positions : trianglesOf(pieces!, settings.apart);
  const skin = surface ? surface.skin : skinOf(pieces!);
  // A piece has 12 corners for its one value; a surface has a value for every corner.
  const values = surface ? surface.values : pieces!.values;
  const each = surface ? 1 : 12;
  const map = scale.kind === 'phases' ? 'phases' : settings.map;
  const linear = new Color();
  const toLinear = (r: number, g: number, b: number) =>
    linear.setRGB(r / 255, g / 255, b / 255, 'srgb').toArray();
  const palette = Array.from({ length: 256 }, (_, i) => toLinear(...rgbOf(map, i / 255)));
  const colors = new Float32Array(positions.length);
  for (let i = 0; i < positions.length / 3; i++) {
    const [r, g, b, isSkin] = skin.subarray(4 * i, 4 * i + 4);
    colors.set(
      isSkin ? toLinear(r, g, b) : palette[Math.round(values[Math.floor(i / each)] * 255)],
      3 * i,
    );
  }

  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setAttribute('color', new BufferAttribute(colors, 3));
  geometry.computeVertexNormals();
  const mesh = new Mesh(
    geometry,
    new MeshStandardMaterial({ vertexColors: true, roughness: 1, metalness: 0 }),
  );
  // The node's transform undoes that of the drawing: in a viewer, lengths are the file's.
  const { frame } = summary;
  const turn = turnTo(view.up);
  mesh.quaternion.copy(turn);
  mesh.scale.setScalar(1 / frame.scale);
  mesh.position.set(...frame.center).applyQuaternion(turn);
  const glb = await new GLTFExporter().parseAsync(mesh, { binary: true });
  return new Uint8Array(glb as ArrayBuffer);
}
