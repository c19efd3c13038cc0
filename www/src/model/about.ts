import type { ColorSource } from 'gdel-wasm';
import type { Custom } from '../geometry/up';

/** What a source says about its points. */
export interface About {
  /** How many points the file has besides, which hold no measurement. */
  noReturn: number;
  /** How many points there are on the faces of a coarse model, and whether they are among these. */
  onFaces: { points: number; taken: boolean } | null;
  /** Which axis points up. */
  up: Custom;
  /** The points' own colours: red, green and blue each. */
  colors: { rgb: Uint8Array; source: ColorSource } | null;
  /** In 3D the points' normals, three coordinates each; null if they have none. */
  normals: Float32Array<ArrayBuffer> | null;
  /** In 3D the positions of the scanner, one or one for each point; null if they are not known. */
  sensors: Float64Array<ArrayBuffer> | null;
  /** In 2D the z coordinates of the file, unless all are the same. */
  heights: Float32Array | Float64Array | null;
}

export const NOTHING_ABOUT: About = {
  noReturn: 0,
  onFaces: null,
  up: { axis: 'y', unless: 'never' },
  colors: null,
  normals: null,
  sensors: null,
  heights: null,
};
