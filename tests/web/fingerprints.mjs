// The meshes that tests/data/fingerprints.txt pins, and how to compare with it. Runs in pages, too.

/** The canonical form: vertices ascending in a tetrahedron, tetrahedra ascending. */
export function canonical(tetrahedra) {
  const rows = [];
  for (let t = 0; t < tetrahedra.length; t += 4) rows.push(tetrahedra.slice(t, t + 4).sort());
  rows.sort((a, b) => a[0] - b[0] || a[1] - b[1] || a[2] - b[2] || a[3] - b[3]);
  const flat = new Uint32Array(tetrahedra.length);
  for (const [t, row] of rows.entries()) flat.set(row, 4 * t);
  return flat;
}

/** FNV-1a, 64 bits, of the canonical form as little-endian words. */
export const fingerprint = (tetrahedra) => hashOf([canonical(tetrahedra)]);

/** FNV-1a, 64 bits, of typed arrays one after the other. */
export function hashOf(arrays) {
  // In two halves, since numbers hold 53 bits: the prime is 2⁴⁰ + 435.
  let [high, low] = [0xcbf29ce4, 0x84222325];
  for (const { buffer, byteOffset, byteLength } of arrays) {
    for (const byte of new Uint8Array(buffer, byteOffset, byteLength)) {
      low = (low ^ byte) >>> 0;
      const product = low * 435;
      high = (Math.imul(high, 435) + Math.floor(product / 2 ** 32) + (low << 8)) >>> 0;
      low = product >>> 0;
    }
  }
  return [high, low].map((half) => half.toString(16).padStart(8, '0')).join('');
}

/** The lines of the file: { kind, count, seed, tetrahedra, fingerprint }. */
export function parse(text) {
  const lines = text.split('\n').filter((line) => line && !line.startsWith('#'));
  return lines.map((line) => {
    const [kind, count, seed, tetrahedra, fingerprint] = line.split(' ');
    return { kind, count: +count, seed: +seed, tetrahedra: +tetrahedra, fingerprint };
  });
}
