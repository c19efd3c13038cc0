type Position = [number, number];

export const SHAPES = ['rectangle', 'circle', 'hexagon'] as const;
export type ShapeName = (typeof SHAPES)[number];

/** A convex polygon, and the box around it: 0, 0, width, height. */
export interface Outline {
  corners: Position[];
  width: number;
  height: number;
}

/** A circle as drawn has so many corners. */
const CORNERS = 120;

/** The outline of a map of 10⁶ units of area, in which all sizes are. */
export function outlineOf(shape: ShapeName, isTall: boolean): Outline {
  if (shape === 'rectangle') {
    const [width, height] = isTall ? [900, 1000 / 0.9] : [1250, 800];
    const corners: Position[] = [
      [0, 0],
      [0, height],
      [width, height],
      [width, 0],
    ];
    return { corners, width, height };
  }
  const count = shape === 'circle' ? CORNERS : 6;
  // Of a regular polygon with this area.
  const radius = Math.sqrt(2e6 / (count * Math.sin((2 * Math.PI) / count)));
  const height = shape === 'circle' ? 2 * radius : Math.sqrt(3) * radius;
  const corners = Array.from({ length: count }, (_, i): Position => {
    // Backwards, which is counter-clockwise on a screen.
    const angle = (-2 * Math.PI * i) / count;
    return [radius * (1 + Math.cos(angle)), height / 2 + radius * Math.sin(angle)];
  });
  return { corners, width: 2 * radius, height };
}
