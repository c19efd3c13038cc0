import { rangeAlong, Sample } from './range';

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

/** Half the angle that the smaller side of the drawing sees, as a tangent. */
export const HALF_VIEW = Math.tan(Math.PI / 9.5);

/** Where the camera first is beside a 3D object: to the right of its front. */
export const AZIMUTH = 0.5;

/**
 * A place for the camera from which the points, as drawn, fill the view but for their outliers:
 * above them a little, of what lies flat more. In the form of the viewer's `CameraPose`.
 */
export function poseFor(
  positions: Float32Array,
  up: Up,
): [number, number, number, number, number, number] {
  const count = positions.length / 3;
  if (count === 0) return [AZIMUTH, 0.24, 2.85, 0, 0, 0];
  const along = (direction: Vector) => {
    const [x, y, z] = fromScreen(up, direction);
    const at = (i: number) =>
      x * positions[3 * i] + y * positions[3 * i + 1] + z * positions[3 * i + 2];
    const [low, high] = new Sample(count, at).range;
    return { middle: (low + high) / 2, half: (high - low) / 2 };
  };
  const elevation = along([0, 1, 0]).half < 0.25 ? 0.62 : 0.24;
  const [sinA, cosA] = [Math.sin(AZIMUTH), Math.cos(AZIMUTH)];
  const [sinE, cosE] = [Math.sin(elevation), Math.cos(elevation)];
  const axes: Vector[] = [
    [cosA, 0, -sinA],
    [-sinA * sinE, cosE, -cosA * sinE],
    [sinA * cosE, sinE, cosA * cosE],
  ];
  const [right, above, near] = axes.map(along);
  const target = [0, 1, 2].map((i) =>
    [right, above, near].reduce((sum, { middle }, axis) => sum + middle * axes[axis][i], 0),
  );
  // What is near looks larger: about half of the depth is in front of the largest extent.
  const distance = (1.12 * Math.max(right.half, above.half)) / HALF_VIEW + 0.5 * near.half;
  return [AZIMUTH, elevation, Math.max(0.2, distance), target[0], target[1], target[2]];
}
