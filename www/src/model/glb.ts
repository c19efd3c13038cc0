import { WebIO } from '@gltf-transform/core';

/**
 * The vertices of all meshes of a binary glTF file, where the scene puts them; in metres, as the
 * format has it.
 */
export async function pointsOf(bytes: Uint8Array): Promise<Float32Array> {
  const document = await new WebIO().readBinary(bytes);
  const coordinates: number[] = [];
  for (const node of document.getRoot().listNodes()) {
    const primitives = node.getMesh()?.listPrimitives() ?? [];
    if (primitives.length === 0) continue;
    const m = node.getWorldMatrix();
    const seen = new Set();
    for (const primitive of primitives) {
      const positions = primitive.getAttribute('POSITION');
      // Primitives with different materials often share their vertices.
      if (!positions || seen.has(positions)) continue;
      seen.add(positions);
      const p = [0, 0, 0];
      for (let i = 0; i < positions.getCount(); i++) {
        positions.getElement(i, p);
        for (let axis = 0; axis < 3; axis++)
          coordinates.push(m[axis] * p[0] + m[4 + axis] * p[1] + m[8 + axis] * p[2] + m[12 + axis]);
      }
    }
  }
  return Float32Array.from(coordinates);
}
