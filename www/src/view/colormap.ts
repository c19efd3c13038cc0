import { interpolateCividis, interpolateMagma, interpolateViridis } from 'd3-scale-chromatic';

/** Perceptually uniform colour maps; viridis and cividis also read well with colour blindness. */
export const COLOR_MAPS = {
  viridis: interpolateViridis,
  cividis: interpolateCividis,
  magma: interpolateMagma,
} as const;

export type ColorMapName = keyof typeof COLOR_MAPS;

/** The colours of tetrahedra that Phase 1 made and of those that splaying made: blue and orange, apart for everybody. */
export const PHASE_COLORS = ['#4a7fb5', '#f0803c'] as const;

const STEPS = 256;

/** A map as 256 RGBA texels. The darkest and the lightest ends are left out: there, shading and edges would not show. */
export function texels(map: ColorMapName | 'phases'): Uint8Array {
  const rgba = new Uint8Array(4 * STEPS);
  for (let i = 0; i < STEPS; i++) rgba.set([...rgbOf(map, i / (STEPS - 1)), 255], 4 * i);
  return rgba;
}

/** A CSS gradient of a map, for legends. */
export function gradient(map: ColorMapName): string {
  const stops = Array.from({ length: 11 }, (_, i) => `rgb(${rgbOf(map, i / 10).join(' ')})`);
  return `linear-gradient(to right, ${stops.join(', ')})`;
}

/** The colour at a position from 0 to 1, as three bytes. */
export function rgbOf(map: ColorMapName | 'phases', position: number): [number, number, number] {
  const css =
    map === 'phases'
      ? PHASE_COLORS[position < 0.5 ? 0 : 1]
      : COLOR_MAPS[map](0.1 + 0.88 * position);
  const hex = /^#(..)(..)(..)$/.exec(css);
  const parts = hex
    ? hex.slice(1).map((byte) => parseInt(byte, 16))
    : css.match(/\d+/g)!.map(Number);
  return [parts[0], parts[1], parts[2]];
}
