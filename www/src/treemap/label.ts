type Position = [number, number];

/** Text that fits into a cell. */
export interface Label {
  lines: string[];
  /** The middle of the text. */
  at: Position;
  /** The height of a line. */
  size: number;
}

/** Lines are so far apart, in their heights. */
export const LEADING = 1.12;

/** Text is at most so high, as a share of the root of the map's area, and stays this far from the sides, in its height. */
const [LARGEST, MARGIN] = [0.045, 0.35];

/** How much a place in the middle is worth. */
const PULL = 0.08;

/** So many thirds narrow a place down to a hundredth. */
const STEPS = 14;

/** How large a box of a given form may be around a place within a convex polygon. */
function roomAt(sides: Float64Array, x: number, y: number): number {
  let room = Infinity;
  for (let i = 0; i < sides.length; i += 4) {
    const left = sides[i + 2] - sides[i] * x - sides[i + 1] * y;
    // A side without length bounds nothing.
    if (sides[i + 3] > 0) room = Math.min(room, left / sides[i + 3]);
  }
  return room;
}

/**
 * The largest box of a form, given by its half width and half height, within a convex polygon: its middle, and its size
 * in these. The size is a concave function of the middle, of which thirds find the maximum.
 */
export function boxIn(
  polygon: readonly Position[],
  [width, height]: Position,
): { at: Position; size: number } {
  const sides = new Float64Array(4 * polygon.length);
  const middle = [0, 1].map(
    (axis) => polygon.reduce((sum, corner) => sum + corner[axis], 0) / polygon.length,
  );
  polygon.forEach(([ax, ay], i) => {
    const [bx, by] = polygon[(i + 1) % polygon.length];
    // Outwards of a polygon that is counter-clockwise on a screen, else to be turned.
    let [nx, ny] = [ay - by, bx - ax];
    if (nx * (middle[0] - ax) + ny * (middle[1] - ay) > 0) [nx, ny] = [-nx, -ny];
    sides.set([nx, ny, nx * ax + ny * ay, Math.abs(nx) * width + Math.abs(ny) * height], 4 * i);
  });
  const range = (axis: number): Position => {
    const all = polygon.map((corner) => corner[axis]);
    return [Math.min(...all), Math.max(...all)];
  };
  const best = ([low, high]: Position, of: (x: number) => number): number => {
    for (let i = 0; i < STEPS; i++) {
      const [one, other] = [low + (high - low) / 3, high - (high - low) / 3];
      if (of(one) < of(other)) low = one;
      else high = other;
    }
    return (low + high) / 2;
  };
  const [xs, ys] = [range(0), range(1)];
  // Of places with as much room, the one that is nearest to the middle.
  const worth = (x: number, y: number) =>
    roomAt(sides, x, y) -
    (PULL * (Math.abs(x - middle[0]) + Math.abs(y - middle[1]))) / (width + height);
  const yFor = (x: number) => best(ys, (y) => worth(x, y));
  const x = best(xs, (x) => worth(x, yFor(x)));
  const y = yFor(x);
  return { at: [x, y], size: roomAt(sides, x, y) };
}

/** The ways in which a name may be broken: not, or at the space nearest to the middle. */
function broken(name: string): string[][] {
  const spaces = [...name.matchAll(/\s+/g)].map(({ index }) => index);
  if (spaces.length === 0) return [[name]];
  const half = name.length / 2;
  const at = spaces.reduce((best, each) =>
    Math.abs(each - half) < Math.abs(best - half) ? each : best,
  );
  return [[name], [name.slice(0, at), name.slice(at).trim()]];
}

/**
 * The name of a cell as large as it fits, or null if it would be smaller than a size. `widthOf` says how wide text of
 * height 1 is, `area` is that of the whole map.
 */
export function labelFor(
  polygon: readonly Position[],
  name: string,
  widthOf: (text: string) => number,
  { smallest, area }: { smallest: number; area: number },
): Label | null {
  let found: Label | null = null;
  for (const lines of broken(name)) {
    const width = Math.max(...lines.map(widthOf)) + 2 * MARGIN;
    const height = lines.length * LEADING + MARGIN;
    const { at, size } = boxIn(polygon, [width / 2, height / 2]);
    if (size > (found?.size ?? 0)) found = { lines, at, size };
  }
  if (!found || found.size < smallest) return null;
  return { ...found, size: Math.min(found.size, LARGEST * Math.sqrt(area)) };
}
