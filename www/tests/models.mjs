// Scans and models as people have them, made up.

/** The same numbers everywhere, from 0 to 1. */
export function randomNumbers(seed) {
  let state = seed;
  return () => {
    state = (state * 48271) % 2147483647;
    return state / 2147483647;
  };
}

export const xyz = (points) => points.map((point) => point.join(' ')).join('\n');

/** Hills with z up, far from the origin, as they are seen from a plane: with a few birds. */
export function airborne(count = 8000) {
  const random = randomNumbers(1);
  const points = [];
  for (let i = 0; i < count; i++) {
    const [x, y] = [1000 * random(), 600 * random()];
    const z = 30 * Math.sin(x / 150) * Math.cos(y / 120) + random();
    points.push([500_000 + x, 4_000_000 + y, z]);
  }
  for (let i = 0; i < 40; i++)
    points.push([500_000 + 1000 * random(), 4_000_000 + 600 * random(), 20_000 * random()]);
  return points;
}

/**
 * A street between two walls, as a scanner on a tripod sees it: by direction, so the density falls
 * with the distance, and now and then something far beyond.
 */
export function terrestrial() {
  const random = randomNumbers(4);
  const points = [];
  for (let elevation = -60; elevation < 50; elevation += 1.5) {
    for (let azimuth = 0; azimuth < 360; azimuth += 1.5) {
      const [e, a] = [elevation, azimuth].map((angle) => (angle * Math.PI) / 180);
      const [x, y, z] = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
      const wall = x > 0 ? 7 / x : -9 / x;
      let range = Math.min(wall, z < 0 ? -1.7 / z : Infinity);
      if (range > 60 || 1.7 + range * z > 12) {
        if (random() < 0.98) continue;
        range = 300 + 900 * random();
      }
      points.push([range * x, range * y, 1.7 + range * z].map((c) => c + 0.01 * random()));
    }
  }
  return points;
}

/** A half ball with its flat side below, where up is an axis from 0 to 2. */
export function figure(up) {
  const random = randomNumbers(2);
  const points = [];
  while (points.length < 3000) {
    const p = [0, 1, 2].map(() => 2 * random() - 1);
    const radius = Math.hypot(...p);
    if (radius > 1) continue;
    // Half of the points on the round side, half on the flat one.
    const above = points.length % 2 ? p.map((x) => x / radius) : [p[0], 0, p[2]];
    above[1] = Math.abs(above[1]);
    points.push([above[(4 - up) % 3], above[(5 - up) % 3], above[(6 - up) % 3]]);
  }
  return points;
}

/** Points on a torus whose tube has a radius of 0.4, around a circle of radius 1. */
export function torus(count, noise = 0) {
  const random = randomNumbers(9);
  const points = [];
  while (points.length < count) {
    const [u, v] = [2 * Math.PI * random(), 2 * Math.PI * random()];
    const out = 1 + 0.4 * Math.cos(v);
    if (1.4 * random() > out) continue;
    const p = [out * Math.cos(u), out * Math.sin(u), 0.4 * Math.sin(v)];
    points.push(p.map((x) => x + noise * (random() + random() + random() - 1.5)));
  }
  return points;
}

/** An angle of two plates, 80 by 40 and 60 by 40, 6 thick, as STL: 20 triangles and 12 corners. */
export function bracket() {
  const triangles = [];
  const [outline, depth] = [
    [
      [0, 0],
      [80, 0],
      [80, 6],
      [6, 6],
      [6, 60],
      [0, 60],
    ],
    40,
  ];
  const at = (i, y) => [outline[i % 6][0], y, outline[i % 6][1]];
  for (let i = 0; i < 6; i++) {
    triangles.push([at(i, 0), at(i + 1, 0), at(i + 1, depth)]);
    triangles.push([at(i, 0), at(i + 1, depth), at(i, depth)]);
  }
  for (const [i, j, k] of [
    [0, 1, 2],
    [0, 2, 3],
    [0, 3, 4],
    [0, 4, 5],
  ]) {
    triangles.push([at(i, 0), at(k, 0), at(j, 0)]);
    triangles.push([at(i, depth), at(j, depth), at(k, depth)]);
  }
  return `solid\n${triangles
    .map(
      (corners) =>
        `facet normal 0 0 0\nouter loop\n${corners.map((corner) => `vertex ${corner.join(' ')}\n`).join('')}endloop\nendfacet\n`,
    )
    .join('')}endsolid\n`;
}

export const ply = (points) =>
  `ply\nformat ascii 1.0\nelement vertex ${points.length}\nproperty float x\nproperty float y\nproperty float z\nend_header\n${xyz(points)}\n`;

/** Points of which the right side is blue and the left one red, with what else a header names. */
export const coloredPly = (points) =>
  ply(points.map((p) => [...p, ...(p[0] > 0 ? [10, 20, 230] : [230, 20, 10])])).replace(
    'end_header',
    'property uchar red\nproperty uchar green\nproperty uchar blue\nend_header',
  );
