import type { VoronoiArrays } from 'gdel-wasm';
import type { Frame } from './mesh';
import type { Surface } from './surface';

/** What is drawn of a Voronoi diagram. */
export interface CellsToDraw {
  diagram: VoronoiArrays;
  /** Where the input lies in the drawing. */
  frame: Frame;
  /** The points in the frame. */
  positions: Float32Array;
  /** For each point whether its cell is drawn. */
  kept: Uint8Array;
  /** How far the cells are pulled apart; at 0, facets between two of them cannot be seen. */
  apart: number;
}

/**
 * The facets of Voronoi cells as triangles. Their owners are the points. Facets of cells that are
 * not bounded are left out.
 */
export function surfaceOfCells(
  { diagram, frame, positions, kept, apart }: CellsToDraw,
  value: (point: number) => number,
): Surface {
  const { vertices, facetOffsets, facets, neighbors, cells, areas } = diagram;
  /** Calls back for each facet that is drawn. */
  const each = (draw: (point: number, first: number, last: number) => void) => {
    for (let point = 0; point < kept.length; point++) {
      if (!kept[point]) continue;
      for (let f = cells[point]; f < cells[point + 1]; f++) {
        const beyond = neighbors[f];
        const isHidden = apart === 0 && beyond >= 0 && kept[beyond] === 1;
        if (!isHidden && areas[f] < Infinity) draw(point, facetOffsets[f], facetOffsets[f + 1]);
      }
    }
  };
  let count = 0;
  each((_, first, last) => (count += Math.max(0, last - first - 2)));
  const corners = new Float32Array(9 * count);
  const values = new Float32Array(3 * count);
  const owners = new Uint32Array(count);
  const shrink = 1 / (1 + apart);
  let at = 0;
  each((point, first, last) => {
    const own = value(point);
    for (let k = first + 1; k + 1 < last; k++) {
      const triangle = [facets[first], facets[k], facets[k + 1]];
      for (let j = 0; j < 3; j++) {
        for (let axis = 0; axis < 3; axis++) {
          const place = (vertices[3 * triangle[j] + axis] - frame.center[axis]) * frame.scale;
          corners[9 * at + 3 * j + axis] = (place + apart * positions[3 * point + axis]) * shrink;
        }
      }
      values.fill(own, 3 * at, 3 * at + 3);
      owners[at++] = point;
    }
  });
  return { positions: corners, values, skin: new Uint8Array(12 * count), owners };
}
