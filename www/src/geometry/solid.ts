import { facetCircumradiusSquared } from './measures';
import { FACETS } from './mesh';

/** How many of the points a solid has to hold: scans have some that belong to nothing. */
const NEARLY_ALL = 0.98;

/** How much larger than that a radius may be that closes the solid. */
const CLOSING = 12;

/** How much of the volume of the hull comes in at once where a solid closes, at least. */
const INSIDE = 0.05;

/** How much larger than the radius that holds the points it is where nothing closes. */
const LOOSER = 2;

/** Radii are told apart up to so many bits of their 32, which is 0.1 %. */
const FINE = 13;

const one = new Float32Array(1);
const bits = new Uint32Array(one.buffer);

/** The number of the interval that a positive radius lies in. */
function intervalOf(radius: number): number {
  one[0] = radius;
  return bits[0] >>> FINE;
}

/** The largest radius in an interval. */
function endOf(interval: number): number {
  bits[0] = Math.min(0x7f80_0000, ((interval + 1) << FINE) - 1);
  return one[0];
}

/**
 * The radius up to which a ball carves each tetrahedron away, in the units of the points: coming
 * from outside, it enters through the facets whose circumcircle is larger than it. What remains for
 * a radius is the alpha shape with its inside: of a scanned surface, the solid.
 *
 * On the way to a tetrahedron, the ball has to pass the narrowest facet, and takes the way on which
 * this is widest: so tetrahedra are reached in the order of their radii, from the widest on.
 */
export function carvingRadii(
  points: ArrayLike<number>,
  tetrahedra: Uint32Array,
  neighbors: Int32Array,
): Float32Array {
  const count = tetrahedra.length / 4;
  const widths = facetWidths(points, tetrahedra);
  // The best way to each tetrahedron so far, as an interval; and a chain of tetrahedra for each
  // interval, in pairs of a tetrahedron and the next pair.
  const best = new Int32Array(count).fill(-1);
  const first = new Int32Array(intervalOf(Infinity) + 1).fill(-1);
  let chain = new Int32Array(1 << 17);
  let end = 0;
  // Those that are reached and whose neighbours are not looked at yet.
  const reached = new Int32Array(count);

  const wait = (t: number, interval: number) => {
    best[t] = interval;
    if (end === chain.length) {
      const longer = new Int32Array(2 * end);
      longer.set(chain);
      chain = longer;
    }
    chain[end] = t;
    chain[end + 1] = first[interval];
    first[interval] = end;
    end += 2;
  };

  for (let f = 0; f < neighbors.length; f++) {
    if (neighbors[f] < 0 && widths[f] > best[f >> 2]) wait(f >> 2, widths[f]);
  }
  for (let interval = first.length - 1; interval >= 0; interval--) {
    for (let pair = first[interval]; pair >= 0; pair = chain[pair + 1]) {
      // It may have been reached on a better way since.
      if (best[chain[pair]] !== interval) continue;
      let top = 0;
      reached[top++] = chain[pair];
      while (top > 0) {
        const t = reached[--top];
        for (let f = 4 * t; f < 4 * t + 4; f++) {
          const u = neighbors[f];
          if (u < 0 || best[u] >= interval) continue;
          if (widths[f] >= interval) {
            best[u] = interval;
            reached[top++] = u;
          } else if (widths[f] > best[u]) wait(u, widths[f]);
        }
      }
    }
  }
  const radii = new Float32Array(count);
  for (let t = 0; t < count; t++) radii[t] = endOf(best[t]);
  return radii;
}

/** The circumradius of every facet, as an interval. Worked out in a row: memory is slow at random. */
function facetWidths(points: ArrayLike<number>, tetrahedra: Uint32Array): Uint32Array {
  const widths = new Uint32Array(tetrahedra.length);
  for (let v = 0; v < widths.length; v += 4) {
    for (let k = 0; k < 4; k++) {
      const squared = facetCircumradiusSquared(
        points,
        tetrahedra[v + FACETS[3 * k]],
        tetrahedra[v + FACETS[3 * k + 1]],
        tetrahedra[v + FACETS[3 * k + 2]],
      );
      widths[v + k] = intervalOf(Math.sqrt(squared));
    }
  }
  return widths;
}

/**
 * A radius that suits the points of a solid, whose simplices are those with a radius that is not
 * larger: the smallest for which nearly all points hang together in it. A scanned surface is still
 * hollow then. If it closes for a radius that is not much larger, so that its inside comes in at
 * once, it is that radius; else a somewhat larger one, so that small holes close. Infinite without
 * simplices.
 */
