// Where delaunator's arrays begin: its seed triangle and the point that it inserts last. In its
// arithmetic, rounding included, since these are choices and not results.

/** What determines the beginning of delaunator's arrays. */
export interface Start {
  /** The vertices of the seed triangle in its order. */
  seed: [number, number, number];
  /** The point that is inserted last, or −1 if there are no others. */
  last: number;
}

/**
 * Returns where delaunator's arrays begin, or undefined if it would find no triangle. Points that
 * duplicate others do not come last.
 */
export function startOf(coords: ArrayLike<number>, duplicateOf: Int32Array): Start | undefined {
  const count = duplicateOf.length;
  let [minX, minY, maxX, maxY] = [Infinity, Infinity, -Infinity, -Infinity];
  for (let i = 0; i < count; i++) {
    minX = Math.min(minX, coords[2 * i]!);
    minY = Math.min(minY, coords[2 * i + 1]!);
    maxX = Math.max(maxX, coords[2 * i]!);
    maxY = Math.max(maxY, coords[2 * i + 1]!);
  }
  // The point next to the middle, the one next to that, and the one with the smallest circle.
  const a = nearest(coords, count, (minX + maxX) / 2, (minY + maxY) / 2, -1);
  if (a < 0) return undefined;
  const b = nearest(coords, count, coords[2 * a]!, coords[2 * a + 1]!, 0);
  if (b < 0) return undefined;
  let [c, min] = [-1, Infinity];
  for (let i = 0; i < count; i++) {
    const { x, y } = circumcenter(coords, a, b, i);
    const square = x * x + y * y;
    if (square < min && i !== a && i !== b) {
      c = i;
      min = square;
    }
  }
  if (c < 0) return undefined;

  const seed: Start['seed'] = isClockwise(coords, a, b, c) ? [a, b, c] : [a, c, b];
  const center = circumcenter(coords, ...seed);
  let [last, max] = [-1, -Infinity];
  for (let i = 0; i < count; i++) {
    const x = coords[2 * i]! - (coords[2 * a]! + center.x);
    const y = coords[2 * i + 1]! - (coords[2 * a + 1]! + center.y);
    const square = x * x + y * y;
    if (square >= max && duplicateOf[i] === -1 && !seed.includes(i)) {
      last = i;
      max = square;
    }
  }
  return { seed, last };
}

/** Returns the first of the points that are nearest to (x, y) but farther than `beyond`, or −1. */
function nearest(
  coords: ArrayLike<number>,
  count: number,
  x: number,
  y: number,
  beyond: number,
): number {
  let [best, min] = [-1, Infinity];
  for (let i = 0; i < count; i++) {
    const dx = x - coords[2 * i]!;
    const dy = y - coords[2 * i + 1]!;
    const square = dx * dx + dy * dy;
    if (square < min && square > beyond) {
      best = i;
      min = square;
    }
  }
  return best;
}

/** Returns the circumcentre of three points, relative to the first. */
function circumcenter(coords: ArrayLike<number>, a: number, b: number, c: number) {
  const dx = coords[2 * b]! - coords[2 * a]!;
  const dy = coords[2 * b + 1]! - coords[2 * a + 1]!;
  const ex = coords[2 * c]! - coords[2 * a]!;
  const ey = coords[2 * c + 1]! - coords[2 * a + 1]!;
  const bl = dx * dx + dy * dy;
  const cl = ex * ex + ey * ey;
  const d = 0.5 / (dx * ey - dy * ex);
  return { x: (ey * bl - dy * cl) * d, y: (dx * cl - ex * bl) * d };
}

/** Returns whether three points turn clockwise where y points up. */
function isClockwise(coords: ArrayLike<number>, a: number, b: number, c: number): boolean {
  const dx = coords[2 * b]! - coords[2 * a]!;
  const dy = coords[2 * b + 1]! - coords[2 * a + 1]!;
  const ex = coords[2 * c]! - coords[2 * a]!;
  const ey = coords[2 * c + 1]! - coords[2 * a + 1]!;
  return dx * ey - dy * ex <= 0;
}
