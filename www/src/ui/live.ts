import { framesChart } from '../charts/frames';
import type { Page, Part } from '../page';
import { byId, count, create, duration, measured, simplices, things } from './dom';
import { showLegend } from './legend';
import { updateOf } from './update';

const KEPT = 120;

/**
 * The live mode: asks for one frame after the other, as fast as they come, until it is stopped or
 * there is a new mesh.
 */
export function live(page: Page): Part {
  const button = byId<HTMLButtonElement>('live');
  const number = byId<HTMLInputElement>('live-number');
  const times = byId('live-times');
  let running = 0;

  const stop = () => {
    running = 0;
    if (page.live) page.goLive(false);
    button.setAttribute('aria-pressed', 'false');
    button.textContent = 'Start';
  };

  const start = async () => {
    const run = (running = performance.now());
    button.setAttribute('aria-pressed', 'true');
    button.textContent = 'Stop';
    page.goLive(true);
    times.hidden = false;
    const frames: { milliseconds: number; isUpdate: boolean }[] = [];
    page.viewer?.showPoints(null);
    page.viewer?.showHull(null);
    page.viewer?.showFacets(null);
    // What they say is of the run before.
    byId('backend-used').textContent = '';
    byId('strip').hidden = true;
    const { dimension } = page.settings.source;
    let charted = 0;
    let last = performance.now();
    while (running === run && page.viewer) {
      const { settings, viewer } = page;
      const points = Math.min(200_000, Math.max(10, Math.round(number.valueAsNumber) || 3000));
      const seconds = (performance.now() - run) / 1000;
      const frame = await page.model.liveFrame(dimension, points, settings.backend, seconds, {
        filter: { kind: 'all', alpha: null },
        plane: { normal: page.view.normal, keep: settings.keep },
        color: settings.color === 'phase' ? 'quality' : settings.color,
        pieces: settings.apart > 0,
        round: null,
        voronoi: settings.layers.voronoi,
        skin: settings.layers.skin,
      });
      if (running !== run) return;
      viewer.showSurface(frame.drawing.surface);
      viewer.showPieces(frame.drawing.pieces);
      viewer.showVoronoi(frame.drawing.voronoi);
      viewer.showPoints(frame.positions);
      page.look();
      showLegend(frame.drawing, settings, false);
      await viewer.drawn();
      if (running !== run) return;
      const now = performance.now();
      const { milliseconds, update } = frame;
      frames.push({ milliseconds, isUpdate: update?.restarted === null });
      if (frames.length > KEPT) frames.shift();
      if (now - charted > 400) {
        charted = now;
        byId('count').textContent =
          `${count(points)} moving points → ${simplices(frame.simplices, dimension)}`;
        byId('took').replaceChildren(
          `${duration(milliseconds)} per frame, ${measured(1000 / (now - last))} frames per second`,
        );
        byId('backend-used').textContent = updateOf(update, dimension);
        const chart = await framesChart(frames.map((frame) => frame.milliseconds));
        const updates = frames.filter(({ isUpdate }) => isUpdate).length;
        times.replaceChildren(
          create(
            'p',
            { className: 'note' },
            `Milliseconds to triangulate, for the last ${things(frames.length, 'frame', 'frames')}, of which ${count(updates)} kept the mesh of the one before`,
          ),
          chart,
        );
      }
      last = now;
    }
  };

  button.addEventListener('click', () => {
    if (running) {
      stop();
      // Back to the mesh before.
      if (page.summary) page.restore();
    } else void start().catch(() => stop());
  });
  return { ran: stop };
}
