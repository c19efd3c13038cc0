import type { Filter } from '../geometry/filter';
import type { Model2d } from './model2d';
import { Model3d } from './model3d';
import { SURFACE_FORMATS, type SurfaceFormat, surfaceFile } from './surfaceFiles';

/** The formats that the package writes. In 2D, TetGen's files are those of Triangle. */
export const FORMATS = ['VTU', 'TetGen', 'NPZ', ...SURFACE_FORMATS] as const;
export type Format = (typeof FORMATS)[number];

export interface SavedFile {
  /** Such as `.vtu`. */
  extension: string;
  bytes: Uint8Array;
}

/**
 * The mesh as files: one, or for TetGen three. In 3D, the formats of surfaces hold that of what the
 * filter keeps.
 */
export async function save(
  model: Model2d | Model3d,
  filter: Filter,
  format: Format,
): Promise<SavedFile[]> {
  if (model instanceof Model3d) {
    if (isSurface(format)) {
      await model.prepare({ filter });
      return [file(format, surfaceFile(model.surface(filter), format))];
    }
    if (format === 'TetGen') return several(await model.mesh.toTetGen());
    return [file(format, await (format === 'VTU' ? model.mesh.toVTU() : model.mesh.toNPZ()))];
  }
  const { mesh } = model;
  switch (format) {
    case 'VTU':
      return [file(format, await mesh.toVTU())];
    case 'NPZ':
      return [file(format, await mesh.toNPZ())];
    case 'PLY':
      return [file(format, await mesh.toPLY())];
    case 'OBJ':
      return [file(format, await mesh.toOBJ())];
    case 'STL':
      return [file(format, await mesh.toSTL())];
    case 'TetGen':
      return several(await mesh.toTriangle());
  }
}

/** The formats of printers. */
export const PRINT_FORMATS = ['STL', '3MF', 'GLB'] as const;
export type PrintFormat = (typeof PRINT_FORMATS)[number];

/** The surface that was found of the points. */
export async function printed(model: Model2d | Model3d, format: PrintFormat): Promise<SavedFile> {
  const surface = model instanceof Model3d ? model.foundSurface?.surface : undefined;
  if (!surface) throw new Error('There is no surface yet.');
  return file(format, await surface[`to${format}`]());
}

const isSurface = (format: Format): format is SurfaceFormat =>
  (SURFACE_FORMATS as readonly string[]).includes(format);

const file = (format: string, bytes: Uint8Array): SavedFile => ({
  extension: `.${format.toLowerCase()}`,
  bytes,
});

const several = (files: Record<string, Uint8Array>): SavedFile[] =>
  Object.entries(files).map(([name, bytes]) => ({ extension: `.${name}`, bytes }));
