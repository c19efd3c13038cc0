/** A change that a visitor made by hand to 2D points, or to polygons through them. */
export type Edit =
  | { do: 'add'; at: [number, number] }
  | { do: 'move'; point: number; at: [number, number] }
  /** Makes a point as heavy as a ball of this radius. */
  | { do: 'weigh'; point: number; radius: number }
  /** The points behind it move up. */
  | { do: 'remove'; point: number }
  /** Adds a point as the next corner of the polygon that is drawn. */
  | { do: 'corner'; at: [number, number] }
  /** Makes a point the next corner of that polygon. */
  | { do: 'join'; point: number }
  /** Ends that polygon. */
  | { do: 'close' }
  /** Removes a ring, and points, of which the last one comes first. */
  | { do: 'erase'; ring: number; points: readonly number[] }
  | ({ do: 'mesh' } & Meshing);

/** How polygons become a mesh. */
export interface Meshing {
  /** 1 where there are to be points at crossings, 0 where these are errors. */
  split: number;
  /** What is inside: an index of {@link FILLS}. */
  fill: number;
  /** The smallest angle of triangles in degrees; 0 for any. */
  minAngle: number;
  /** The largest area of triangles; 0 for any. */
  maxArea: number;
}

/** The rules for what is inside: null is what suits the polygons. */
export const FILLS = [null, 'evenodd', 'nonzero', 'enclosed', 'all'] as const;

/** Whether some changes draw polygons. */
export const drawPolygons = (edits: readonly Edit[]): boolean =>
  edits.some((edit) => edit.do === 'corner' || edit.do === 'join');

/**
 * The points, x, y, x, y, …, after all changes in order. What names a point that is not there
 * changes nothing.
 */
export function applyEdits(
  points: Float32Array | Float64Array,
  edits: readonly Edit[],
): Float32Array | Float64Array {
  if (edits.length === 0) return points;
  const edited = new Float64Array(points.length + 2 * edits.length);
  edited.set(points);
  let end = points.length;
  for (const edit of edits) {
    if (addsPoint(edit)) {
      edited.set(edit.at, end);
      end += 2;
    } else if (edit.do === 'move' && 2 * edit.point < end) edited.set(edit.at, 2 * edit.point);
    for (const point of removedBy(edit)) {
      if (2 * point >= end) continue;
      edited.copyWithin(2 * point, 2 * point + 2, end);
      end -= 2;
    }
  }
  return edited.subarray(0, end);
}

/** Whether a change adds a point, which is then the last one. */
export const addsPoint = (edit: Edit): edit is Extract<Edit, { do: 'add' | 'corner' }> =>
  edit.do === 'add' || edit.do === 'corner';

/** The points that a change removes, one after the other. */
export const removedBy = (edit: Edit): readonly number[] =>
  edit.do === 'remove' ? [edit.point] : edit.do === 'erase' ? edit.points : [];

/** The colours of the points after all changes, three bytes each; an added point is black. */
export function colorsAfter(colors: Uint8Array, edits: readonly Edit[]): Uint8Array {
  if (edits.length === 0) return colors;
  const edited = new Uint8Array(colors.length + 3 * edits.length);
  edited.set(colors);
  let end = colors.length;
  for (const edit of edits) {
    if (addsPoint(edit)) {
      edited.fill(0, end, end + 3);
      end += 3;
    }
    for (const point of removedBy(edit)) {
      if (3 * point >= end) continue;
      edited.copyWithin(3 * point, 3 * point + 3, end);
      end -= 3;
    }
  }
  return edited.subarray(0, end);
}

/** The changes with one more. What is chosen, moved or weighed again needs only the last value, place or radius. */
export function withEdit(edits: readonly Edit[], edit: Edit): Edit[] {
  const last = edits.at(-1);
  const again =
    last?.do === edit.do &&
    (edit.do === 'mesh' ||
      ((edit.do === 'move' || edit.do === 'weigh') && (last as typeof edit).point === edit.point));
  return [...(again ? edits.slice(0, -1) : edits), edit];
}

/** For a link: `add_x_y*move_point_x_y*weigh_point_radius*remove_point`, and so on. */
export function editsToText(edits: readonly Edit[]): string {
  return edits.map((edit) => Object.values(edit).flat().join('_')).join('*');
}

/** The changes in a link, or null where it makes no sense. */
export function editsFromText(text: string): Edit[] | null {
  const edits: Edit[] = [];
  for (const part of text.split('*')) {
    const [what, ...rest] = part.split('_');
    const numbers = rest.map(Number);
    if (rest.includes('') || !numbers.every(Number.isFinite)) return null;
    const [point] = numbers;
    const at = numbers.slice(-2) as [number, number];
    const isIndex = (i: number) => Number.isSafeInteger(i) && i >= 0;
    const names = isIndex(point);
    if ((what === 'add' || what === 'corner') && numbers.length === 2) edits.push({ do: what, at });
    else if (what === 'move' && numbers.length === 3 && names)
      edits.push({ do: 'move', point, at });
    else if (what === 'weigh' && numbers.length === 2 && names && numbers[1] >= 0)
      edits.push({ do: 'weigh', point, radius: numbers[1] });
    else if ((what === 'remove' || what === 'join') && numbers.length === 1 && names)
      edits.push({ do: what, point });
    else if (what === 'close' && numbers.length === 0) edits.push({ do: what });
    else if (what === 'erase' && numbers.length > 0 && numbers.every(isIndex)) {
      const points = numbers.slice(1);
      if (points.some((each, i) => i > 0 && each >= points[i - 1])) return null;
      edits.push({ do: what, ring: point, points });
    } else if (what === 'mesh' && numbers.length === 4 && isMeshing(numbers)) {
      const [split, fill, minAngle, maxArea] = numbers;
      edits.push({ do: what, split, fill, minAngle, maxArea });
    } else return null;
  }
  return edits;
}

const isMeshing = ([split, fill, minAngle, maxArea]: number[]) =>
  (split === 0 || split === 1) && fill in FILLS && minAngle >= 0 && minAngle <= 34 && maxArea >= 0;
