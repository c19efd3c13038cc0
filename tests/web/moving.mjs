// Points that move, for the tests of updates.

/** Returns a random number generator: mulberry32. */
export function randomFrom(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** Displaces uniform points by a share of their mean spacing, normally distributed. */
export function move(points, dimension, share, random) {
  const length = share * (points.length / dimension) ** (-1 / dimension);
  return points.map((x) => {
    const radius = Math.sqrt(-2 * Math.log(1 - random()));
    return x + length * radius * Math.cos(2 * Math.PI * random());
  });
}

/** Returns simplices in an order of their own, as text: equal for equal sets. */
export function canonical(simplices, corners) {
  const rows = [];
  for (let t = 0; t < simplices.length; t += corners)
    rows.push(simplices.slice(t, t + corners).sort());
  rows.sort((a, b) => {
    const k = a.findIndex((v, i) => v !== b[i]);
    return k < 0 ? 0 : a[k] - b[k];
  });
  return rows.join();
}
