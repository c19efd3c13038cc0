/**
 * The faces of a model that the package has read the points of: the corners of its triangles, nine
 * coordinates each. Null for formats without any, or which the page does not look at.
 */
export function facesOf(name: string, bytes: ArrayBuffer): Float64Array | null {
  if (/\.stl$/i.test(name)) return isBinarySTL(bytes) ? binarySTL(bytes) : textSTL(textOf(bytes));
  if (/\.obj$/i.test(name)) return facesOfOBJ(textOf(bytes));
  return null;
}

const textOf = (bytes: ArrayBuffer) => new TextDecoder('latin1').decode(bytes);

/** After a header of 80 bytes comes the number of triangles, of 50 bytes each. */
const [HEADER, TRIANGLE] = [84, 50];

function isBinarySTL(bytes: ArrayBuffer): boolean {
  if (bytes.byteLength < HEADER) return false;
  return bytes.byteLength >= HEADER + TRIANGLE * new DataView(bytes).getUint32(80, true);
}

function binarySTL(bytes: ArrayBuffer): Float64Array {
  const view = new DataView(bytes);
  const count = view.getUint32(80, true);
  const faces = new Float64Array(9 * count);
  for (let t = 0; t < count; t++) {
    // The normal comes first.
    for (let k = 0; k < 9; k++)
      faces[9 * t + k] = view.getFloat32(HEADER + TRIANGLE * t + 12 + 4 * k, true);
  }
  return faces;
}

function textSTL(text: string): Float64Array {
  const faces: number[] = [];
  for (const [, ...place] of text.matchAll(/^\s*vertex\s+(\S+)\s+(\S+)\s+(\S+)/gim))
    faces.push(...place.map(Number));
  return Float64Array.from(faces);
}

function facesOfOBJ(text: string): Float64Array {
  const vertices: number[][] = [];
  const faces: number[] = [];
  for (const line of text.split('\n')) {
    const [what, ...rest] = line.trim().split(/\s+/);
    if (what === 'v') vertices.push(rest.slice(0, 3).map(Number));
    if (what !== 'f') continue;
    // Counted from 1, or backwards from the last one so far.
    const corners = rest.map((corner) => {
      const index = Number.parseInt(corner, 10);
      return vertices[index < 0 ? vertices.length + index : index - 1];
    });
    for (let k = 2; k < corners.length; k++) {
      const triangle = [corners[0], corners[k - 1], corners[k]];
      if (triangle.every((corner) => corner?.length === 3)) faces.push(...triangle.flat());
    }
  }
  return Float64Array.from(faces);
}
