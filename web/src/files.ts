import type { Bytes } from './arrays.js';
import type { TaskOptions } from './types.js';

/** The formats of triangles. */
export type TriangleFormat = 'ply' | 'obj' | 'stl' | 'glb' | '3mf';

/**
 * What files of triangles are made of: a surface, the hull of a 3D mesh, the triangles of a 2D mesh.
 */
export abstract class Triangles {
  /**
   * Returns a file.
   *
   * @internal
   */
  abstract _write(format: TriangleFormat, options: TaskOptions | undefined): Promise<Bytes>;

  /** Returns the triangles as Stanford PLY (`.ply`), binary. */
  async toPLY(options?: TaskOptions): Promise<Bytes> {
    return this._write('ply', options);
  }

  /** Returns the triangles as Wavefront OBJ (`.obj`). */
  async toOBJ(options?: TaskOptions): Promise<Bytes> {
    return this._write('obj', options);
  }

  /** Returns the triangles as STL (`.stl`): binary if single precision holds the coordinates, else text. */
  async toSTL(options?: TaskOptions): Promise<Bytes> {
    return this._write('stl', options);
  }

  /**
   * Returns the triangles as binary glTF 2.0 (`.glb`), which has single precision. If that would lose
   * something, coordinates are relative to the node's translation. Axes stay as they are, though glTF
   * has *y* up.
   */
  async toGLB(options?: TaskOptions): Promise<Bytes> {
    return this._write('glb', options);
  }

  /** Returns the triangles as 3MF (`.3mf`), the format of 3D printers, with one unit as a millimetre. */
  async to3MF(options?: TaskOptions): Promise<Bytes> {
    return this._write('3mf', options);
  }
}
