import type { Mesh3 } from 'gdel-wasm';

/** The formats that the package writes. */
export const FORMATS = ['VTU', 'TetGen', 'NPZ', 'PLY', 'OBJ', 'STL'] as const;
export type Format = (typeof FORMATS)[number];

export interface SavedFile {
  /** Such as `.vtu`. */
  extension: string;
  bytes: Uint8Array;
}

/** The mesh as files: one, or for TetGen three. */
export async function save(mesh: Mesh3, format: Format): Promise<SavedFile[]> {
  switch (format) {
    case 'VTU': return [{ extension: '.vtu', bytes: await mesh.toVTU() }];
    case 'NPZ': return [{ extension: '.npz', bytes: await mesh.toNPZ() }];
    case 'PLY': return [{ extension: '.ply', bytes: await mesh.toPLY() }];
    case 'OBJ': return [{ extension: '.obj', bytes: await mesh.toOBJ() }];
    case 'STL': return [{ extension: '.stl', bytes: await mesh.toSTL() }];
    case 'TetGen':
      return Object.entries(await mesh.toTetGen()).map(([name, bytes]) => ({ extension: `.${name}`, bytes: bytes as Uint8Array }));
  }
}
