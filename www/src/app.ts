import * as Comlink from 'comlink';
import type { Filter } from './geometry/filter';
import { connect } from './model/client';
import { type Drawing, type DrawRequest, MOST_POINTS_TO_RECORD, type Summary } from './model/model';
import { type Source, titleOf } from './model/source';
import type { Progress } from './model/worker';
import type { Page, Part } from './page';
import { colorFor, filterFor, fromHash, type Settings, toHash, upFor } from './settings';
import { showBusy } from './ui/busy';
import { comparePanel } from './ui/comparePanel';
import { byId } from './ui/dom';
import { wireDrop } from './ui/drop';
import { wireKeyboard } from './ui/keyboard';
import { showLegend } from './ui/legend';
import { live } from './ui/live';
import { showMessage, wireMessage } from './ui/message';
import { pointer } from './ui/pointer';
import { pointsPanel } from './ui/pointsPanel';
import { showResult } from './ui/result';
import { runPanel } from './ui/runPanel';
import { wireShare } from './ui/share';
import { showStrip } from './ui/strip';
import { wireTabs } from './ui/tabs';
import { paint, wireTheme } from './ui/theme';
import { usePanel } from './ui/usePanel';
import { viewPanel } from './ui/viewPanel';
import type { Viewer } from './view/viewer';

/** Ties the parts together: settings and points in, the model in its worker, the drawing and the panels out. */
export class App implements Page {
  settings: Settings = fromHash(location.hash);
  readonly model = connect();
  viewer: Viewer | null = null;
  summary: Summary | null = null;
  lastDrawing: Drawing | null = null;
  live = false;
  private readonly parts: Part[];
  private round: number | null = null;
  /** Counts the runs: what an earlier one still says is no longer of interest. */
  private lastRun = 0;
  private drawing = false;
  private drawn = '';
  private hashTimer = 0;

  constructor() {
    wireMessage();
    wireTabs((panel) => {
      for (const part of this.parts) part.showed?.(panel);
    });
    wireTheme(() => this.viewer && paint(this.viewer));
    wireDrop(this);
    wireKeyboard(this);
    wireShare(this);
    this.parts = [pointsPanel(this), viewPanel(this), runPanel(this), comparePanel(this), usePanel(this), pointer(this), live(this)];
    byId('cancel').addEventListener('click', () => this.model.cancel());
    window.addEventListener('hashchange', () => this.followHash());
    this.tell();
    void this.startViewer();
    void this.run(this.settings.source, this.settings);
  }

  run(source: Source, settings: Partial<Settings> = {}): Promise<boolean> {
    return this.newRun(source, settings, (onProgress) => this.model.run(source, this.settings.engine, onProgress));
  }

  record(): Promise<boolean> {
    return this.newRun(this.settings.source, {}, (onProgress) => this.model.record(onProgress));
  }

  private async newRun(
    source: Source,
    settings: Partial<Settings>,
    start: (onProgress: Progress) => Promise<Summary>,
  ): Promise<boolean> {
    const run = ++this.lastRun;
    const isLast = () => run === this.lastRun;
    showMessage(null);
    try {
      const summary = await start(Comlink.proxy((progress) => isLast() && showBusy(progress)));
      if (!isLast()) return false;
      if (source !== this.settings.source) {
        if (source.kind !== this.settings.source.kind) this.settings.color = colorFor(source);
        Object.assign(this.settings, { source, filter: filterFor(source), up: upFor(source), alpha: null });
      }
      this.summary = summary;
      this.round = null;
      this.drawn = '';
      showResult(summary);
      showStrip(summary);
      for (const part of this.parts) part.ran?.(summary);
      await this.newMesh();
      this.change(settings);
      return true;
    } catch (error) {
      if (isLast()) {
        this.tell();
        showMessage(complaint(source, error));
      }
      return false;
    } finally {
      if (isLast()) showBusy(null);
    }
  }

  change(settings: Partial<Settings>): void {
    Object.assign(this.settings, settings);
    if ((settings.color === 'phase' || settings.layers?.facets) && this.summary && !this.summary.trace && this.canRecord) {
      void this.record();
    }
    if (settings.camera && this.viewer) this.viewer.pose = settings.camera;
    this.tell();
    void this.draw();
  }

  restore(): void {
    showResult(this.summary!);
    this.drawn = '';
    void this.newMesh().then(() => this.draw());
  }

  private get canRecord(): boolean {
    return this.summary!.dimension === 3 && this.summary!.points <= MOST_POINTS_TO_RECORD;
  }

