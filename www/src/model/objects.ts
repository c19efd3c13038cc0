// The objects of the gallery that are computed and not fetched: each is a function of nothing, so
// that a link shows everybody the same one.

type Point = [x: number, y: number, z: number];

/** The same numbers on every machine, 0 to 1 (Mulberry32). */
function random(seed: number): () => number {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** So many points, each made by a function of random numbers. */
function points(count: number, seed: number, make: (next: () => number) => Point): Float32Array {
  const next = random(seed);
  const coordinates = new Float32Array(3 * count);
  for (let i = 0; i < count; i++) coordinates.set(make(next), 3 * i);
  return coordinates;
}

/** A value for each whole number pair, between −1 and 1. */
function noiseAt(x: number, y: number): number {
  let h = Math.imul(x, 374761393) + Math.imul(y, 668265263);
  h = Math.imul(h ^ (h >>> 13), 1274126177);
  return ((h ^ (h >>> 16)) >>> 0) / 2 ** 31 - 1;
}

/** Smooth noise between those values. */
function smoothNoise(x: number, y: number): number {
  const [i, j] = [Math.floor(x), Math.floor(y)];
  const ease = (t: number) => t * t * (3 - 2 * t);
  const [u, v] = [ease(x - i), ease(y - j)];
  const low = noiseAt(i, j) * (1 - u) + noiseAt(i + 1, j) * u;
  const high = noiseAt(i, j + 1) * (1 - u) + noiseAt(i + 1, j + 1) * u;
  return low * (1 - v) + high * v;
}

/** The height of the lake. */
const WATER = 0.25;

/** The height of a range of mountains, in kilometres. */
function heightAt(x: number, y: number): number {
  let height = 0;
  for (let octave = 0, scale = 0.45, size = 0.9; octave < 7; octave++, scale *= 2.03, size *= 0.47)
    height +=
      size * (1 - 2 * Math.abs(smoothNoise(x * scale + 7 * octave, y * scale - 3 * octave)));
  return Math.max(WATER, height);
}

/** A block of land with mountains around a lake, ten kilometres wide, in kilometres. */
function terrain(): Float32Array {
  const BOTTOM = -0.8;
  return points(60_000, 1, (next) => {
    const [x, y] = [10 * next(), 10 * next()];
    const height = heightAt(x, y);
    return [x, y, next() < 0.6 ? height : BOTTOM + (height - BOTTOM) * next()];
  });
}

/** The colours of the land: earth below; a lake, meadows, woods, rock where it is steep, snow. */
export function landColors(points: Float32Array): Uint8Array {
  const colors = new Uint8Array(points.length);
  for (let i = 0; i < points.length; i += 3) {
    const [x, y, z] = points.subarray(i, i + 3);
    const step = 0.03;
    const slope = Math.hypot(
      (heightAt(x + step, y) - heightAt(x - step, y)) / (2 * step),
      (heightAt(x, y + step) - heightAt(x, y - step)) / (2 * step),
    );
    // The borders between them are not lines of equal height.
    const height = z + 0.12 * smoothNoise(6 * x, 6 * y);
    const color =
      z < heightAt(x, y) - 0.01
        ? [121, 98, 77]
        : z < WATER + 1e-3
          ? [64, 116, 150]
          : height > 1.75 && slope < 2.2
            ? [240, 243, 246]
            : slope > 1.5 || height > 1.55
              ? [138, 126, 113]
              : height > 0.85
                ? [74, 98, 62]
                : [128, 148, 82];
    const light = 1 + 0.08 * smoothNoise(25 * x, 25 * y);
    for (let k = 0; k < 3; k++) colors[i + k] = Math.min(255, color[k] * light);
  }
  return colors;
}

/** A Menger sponge on a grid: hardly any of its spheres is unique. */
function sponge(): Float32Array {
  // 27 cells along each edge, of twice the grid's spacing: so narrow holes are wider than that.
  const SIZE = 54;
  const isSolid = (cell: number[]) => {
    for (let scale = 2; scale < SIZE; scale *= 3) {
      const middle = cell.filter((x) => Math.floor(x / scale) % 3 === 1);
      if (middle.length > 1 || cell.some((x) => x < 0 || x >= SIZE)) return false;
    }
    return true;
  };
  const coordinates: number[] = [];
  for (let x = 0; x <= SIZE; x++)
    for (let y = 0; y <= SIZE; y++)
      for (let z = 0; z <= SIZE; z++)
        for (let around = 0; around < 8; around++)
          if (isSolid([x - (around & 1), y - ((around >> 1) & 1), z - (around >> 2)])) {
            coordinates.push(x, y, z);
            break;
          }
  return Float32Array.from(coordinates);
}

/** A point on a tube around a closed curve. */
function onTube(curve: (t: number) => Point, radius: number, t: number, angle: number): Point {
  const step = 1e-3;
  const [p, q] = [curve(t), curve(t + step)];
  const along = q.map((x, axis) => x - p[axis]) as Point;
  const across = unit(
    cross(along, Math.abs(along[1]) > Math.abs(along[2]) ? [0, 0, 1] : [0, 1, 0]),
  );
  const up = unit(cross(along, across));
  return p.map(
    (x, axis) => x + radius * (Math.cos(angle) * across[axis] + Math.sin(angle) * up[axis]),
  ) as Point;
}

const cross = ([a, b, c]: Point, [d, e, f]: Point): Point => [
  b * f - c * e,
  c * d - a * f,
  a * e - b * d,
];

const unit = (p: Point): Point => p.map((x) => x / Math.hypot(...p)) as Point;

const TURN = 2 * Math.PI;

/** A trefoil knot. */
function knot(): Float32Array {
  const curve = (t: number): Point => [
    Math.sin(t) + 2 * Math.sin(2 * t),
    Math.cos(t) - 2 * Math.cos(2 * t),
    -Math.sin(3 * t),
  ];
  return points(40_000, 3, (next) => onTube(curve, 0.55, TURN * next(), TURN * next()));
}

/** A sea shell: a tube that grows around a spiral. */
function shell(): Float32Array {
  return points(45_000, 4, (next) => {
    // More points where the tube is wide.
    const t = 6.5 * TURN * Math.sqrt(0.05 + 0.95 * next());
    const grown = Math.exp(0.105 * (t - 6.5 * TURN));
    const angle = TURN * next();
    const ribs = 1 + 0.035 * Math.cos(24 * t);
    const out = 1 + 0.82 * ribs * Math.cos(angle);
    return [
      grown * out * Math.cos(t),
      2.6 * (1 - grown) + grown * 0.82 * ribs * Math.sin(angle),
      grown * out * Math.sin(t),
    ];
  });
}

/** A gyroid, the surface that divides space into two equal labyrinths, in a ball. */
function gyroid(): Float32Array {
  const SIZE = 1.25 * TURN;
  return points(60_000, 5, (next) => {
    for (;;) {
      const p: Point = [0, 0, 0];
      for (let axis = 0; axis < 3; axis++) p[axis] = SIZE * (2 * next() - 1);
      // Newton’s method along the gradient.
      for (let step = 0; step < 4; step++) {
        const [s, c] = [p.map(Math.sin), p.map(Math.cos)];
        const value = s[0] * c[1] + s[1] * c[2] + s[2] * c[0];
        const gradient = [
          c[0] * c[1] - s[2] * s[0],
          c[1] * c[2] - s[0] * s[1],
          c[2] * c[0] - s[1] * s[2],
        ];
        const length = gradient.reduce((sum, x) => sum + x * x, 1e-9);
        for (let axis = 0; axis < 3; axis++) p[axis] -= (value / length) * gradient[axis];
      }
      if (Math.hypot(...p) < SIZE) return p;
    }
  });
}

/** A gear with a bore, in whole hundredths of a millimetre: most of its points share planes. */
function gear(): Float32Array {
  const TEETH = 18;
  const [BORE, HEIGHT] = [9, 8];
  const radiusAt = (angle: number) => {
    const tooth = (angle * TEETH) / TURN;
    const place = Math.abs(tooth - Math.floor(tooth) - 0.5);
    return 24 + 6 * Math.min(1, Math.max(0, 2.4 - 8 * place));
  };
  const whole = (p: Point) => p.map((x) => Math.round(100 * x) / 100) as Point;
  return points(50_000, 6, (next) => {
    const angle = TURN * next();
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    const kind = next();
    if (kind < 0.62) {
      const radius = Math.sqrt(BORE ** 2 + (radiusAt(angle) ** 2 - BORE ** 2) * next());
      return whole([radius * c, kind < 0.31 ? 0 : HEIGHT, radius * s]);
    }
    const radius = kind < 0.72 ? BORE : radiusAt(angle);
    return whole([radius * c, HEIGHT * next(), radius * s]);
  });
}

/** The atoms of C₆₀: the corners of a truncated icosahedron with edges of length 2. */
function atoms(): Point[] {
  const golden = (1 + Math.sqrt(5)) / 2;
  const all: Point[] = [];
  for (const corner of [
    [0, 1, 3 * golden],
    [1, 2 + golden, 2 * golden],
    [golden, 2, 2 * golden + 1],
  ]) {
    for (let signs = 0; signs < 8; signs++) {
      const p = corner.map((x, axis) => ((signs >> axis) & 1 ? -x : x));
      // Minus zero would be the same atom again.
      if (corner.some((x, axis) => x === 0 && (signs >> axis) & 1)) continue;
      for (let turn = 0; turn < 3; turn++)
        all.push([p[turn], p[(turn + 1) % 3], p[(turn + 2) % 3]]);
    }
  }
  return all;
}

/** A molecule of 60 carbon atoms, with the 90 bonds between them. */
function fullerene(): Float32Array {
  const balls = atoms();
  const bonds = balls.flatMap((p, i) =>
    balls
      .slice(i + 1)
      .filter((q) => Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) < 2.1)
      .map((q): [Point, Point] => [p, q]),
  );
  return points(54_000, 7, (next) => {
    const isBond = next() < 0.4;
    if (isBond) {
      const [p, q] = bonds[Math.floor(bonds.length * next())];
      const along = (t: number) => p.map((x, axis) => x + t * (q[axis] - x)) as Point;
      return onTube(along, 0.22, next(), TURN * next());
    }
    const ball = balls[Math.floor(balls.length * next())];
    const z = 2 * next() - 1;
    const angle = TURN * next();
    const width = Math.sqrt(1 - z * z);
    const direction = [width * Math.cos(angle), width * Math.sin(angle), z];
    return ball.map((x, axis) => x + 0.6 * direction[axis]) as Point;
  });
}

/** The objects by name. */
export const OBJECTS = { terrain, sponge, knot, shell, gyroid, gear, fullerene } as const;
