import type { Frame } from './mesh';
import { rangeAlong } from './range';

/** The axis of the input that points up on the screen. */
export type Up = 'x' | 'y' | 'z' | '-x' | '-y' | '-z';

export const UPS: readonly Up[] = ['x', 'y', 'z', '-x', '-y', '-z'];

type Vector = readonly [number, number, number];

/**
 * For each choice of up, the input's axes that point right, up and towards the viewer on the
 * screen: with the sign of the axis, and counted from 1.
 */
const AXES: Record<Up, Vector> = {
  x: [-2, 1, 3],
  y: [1, 2, 3],
  z: [1, 3, -2],
  '-x': [2, -1, 3],
  '-y': [1, -2, -3],
  '-z': [1, -3, 2],
};

/** From the input's axes to those of the screen. */
export function toScreen(up: Up, vector: Vector): [number, number, number] {
  return AXES[up].map((axis) => Math.sign(axis) * vector[Math.abs(axis) - 1]) as never;
}

/** From the axes of the screen to the input's. */
export function fromScreen(up: Up, vector: Vector): [number, number, number] {
  const found: [number, number, number] = [0, 0, 0];
  for (const [i, axis] of AXES[up].entries())
    found[Math.abs(axis) - 1] = Math.sign(axis) * vector[i];
  return found;
}

/** An extent that is so much smaller than the others makes a thin object: land, a relief, a plate. */
const THIN = 0.3;

/** Facets of the hull within 14° of an axis make its flat side. */
const LEVEL = 0.97;

/** A flat side on which something stands is at least this share of the hull. */
const FOOT = 0.06;

/**
 * Guesses which axis points up. Thin objects lie. Others stand on the largest flat side of their
 * hull, unless that is hardly flatter than the side on which they would stand by custom.
 *
 * @param hull three point indices a triangle, counter-clockwise as seen from outside
 */
export function detectUp(
  points: ArrayLike<number>,
  hull: ArrayLike<number>,
  custom: 'y' | 'z',
): Up {
  const axes = ['x', 'y', 'z'] as const;
  const extents = axes.map((_, axis) => {
    const [low, high] = rangeAlong(points, axis, 3);
    return high - low;
  });
  const thinnest = extents.indexOf(Math.min(...extents));
  if (extents.every((extent, axis) => axis === thinnest || extents[thinnest] < THIN * extent))
    return axes[thinnest];

  const flat = flatSides(points, hull);
  const below = (up: Up) => flat[opposite(up)];
  // Of two ends that are equally flat, it stands on the lower one.
  const sides = [custom, ...UPS].sort((a, b) => below(b) - below(a));
  const [best] = sides;
  if (below(best) <= FOOT || below(best) <= 1.5 * below(custom)) return custom;
  const positive = best.replace('-', '') as Up;
  return below(positive) * 1.25 > below(best) ? positive : best;
}

const opposite = (up: Up) => (up.startsWith('-') ? up.slice(1) : `-${up}`) as Up;

/** The share of the hull's area that faces along each axis. */
function flatSides(points: ArrayLike<number>, hull: ArrayLike<number>): Record<Up, number> {
  const sides = { x: 0, y: 0, z: 0, '-x': 0, '-y': 0, '-z': 0 };
  let total = 0;
  for (let i = 0; i < hull.length; i += 3) {
    const [p, q, r] = [3 * hull[i], 3 * hull[i + 1], 3 * hull[i + 2]];
    const [u, v] = [q, r].map((s) => [0, 1, 2].map((axis) => points[s + axis] - points[p + axis]));
    const normal = [
      u[1] * v[2] - u[2] * v[1],
      u[2] * v[0] - u[0] * v[2],
      u[0] * v[1] - u[1] * v[0],
    ];
    const area = Math.hypot(...normal);
    total += area;
    for (const [axis, name] of (['x', 'y', 'z'] as const).entries()) {
      if (normal[axis] > LEVEL * area) sides[name] += area;
      if (normal[axis] < -LEVEL * area) sides[`-${name}`] += area;
    }
  }
  for (const up of UPS) sides[up] /= total || 1;
  return sides;
}

/** The axis of the input, level with the ground, that faces a viewer in this direction most. */
export function axisFacing(up: Up, towardsViewer: Vector): [number, number, number] {
  const [x, , z] = towardsViewer;
  return fromScreen(
    up,
    Math.abs(x) > Math.abs(z) ? [Math.sign(x), 0, 0] : [0, 0, Math.sign(z) || 1],
  );
}

/** How steeply to look down at first, in radians: on what lies flat, from higher up. */
export function elevationFor(points: ArrayLike<number>, up: Up, { scale }: Frame): number {
  const axis = 'xyz'.indexOf(up.replace('-', ''));
  const [low, high] = points.length > 0 ? rangeAlong(points, axis, 3) : [0, 1];
  return (high - low) * scale < 0.5 ? 0.62 : 0.24;
}
