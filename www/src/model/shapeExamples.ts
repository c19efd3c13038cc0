import { pack } from './packed';
import type { Source } from './source';

type Place = [number, number];

const TURN = 2 * Math.PI;

/** A shore: about a circle, with waves of one to six turns around it. */
function shore(middle: Place, radius: number, corners: number, waves: readonly number[]): Place[] {
  const ring = Array.from({ length: corners }, (_, i): Place => {
    const angle = (TURN * i) / corners;
    const off = waves.reduce(
      (sum, wave, k) => sum + wave * Math.sin((k + 1) * angle + 5 * wave),
      1,
    );
    return [
      Math.round(middle[0] + 1.35 * radius * off * Math.cos(angle)),
      Math.round(middle[1] + radius * off * Math.sin(angle)),
    ];
  });
  return [...ring, ring[0]];
}

/** A lake with three islands, of which one has a pond. */
function lake(): string {
  const water = [
    shore([0, 0], 1000, 96, [0.05, 0.16, -0.1, 0.08, -0.05, 0.04]),
    shore([-520, 210], 210, 32, [0.1, 0.2, -0.12, 0.05]),
    shore([480, -260], 300, 40, [-0.1, 0.15, 0.1, -0.06]),
    shore([250, 430], 110, 20, [0.1, -0.15, 0.1]),
  ];
  const pond = [shore([500, -270], 110, 20, [0.1, 0.18, -0.08])];
  const geometry = { type: 'MultiPolygon', coordinates: [water, pond] };
  return JSON.stringify({ type: 'Feature', properties: { name: 'A lake' }, geometry });
}

/** The letter g. */
const LETTER = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 -4 92 138">
<path d="M90 0H71V9C63 1 54-2 44-2C18-2 2 18 2 46C2 74 18 94 44 94C54 94 63 90 71 82V92C71 108 60 116 44 116
C32 116 24 112 19 104L4 114C12 126 26 132 45 132C73 132 90 116 90 90Z
M71 46C71 64 62 77 46 77C30 77 21 64 21 46C21 28 30 15 46 15C62 15 71 28 71 46Z"/>
</svg>
`;

/** The profile NACA 2412 in a wind tunnel: a boundary with a hole. */
function wing(): string {
  const sides = 32;
  const [camber, at, thickness] = [0.02, 0.4, 0.12];
  const profile = Array.from({ length: 2 * sides }, (_, i): Place => {
    // From the trailing edge over the top and back, with more corners at the ends.
    const x = (1 + Math.cos((TURN * i) / (2 * sides))) / 2;
    const half =
      5 *
      thickness *
      (0.2969 * Math.sqrt(x) - 0.126 * x - 0.3516 * x ** 2 + 0.2843 * x ** 3 - 0.1036 * x ** 4);
    const middle =
      x < at
        ? (camber / at ** 2) * (2 * at * x - x * x)
        : (camber / (1 - at) ** 2) * (1 - 2 * at + 2 * at * x - x * x);
    return [x, middle + (i <= sides ? half : -half)];
  });
  const tunnel: Place[] = [
    [-1, -0.9],
    [2.2, -0.9],
    [2.2, 0.9],
    [-1, 0.9],
  ];
  const points = [...tunnel, ...profile];
  const ring = (start: number, count: number) =>
    Array.from({ length: count }, (_, i) => [start + i, start + ((i + 1) % count)]);
  const segments = [...ring(0, 4), ...ring(4, profile.length)];
  return [
    `${points.length} 2 0 0`,
    ...points.map(([x, y], i) => `${i} ${Number(x.toFixed(4))} ${Number(y.toFixed(4))}`),
    `${segments.length} 0`,
    ...segments.map(([a, b], i) => `${i} ${a} ${b}`),
    '1',
    '0 0.5 0.03',
    '',
  ].join('\n');
}

/** Shapes to begin with: the names of their files, and what is in these. */
const FILES = {
  lake: ['lake.geojson', lake],
  letter: ['letter.svg', () => LETTER],
  wing: ['wing.poly', wing],
} as const;

export type ShapeExample = keyof typeof FILES;

/** The names of the examples, for people. */
export const SHAPE_EXAMPLES: Record<ShapeExample, string> = {
  lake: 'Lake',
  letter: 'Letter',
  wing: 'Wing',
};

/** An example as a file that a visitor could have opened. It is in the link. */
export async function exampleOf(name: ShapeExample): Promise<Source> {
  const [title, make] = FILES[name];
  const file = new File([make()], title);
  return { kind: 'file', dimension: 2, files: [file], packed: (await pack(file)) ?? undefined };
}