export function solidRadius(
  radii: Float32Array,
  volumes: Float32Array,
  simplices: Uint32Array,
  dimension: 2 | 3,
): number {
  const order = ascending(radii);
  const held = holdingRadius(radii, order, simplices, dimension + 1);
  const most = CLOSING * held;
  let [below, total] = [0, 0];
  for (const volume of volumes) total += volume;
  for (let first = 0, end: number; first < order.length; first = end) {
    const radius = radii[order[first]];
    if (radius > most) break;
    let inside = 0;
    for (end = first; end < order.length && radii[order[end]] === radius; end++)
      inside += volumes[order[end]];
    if (radius >= held && inside > INSIDE * total && inside > below) return radius;
    below += inside;
  }
  return LOOSER * held;
}

/** The smallest radius for which nearly all points hang together. */
function holdingRadius(
  radii: Float32Array,
  order: Uint32Array,
  simplices: Uint32Array,
  corners: number,
): number {
  let points = 0;
  for (const vertex of simplices) if (vertex >= points) points = vertex + 1;
  /** A point of the same component, and of the points that stand for one, minus its size. */
  const parent = new Int32Array(points);
  for (const vertex of simplices) parent[vertex] = -1;
  const wanted = -NEARLY_ALL * parent.reduce((sum, alone) => sum + alone, 0);
  const find = (p: number) => {
    while (parent[p] >= 0) {
      if (parent[parent[p]] >= 0) parent[p] = parent[parent[p]];
      p = parent[p];
    }
    return p;
  };
  for (const t of order) {
    let a = find(simplices[corners * t]);
    for (let k = 1; k < corners; k++) {
      let b = find(simplices[corners * t + k]);
      if (a === b) continue;
      if (parent[a] > parent[b]) [a, b] = [b, a];
      parent[a] += parent[b];
      parent[b] = a;
    }
    if (-parent[a] >= wanted) return radii[t];
  }
  return Infinity;
}

/** The indices of radii in the order of their intervals. */
function ascending(radii: Float32Array): Uint32Array {
  const starts = new Uint32Array(intervalOf(Infinity) + 2);
  for (const radius of radii) starts[intervalOf(radius) + 1]++;
  for (let i = 1; i < starts.length; i++) starts[i] += starts[i - 1];
  const order = new Uint32Array(radii.length);
  for (let t = 0; t < radii.length; t++) order[starts[intervalOf(radii[t])]++] = t;
  return order;
}

/**
 * Critical values for a slider, ascending: radii of simplices between two bounds, above which the
 * next simplices come in. The slider is logarithmic, since radii span orders of magnitude: of those
 * that are one of `count` steps apart or less, the largest one.
 */
export function criticalStops(
  radii: Float32Array,
  [low, high]: [number, number],
  count: number,
): Float32Array {
  const largest = new Float32Array(count);
  const perStep = high > low ? count / Math.log(high / low) : 0;
  for (const radius of radii) {
    if (!(radius <= high)) continue;
    // One below the range is the first.
    const step = Math.floor(Math.log(radius / low) * perStep) || 0;
    const at = Math.max(0, Math.min(count - 1, step));
    if (radius > largest[at]) largest[at] = radius;
  }
  return largest.filter((radius) => radius > 0);
}

/**
 * The typical distance between neighbouring points: the median of the shortest edges of a sample of
 * the simplices, tetrahedra or triangles. 0 without simplices.
 */
export function spacingOf(
  points: ArrayLike<number>,
  simplices: Uint32Array,
  dimension: 2 | 3,
): number {
  const corners = dimension + 1;
  const count = simplices.length / corners;
  const samples = Math.min(count, 10_000);
  const shortest = new Float64Array(samples);
  for (let i = 0; i < samples; i++) {
    const t = corners * Math.floor((i * count) / samples);
    let min = Infinity;
    for (let j = 0; j < corners; j++) {
      for (let k = j + 1; k < corners; k++) {
        let squared = 0;
        for (let axis = 0; axis < dimension; axis++) {
          squared +=
            (points[dimension * simplices[t + j] + axis] -
              points[dimension * simplices[t + k] + axis]) **
            2;
        }
        min = Math.min(min, squared);
      }
    }
    shortest[i] = Math.sqrt(min);
  }
  shortest.sort();
  return samples > 0 ? shortest[samples >> 1] : 0;
}
