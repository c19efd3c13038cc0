import type { Mesh2, Mesh3 } from 'gdel-wasm';

/** The formats that the package writes. TetGen's files are those of Triangle in the plane. */
export const FORMATS = ['VTU', 'TetGen', 'NPZ', 'PLY', 'OBJ', 'STL'] as const;
export type Format = (typeof FORMATS)[number];

export interface SavedFile {
  /** Such as `.vtu`. */
  extension: string;
  bytes: Uint8Array;
}

/** The mesh as files: one, or for TetGen three. */
export async function save(mesh: Mesh2 | Mesh3, format: Format): Promise<SavedFile[]> {
  switch (format) {
    case 'VTU':
      return [{ extension: '.vtu', bytes: await mesh.toVTU() }];
    case 'NPZ':
      return [{ extension: '.npz', bytes: await mesh.toNPZ() }];
    case 'PLY':
      return [{ extension: '.ply', bytes: await mesh.toPLY() }];
    case 'OBJ':
      return [{ extension: '.obj', bytes: await mesh.toOBJ() }];
    case 'STL':
      return [{ extension: '.stl', bytes: await mesh.toSTL() }];
    case 'TetGen': {
      const files = await ('toTetGen' in mesh ? mesh.toTetGen() : mesh.toTriangle());
      return Object.entries(files).map(([name, bytes]) => ({ extension: `.${name}`, bytes }));
    }
  }
}
