import { type Accessor, type Material, Primitive, type vec4, WebIO } from '@gltf-transform/core';

/** What a binary glTF file holds: three coordinates per vertex, and red, green and blue. */
export interface GlbPoints {
  points: Float32Array;
  /** Null where no mesh has any, or all have the same. */
  colors: Uint8Array | null;
  /** The corners of all triangles, nine coordinates each. */
  faces(): Float64Array;
}

/**
 * The vertices of all meshes of a binary glTF file, where the scene puts them; in metres, as the
 * format has it. Their colours are those of the material, of its texture and of the vertices.
 */
export async function pointsOf(bytes: Uint8Array): Promise<GlbPoints> {
  const document = await new WebIO().readBinary(bytes);
  const coordinates: number[] = [];
  const colors: number[] = [];
  const drawn: { primitive: Primitive; start: number }[] = [];
  const pictures = new Map<Material, Promise<ImageData | null>>();
  for (const node of document.getRoot().listNodes()) {
    const primitives = node.getMesh()?.listPrimitives() ?? [];
    if (primitives.length === 0) continue;
    const m = node.getWorldMatrix();
    /** Where vertices begin, which primitives with different materials often share. */
    const starts = new Map<Accessor, number>();
    for (const primitive of primitives) {
      const positions = primitive.getAttribute('POSITION');
      if (!positions) continue;
      const start = starts.get(positions) ?? coordinates.length;
      drawn.push({ primitive, start });
      if (starts.has(positions)) continue;
      starts.set(positions, start);
      const colorAt = await colorsOf(primitive, pictures);
      const p = [0, 0, 0];
      for (let i = 0; i < positions.getCount(); i++) {
        positions.getElement(i, p);
        for (let axis = 0; axis < 3; axis++)
          coordinates.push(m[axis] * p[0] + m[4 + axis] * p[1] + m[8 + axis] * p[2] + m[12 + axis]);
        colors.push(...colorAt(i));
      }
    }
  }
  const hasColors = colors.some((value, i) => value !== colors[i % 3]);
  return {
    points: Float32Array.from(coordinates),
    colors: hasColors ? Uint8Array.from(colors) : null,
    faces: () =>
      Float64Array.from(
        drawn.flatMap(({ primitive, start }) =>
          cornersOf(primitive).flatMap((vertex) =>
            coordinates.slice(start + 3 * vertex, start + 3 * vertex + 3),
          ),
        ),
      ),
  };
}

/** The vertices of a primitive's triangles, three each; none if it has no list of them. */
function cornersOf(primitive: Primitive): number[] {
  if (primitive.getMode() !== Primitive.Mode.TRIANGLES) return [];
  const count = primitive.getAttribute('POSITION')!.getCount();
  const indices =
    primitive.getIndices()?.getArray() ?? Uint32Array.from({ length: count }, (_, i) => i);
  const corners = [...indices].slice(0, indices.length - (indices.length % 3));
  return corners.every((vertex) => vertex < count) ? corners : [];
}

/** From a vertex to its colour. */
async function colorsOf(
  primitive: Primitive,
  pictures: Map<Material, Promise<ImageData | null>>,
): Promise<(vertex: number) => [number, number, number]> {
  const material = primitive.getMaterial();
  const factor: vec4 = material?.getBaseColorFactor() ?? [1, 1, 1, 1];
  const own = primitive.getAttribute('COLOR_0');
  const place = primitive.getAttribute(
    `TEXCOORD_${material?.getBaseColorTextureInfo()?.getTexCoord() ?? 0}`,
  );
  if (material && !pictures.has(material)) pictures.set(material, pictureOf(material));
  const picture = material && place ? await pictures.get(material)! : null;
  const [color, uv] = [
    [1, 1, 1, 1],
    [0, 0],
  ];
  return (vertex) => {
    own?.getElement(vertex, color);
    // All are linear but the picture.
    const linear = [0, 1, 2].map((k) => factor[k] * color[k]);
    if (picture) {
      place!.getElement(vertex, uv);
      const [x, y] = [texel(uv[0], picture.width), texel(uv[1], picture.height)];
      const at = 4 * (y * picture.width + x);
      for (let k = 0; k < 3; k++) linear[k] *= toLinear(picture.data[at + k] / 255);
    }
    const [r, g, b] = linear.map((value) => Math.round(255 * toSrgb(value)));
    return [r, g, b];
  };
}

/** The picture on a material; null if there is none, or this browser cannot read it. */
async function pictureOf(material: Material): Promise<ImageData | null> {
  const texture = material.getBaseColorTexture();
  const image = texture?.getImage();
  if (!image) return null;
  try {
    const type = texture!.getMimeType();
    const bitmap = await createImageBitmap(new Blob([image as Uint8Array<ArrayBuffer>], { type }));
    const { width, height } = bitmap;
    const context = new OffscreenCanvas(width, height).getContext('2d')!;
    context.drawImage(bitmap, 0, 0);
    return context.getImageData(0, 0, width, height);
  } catch {
    return null;
  }
}

/** The texel at a place in a picture that is repeated. */
function texel(place: number, size: number): number {
  const within = place - Math.floor(place);
  return Math.min(size - 1, Math.max(0, Math.floor(within * size))) || 0;
}

const toLinear = (x: number) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);

function toSrgb(x: number): number {
  const value = Math.min(1, Math.max(0, x));
  return value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055;
}
