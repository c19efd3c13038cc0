import type { Constrained } from '../model/shapes';
import type { Page, Part } from '../page';
import '../styles/overlay.css';
import '../styles/polygons.css';
import { whileBusy } from './busy';
import { byId } from './dom';
import { meshPanel } from './meshPanel';
import { onCanvas, overlay, themeColor } from './overlay';
import { polygonHand } from './polygonHand';
import { toolButton } from './toolButton';

/** The tool that draws polygons in 2D, the panel that says how they are meshed, and what shows them. */
export function polygons(page: Page): Part {
  const begin = overlay('polygons-overlay');
  let shown: Constrained | null = null;
  /** Counts what was asked: an earlier answer is of no interest. */
  let asked = 0;
  const panel = meshPanel(page);
  const tool = toolButton(
    page,
    'draw',
    'Polygon',
    'Each click adds a corner, and one on the first corner closes the polygon',
  );
  const hand = polygonHand(
    page,
    () => shown,
    () => draw(),
  );

  const draw = () => drawPolygons(page, shown, hand.pointer(), begin());
  const tell = () => {
    tool();
    const voronoi = byId<HTMLInputElement>('voronoi');
    if (page.summary?.given !== undefined) {
      voronoi.disabled = true;
      voronoi.parentElement!.title = 'Cells of polygons are not drawn.';
    }
    panel.tell(shown);
  };
  /** Asks the model what has become of the polygons. */
  const refresh = async () => {
    const own = ++asked;
    const answer = await page.model.constrained();
    if (own !== asked) return;
    shown = answer;
    tell();
    draw();
  };

  // A click that comes next has to know the corners.
  const again = () => void whileBusy(refresh());
  if (page.summary) again();
  tell();
  return {
    changed() {
      tell();
      draw();
    },
    ran: again,
    edited: again,
    lived() {
      tell();
      draw();
    },
    showed: tell,
    moved: draw,
  };
}

/** Draws the polygon that is not closed yet as far as the pointer, and the segments that cross. */
function drawPolygons(
  page: Page,
  shown: Constrained | null,
  pointer: readonly [number, number] | null,
  context: CanvasRenderingContext2D,
): void {
  const points = (page.positions?.length ?? 0) / 3;
  if (!shown || !page.viewer || page.live || page.summary?.given === undefined) return;
  const trace = (places: readonly (readonly [number, number])[]) => {
    context.beginPath();
    for (const [x, y] of places) context.lineTo(x, y);
    context.stroke();
  };
  const at = (i: number) => onCanvas(page, i);
  context.lineWidth = 3;
  context.lineCap = 'round';
  context.strokeStyle = themeColor('bad');
  context.fillStyle = themeColor('ink');
  context.font = `12px ${themeColor('sans')}`;
  for (const ends of shown.crossing.flat()) {
    if (ends.some((i) => i >= points)) continue;
    trace(ends.map(at));
    for (const i of ends) {
      const [x, y] = at(i);
      context.fillText(String(i), x + 8, y - 8);
    }
  }

  const open = shown.open.filter((i) => i < points);
  if (open.length === 0) return;
  context.strokeStyle = themeColor('accent');
  context.lineWidth = 2;
  trace(open.map(at));
  if (pointer && page.tool === 'draw') {
    context.setLineDash([4, 5]);
    trace([at(open.at(-1)!), pointer]);
    context.setLineDash([]);
  }
  // Here it can be closed.
  if (open.length > 2) {
    context.beginPath();
    context.arc(...at(open[0]), 9, 0, 2 * Math.PI);
    context.stroke();
  }
}
