/** A model with fewer corners than this is nothing but corners: its faces have to be filled. */
const FEW = 1_000;

/** A model with so many corners shows its faces without more points. */
export const MANY_CORNERS = 20_000;

/** About so many points are put on the faces of a model. */
const WANTED = 30_000;

/** A face is large if its longest edge is so many times the distance that evenly spread corners have. */
const LARGE = 4;

/** What of the area in large faces makes a model coarse. */
const COARSE = 0.15;

/** A face that is longer than so many spacings gets points. */
const LONG = 2;

/**
 * Returns points on the faces of a coarse model, such as those of CAD, of which the corners alone
 * tell little: its flat sides and cylinders have none but along their rims. Empty for a model with
 * corners everywhere, as of a scan.
 *
 * @param faces the corners of triangles, nine coordinates each
 * @param corners how many different ones the model has
 */
export function pointsOnFaces(faces: Float64Array, corners: number): Float64Array {
  const sides = corners < MANY_CORNERS ? sidesOf(faces) : [];
  const area = sides.reduce((sum, { area }) => sum + area, 0);
  if (!(area > 0)) return new Float64Array();
  const even = Math.sqrt(area / corners);
  let large = 0;
  for (const side of sides) if (side.longest > LARGE * even) large += side.area;
  if (corners >= FEW && large < COARSE * area) return new Float64Array();

  let spacing = Math.sqrt(area / WANTED);
  // Slivers have more length than their area tells.
  while (sides.reduce((sum, side) => sum + countOn(side, spacing), 0) > 2 * WANTED) spacing *= 1.5;
  const points: number[] = [];
  for (const side of sides) put(points, faces, side, spacing);
  return Float64Array.from(points);
}

interface Side {
  /** Where its corners are: its longest edge is from the first to the second. */
  corners: readonly [number, number, number];
  longest: number;
  /** Across the longest edge. */
  height: number;
  area: number;
}

function sidesOf(faces: Float64Array): Side[] {
  const sides: Side[] = [];
  const distance = (p: number, q: number) =>
    Math.hypot(faces[q] - faces[p], faces[q + 1] - faces[p + 1], faces[q + 2] - faces[p + 2]);
  for (let f = 0; f + 9 <= faces.length; f += 9) {
    const edges = [0, 1, 2].map((k) => distance(f + 3 * k, f + 3 * ((k + 1) % 3)));
    const longest = Math.max(...edges);
    const half = (edges[0] + edges[1] + edges[2]) / 2;
    const area = Math.sqrt(
      Math.max(0, half * (half - edges[0]) * (half - edges[1]) * (half - edges[2])),
    );
    if (!(area > 0) || area === Infinity) continue;
    const first = edges.indexOf(longest);
    const [a, b, c] = [first, first + 1, first + 2].map((k) => f + 3 * (k % 3));
    sides.push({ corners: [a, b, c], longest, height: (2 * area) / longest, area });
  }
  return sides;
}

/** In how many rows points are put on a face; none on a small one. */
const rowsOn = ({ longest, height }: Side, spacing: number) =>
  longest > LONG * spacing ? Math.max(1, Math.round(height / spacing)) : 0;

/** How many there are in a row, which is so long. */
const countIn = (length: number, spacing: number) => Math.max(1, Math.round(length / spacing));

function countOn(side: Side, spacing: number): number {
  const rows = rowsOn(side, spacing);
  // The rows are half as long on average.
  return rows * countIn(side.longest / 2, spacing);
}

/** Puts points on a face, in rows along its longest edge, none of them on an edge. */
function put(points: number[], faces: Float64Array, side: Side, spacing: number): void {
  const [a, b, c] = side.corners;
  const rows = rowsOn(side, spacing);
  for (let row = 0; row < rows; row++) {
    const up = (row + 0.5) / rows;
    const count = countIn(side.longest * (1 - up), spacing);
    for (let i = 0; i < count; i++) {
      const along = (1 - up) * ((i + 0.5) / count);
      for (let axis = 0; axis < 3; axis++) {
        const start = faces[a + axis];
        points.push(start + along * (faces[b + axis] - start) + up * (faces[c + axis] - start));
      }
    }
  }
}
