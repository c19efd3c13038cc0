/** Colours of cells: pale under dark text, or dark under pale text, so that all text can be read. */
export interface Palette {
  paper: string;
  text: string;
  /** The lines between cells, and between groups. */
  line: string;
  cell(hue: number, shade: number): string;
}

/** Björn Ottosson's OKLCH as `#rrggbb`, which every program understands: with less chroma where sRGB has no such colour. */
export function oklch(lightness: number, chroma: number, degrees: number): string {
  const angle = (degrees * Math.PI) / 180;
  const channels = (chroma: number) => {
    const [a, b] = [chroma * Math.cos(angle), chroma * Math.sin(angle)];
    const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
    const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
    const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
    return [
      4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
      -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
      -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
    ];
  };
  let rgb = channels(chroma);
  for (let less = chroma; less > 0.005 && rgb.some((x) => x < 0 || x > 1); less -= 0.005)
    rgb = channels(less);
  const byte = (x: number) => {
    const clamped = Math.min(1, Math.max(0, x));
    const gamma = clamped <= 0.0031308 ? 12.92 * clamped : 1.055 * clamped ** (1 / 2.4) - 0.055;
    return Math.round(255 * gamma)
      .toString(16)
      .padStart(2, '0');
  };
  return `#${rgb.map(byte).join('')}`;
}

/** The golden angle: hues that come one after the other differ. */
const TURN = 137.508;

/** How much shades differ. */
const SPREAD = 0.05;

/** The colours on a light or a dark page. A hue is a whole number, a shade between −1 and 1. */
export function palette(theme: 'light' | 'dark'): Palette {
  const isDark = theme === 'dark';
  const [lightness, chroma] = isDark ? [0.37, 0.075] : [0.84, 0.075];
  return {
    paper: isDark ? '#14161a' : '#f5f3ee',
    text: isDark ? '#f5f3ee' : '#17191d',
    line: isDark ? '#14161a' : '#fcfbf8',
    cell: (hue, shade) => oklch(lightness + SPREAD * shade, chroma, 45 + TURN * hue),
  };
}
