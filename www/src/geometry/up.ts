import { Sample } from './range';

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
const THIN = 0.2;

/** The share of points beyond the ends of an object: noise, birds. */
const BEYOND = 0.001;

/** What is so near to an end of an object stands on it, as a share of the largest extent. */
const NEAR = 0.01;

/** How wide a foot is, as a share of the side that it is on: a nose is smaller. */
const WIDE = 0.15;

/** How much larger than the foot by custom another one is that counts. */
const LARGER = 1.5;

/** So many points are looked at. */
const ENOUGH = 200_000;

/** Which axis points up by custom, and what of the points may speak against it. */
export interface Custom {
  axis: 'y' | 'z';
  /** A model that is thin lies; what is thin in a survey may be a wall. */
  unless: 'never' | 'it stands' | 'it stands or lies';
}

/**
 * Guesses which axis points up. Thin objects lie. Others stand on the end where most points touch
 * the ground, spread out: on feet or on a flat side. By custom, where nothing speaks clearly
 * against it.
 */
export function detectUp(points: ArrayLike<number>, { axis: custom, unless }: Custom): Up {
  const axes = ['x', 'y', 'z'] as const;
  const count = points.length / 3;
  if (count === 0 || unless === 'never') return custom;
  const step = Math.ceil(count / ENOUGH);
  const ranges = axes.map((_, axis) => {
    const sample = new Sample(Math.ceil(count / step), (i) => points[3 * step * i + axis]);
    return [sample.quantile(BEYOND), sample.quantile(1 - BEYOND)] as const;
  });
  const extents = ranges.map(([low, high]) => high - low);
  const thinnest = extents.indexOf(Math.min(...extents));
  if (extents.every((extent, axis) => axis === thinnest || extents[thinnest] < THIN * extent))
    return unless === 'it stands or lies' ? axes[thinnest] : custom;

  const foot = feet(points, ranges);
  // Of two ends that are equally fit to stand on, it stands on the lower one.
  const sides = [custom, ...UPS].sort((a, b) => foot[b] - foot[a]);
  const [best] = sides;
  if (foot[best] <= LARGER * foot[custom]) return custom;
  const positive = best.replace('-', '') as Up;
  return foot[positive] * 1.25 > foot[best] ? positive : best;
}

/**
 * How fit an object is to stand so that an axis points up: how many of the points are at its lower
 * end, times how far they spread there; 0 where they do not.
 */
function feet(
  points: ArrayLike<number>,
  ranges: readonly (readonly [low: number, high: number])[],
): Record<Up, number> {
  const extents = ranges.map(([low, high]) => high - low);
  const near = NEAR * Math.max(...extents);
  const step = 3 * Math.ceil(points.length / 3 / ENOUGH);
  const found = { x: 0, y: 0, z: 0, '-x': 0, '-y': 0, '-z': 0 };
  for (const up of UPS) {
    const axis = 'xyz'.indexOf(up.at(-1)!);
    const others = [0, 1, 2].filter((other) => other !== axis);
    const [low, high] = ranges[axis];
    const [from, to] = up.startsWith('-') ? [high - near, high] : [low, low + near];
    const spread = others.map(() => [Infinity, -Infinity]);
    let count = 0;
    for (let i = 0; i < points.length; i += step) {
      if (points[i + axis] < from || points[i + axis] > to) continue;
      count++;
      for (const [k, other] of others.entries()) {
        const x = Math.min(ranges[other][1], Math.max(ranges[other][0], points[i + other]));
        spread[k] = [Math.min(spread[k][0], x), Math.max(spread[k][1], x)];
      }
    }
    const sides = spread.map(([low, high]) => Math.max(0, high - low));
    const share = (sides[0] / extents[others[0]]) * (sides[1] / extents[others[1]]);
    if (share > WIDE) found[up] = count * share;
  }
  return found;
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
  const step = Math.ceil(count / ENOUGH);
  const along = (direction: Vector) => {
    const [x, y, z] = fromScreen(up, direction);
    const at = (i: number) => {
      const p = 3 * step * i;
      return x * positions[p] + y * positions[p + 1] + z * positions[p + 2];
    };
    const [low, high] = new Sample(Math.ceil(count / step), at).range;
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