  showRound(round: number | null): void {
    this.round = round;
    void this.draw();
  }

  private tell(): void {
    for (const part of this.parts) part.changed?.(this.settings);
    this.rememberInHash();
  }

  private async startViewer(): Promise<void> {
    try {
      const { Viewer } = await import('./view/viewer');
      this.viewer = await Viewer.create(
        byId<HTMLCanvasElement>('canvas'),
        () => this.cameraMoved(),
        () => showMessage('The graphics card was reset, and the drawing with it. Reload the page to see it again.'),
      );
    } catch {
      showMessage('This browser can draw neither with WebGPU nor with WebGL 2. Triangulating and downloading work all the same.');
      return;
    }
    paint(this.viewer);
    this.viewer.pose = this.settings.camera;
    if (this.summary) {
      await this.newMesh();
      await this.draw();
    }
  }

  /** Gives the viewer what stays the same for a mesh, however it is cut. */
  private async newMesh(): Promise<void> {
    if (!this.viewer) return;
    this.viewer.showPoints(await this.model.positions());
    this.viewer.showHull(await this.model.hull());
    this.viewer.showFacets(await this.model.nonDelaunayFacets());
    this.look();
  }

  /** Draws what the settings say. Of settings that change while a drawing is made, only the last are drawn. */
  private async draw(): Promise<void> {
    this.look();
    if (this.drawing || this.live || !this.viewer || !this.summary) return;
    this.drawing = true;
    try {
      for (let request = this.request(); JSON.stringify(request) !== this.drawn; request = this.request()) {
        this.drawn = JSON.stringify(request);
        const drawing = await this.model.draw(request);
        this.lastDrawing = drawing;
        this.viewer.showSurface(drawing.surface);
        this.viewer.showPieces(drawing.pieces);
        const { planeNormal, pointsAbove } = this.viewer.look;
        planeNormal.value.set(...request.plane.normal);
        pointsAbove.value = Math.min(drawing.level, 1e9);
        this.look();
        showLegend(drawing, this.settings.map);
        for (const part of this.parts) part.drew?.(drawing);
      }
    } finally {
      this.drawing = false;
    }
  }

  private request(): DrawRequest {
    const { normal, keep, color, apart } = this.settings;
    return { filter: this.filter, plane: { normal, keep }, color, pieces: apart > 0, round: this.round };
  }

  private get filter(): Filter {
    const { filter, alpha } = this.settings;
    return filter === 'all' ? { kind: 'all' } : { kind: filter, alpha: alpha ?? this.summary!.alpha.typical };
  }

  /** What needs no new geometry. */
  private look(): void {
    const { viewer } = this;
    if (!viewer) return;
    const { layers, map, color, apart, up } = this.settings;
    viewer.setUp(up);
    viewer.setColorMap(color === 'phase' ? 'phases' : map);
    viewer.look.edges.value = layers.edges ? 1 : 0;
    viewer.look.apart.value = this.round === null ? apart : Math.max(apart, 0.02);
    viewer.setVisible('surface', layers.tetrahedra);
    viewer.setVisible('pieces', layers.tetrahedra);
    viewer.setVisible('hull', layers.hull);
    viewer.setVisible('facets', layers.facets);
    viewer.setVisible('points', layers.points);
    viewer.look.pointsEverywhere.value = layers.tetrahedra && this.summary?.dimension === 3 ? 0 : 1;
  }

  private cameraMoved(): void {
    if (!this.viewer) return;
    this.settings.camera = this.viewer.pose;
    this.rememberInHash();
  }

  private rememberInHash(): void {
    clearTimeout(this.hashTimer);
    // Browsers allow only so many changes of the address a second.
    this.hashTimer = window.setTimeout(() => history.replaceState(null, '', `#${toHash(this.settings)}`), 300);
  }

  /** The visitor followed a link to another view of this page. */
  private followHash(): void {
    const settings = fromHash(location.hash);
    if (JSON.stringify(settings.source) === JSON.stringify(this.settings.source) && settings.engine === this.settings.engine) {
      this.change(settings);
      return;
    }
    this.settings.engine = settings.engine;
    void this.run(settings.source, settings);
  }
}

/** What to say when a run ends without a mesh. */
function complaint(source: Source, error: unknown): string {
  const { name, message } = error as Error;
  if (name === 'ABORTED' || name === 'AbortError') return 'Cancelled. What you see is the triangulation before.';
  const subject = source.kind === 'file' ? `${titleOf(source)}: ` : '';
  return `${subject}${message}`;
}
