/** A change that a visitor made to 2D points by hand. */
export type Edit =
  | { do: 'add'; at: [number, number] }
  | { do: 'move'; point: number; at: [number, number] }
  /** Makes a point as heavy as a ball of this radius. */
  | { do: 'weigh'; point: number; radius: number }
  /** The points behind it move up. */
  | { do: 'remove'; point: number };

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
    if (edit.do === 'add') {
      edited.set(edit.at, end);
      end += 2;
    } else if (2 * edit.point < end) {
      if (edit.do === 'move') edited.set(edit.at, 2 * edit.point);
      else if (edit.do === 'remove') {
        edited.copyWithin(2 * edit.point, 2 * edit.point + 2, end);
        end -= 2;
      }
    }
  }
  return edited.subarray(0, end);
}

/** The colours of the points after all changes, three bytes each; an added point is black. */
export function colorsAfter(colors: Uint8Array, edits: readonly Edit[]): Uint8Array {
  if (edits.length === 0) return colors;
  const edited = new Uint8Array(colors.length + 3 * edits.length);
  edited.set(colors);
  let end = colors.length;
  for (const edit of edits) {
    if (edit.do === 'add') {
      edited.fill(0, end, end + 3);
      end += 3;
    } else if (edit.do === 'remove' && 3 * edit.point < end) {
      edited.copyWithin(3 * edit.point, 3 * edit.point + 3, end);
      end -= 3;
    }
  }
  return edited.subarray(0, end);
}

/** The changes with one more. A point that is moved or weighed again needs only the last place or radius. */
export function withEdit(edits: readonly Edit[], edit: Edit): Edit[] {
  const last = edits.at(-1);
  const again =
    edit.do !== 'add' && edit.do !== 'remove' && last?.do === edit.do && last.point === edit.point;
  return [...(again ? edits.slice(0, -1) : edits), edit];
}

/** For a link: `add_x_y*move_point_x_y*weigh_point_radius*remove_point`. */
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
    const names = Number.isSafeInteger(point) && point >= 0;
    if (what === 'add' && numbers.length === 2) edits.push({ do: 'add', at });
    else if (what === 'move' && numbers.length === 3 && names)
      edits.push({ do: 'move', point, at });
    else if (what === 'weigh' && numbers.length === 2 && names && numbers[1] >= 0)
      edits.push({ do: 'weigh', point, radius: numbers[1] });
    else if (what === 'remove' && numbers.length === 1 && names)
      edits.push({ do: 'remove', point });
    else return null;
  }
  return edits;
}
