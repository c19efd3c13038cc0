import * as Comlink from 'comlink';
import { Address, haveSamePoints, wholeHash } from './address';
import { Cutting } from './cutting';
import { connect } from './model/client';
import type { Edit } from './model/edits';
import type { Drawing, DrawRequest, Summary } from './model/model';
import { type Dimension, type Source, titleOf } from './model/source';
import type { Progress } from './model/worker';
import type { Page, Part } from './page';
import {
  colorFor,
  defaults,
  FRESH,
  fileIn,
  filterFor,
  fromHash,
  type Settings,
  type Tool,
  viewOf,
} from './settings';
import { wireAbout } from './ui/about';
import { axes } from './ui/axes';
import { showBusy, whileBusy } from './ui/busy';
import { comparePanel } from './ui/comparePanel';
import { complaint, complaintAbout } from './ui/complaint';
import { dimensionSwitch } from './ui/dimension';
import { dock } from './ui/dock';
import { byId } from './ui/dom';
import { wireDrop } from './ui/drop';
import { editor } from './ui/editor';
import { firstVisit } from './ui/firstVisit';
import { wireKeyboard } from './ui/keyboard';
import { showLegend } from './ui/legend';
import { live } from './ui/live';
import { showMessage, wireMessage } from './ui/message';
import { keepOffline } from './ui/offline';
import { pointer } from './ui/pointer';
import { pointsPanel } from './ui/pointsPanel';
import { showResult } from './ui/result';
import { ruler } from './ui/ruler';
import { runPanel, whyNotRecord } from './ui/runPanel';
import { scaleBar } from './ui/scaleBar';
import { wireShare } from './ui/share';
import { showStrip } from './ui/strip';
import { wireTabs } from './ui/tabs';
import { paint, wireTheme } from './ui/theme';
import { usePanel } from './ui/usePanel';
import { viewPanel } from './ui/viewPanel';
import type { Viewer } from './view/viewer';

/**
 * Ties the parts together: settings and points in, the model in its worker, the drawing and the
 * panels out.
 */
export class App implements Page {
  settings: Settings = fromHash(wholeHash());
  readonly model = connect(() =>
    showMessage(
      'The part of the page that triangulates could not be started. Check your connection, then reload the page.',
    ),
  );
  viewer: Viewer | null = null;
  summary: Summary | null = null;
  lastDrawing: Drawing | null = null;
  live = false;
  positions: Float32Array | null = null;
  hasGpu: boolean | null = null;
  tool: Tool = 'move';
  private readonly parts: Part[];
  /** What was there when the visitor left for the other dimension. */
  private left: Settings | null = null;
  private editing = false;
  private readonly cutting = new Cutting(this.model);
  private round: number | null = null;
  /** Counts the runs: what an earlier one still says is no longer of interest. */
  private lastRun = 0;
  private drawing = false;
  private drawn = '';
  /** Whether a run comes from the browser's history. */
  private following = false;
  /** The cut while it moves by itself, from everything to where it stays; else null. */
  private sweep: number | null = null;
  private readonly address = new Address(() => this.settings);
  /** The view in the link that was followed here, for a file that the visitor does not have yet. */
  private awaited: { file: string; settings: Settings } | null = null;

  constructor() {
    wireMessage();
    wireTabs((panel) => {
      for (const part of this.parts) part.showed?.(panel);
    });
    wireTheme(() => this.viewer && paint(this.viewer));
    wireDrop(this);
    wireShare(this);
    wireAbout();
    this.parts = [
      dimensionSwitch(this),
      pointsPanel(this),
      viewPanel(this),
      dock(this),
      scaleBar(this),
      axes(this),
      ruler(this),
      runPanel(this),
      comparePanel(this),
      usePanel(this),
      pointer(this),
      // Before the keys of the drawing: a point that is held takes the arrow keys.
      editor(this),
      live(this),
      firstVisit(this),
    ];
    wireKeyboard(this);
    byId('cancel').addEventListener('click', () => this.model.cancel());
    window.addEventListener('hashchange', () => void this.followHash());
    this.tell();
    void whileBusy(this.startViewer());
    void whileBusy(this.start()).then(keepOffline);
    void whileBusy(this.askForGpu());
  }

  /** Finds out what need not be offered. */
  private async askForGpu(): Promise<void> {
    this.hasGpu = Boolean((await this.model.info()).adapter);
    for (const part of this.parts) part.changed?.(this.settings);
  }

  /** Shows what the address says. */
  private async start(): Promise<void> {
    const asked = fileIn(location.hash);
    if (!asked) {
      await this.run(this.settings.source, this.settings);
      return;
    }
    const { settings } = this;
    const source = await this.address.sourceOf(asked, settings.source.dimension);
    if (source) {
      this.settings = { ...settings, source };
      await this.run(source, this.settings);
      return;
    }
    this.awaited = { file: asked.name, settings };
    this.settings = defaults(settings.source.dimension);
    await this.run(this.settings.source);
    showMessage(
      `This link shows “${asked.name}”, a file that stayed with the person who shared it. Open the same file here to see it as they did.`,
    );
  }

  run(source: Source, settings: Partial<Settings> = {}): Promise<boolean> {
    this.address.keep(source);
    if (source.kind === 'file' && this.awaited?.file === titleOf(source))
      settings = { ...this.awaited.settings, source, ...settings };
    const { edits = [], backend = this.settings.backend } = settings;
    return whileBusy(
      this.newRun(source, { edits, ...settings }, (onProgress) =>
        this.model.run(source, edits, backend, onProgress),
      ),
    );
  }

  goTo(dimension: Dimension): void {
    const { settings, left } = this;
    if (dimension === settings.source.dimension) return;
    const to = left?.source.dimension === dimension ? left : defaults(dimension);
    // A scan can be looked at in both.
    if (settings.source.kind === 'file' || settings.source.kind === 'url') {
      const source: Source = { ...settings.source, dimension };
      Object.assign(to, {
        source,
        edits: [],
        filter: filterFor(source),
        color: colorFor(source),
        ...FRESH,
      });
    }
    void this.run(to.source, { ...to, backend: settings.backend });
  }

  edit(edits: readonly Edit[]): Promise<void> {
    this.settings.edits = edits;
    return this.editing ? Promise.resolve() : whileBusy(this.followEdits());
  }

  private async followEdits(): Promise<void> {
    this.editing = true;
    const run = this.lastRun;
    try {
      for (
        let done: readonly Edit[] | null = null;
        done !== this.settings.edits && run === this.lastRun;
      ) {
        done = this.settings.edits;
        const { summary, drawing, positions, colors, hull } = await this.model.edit(
          done,
          this.settings.backend,
          this.request(),
        );
        if (run !== this.lastRun) return;
        this.summary = summary;
        this.drawn = JSON.stringify(this.request());
        showResult(summary, titleOf(this.settings.source));
        showStrip(summary);
        this.positions = positions;
        this.viewer?.showPoints(positions, colors);
        this.viewer?.showHull(hull);
        this.show(drawing);
        for (const part of this.parts) part.edited?.(summary);
      }
      this.tell();
      await this.onScreen();
    } catch (error) {
      if (run === this.lastRun) showMessage(complaint(this.settings.source, error));
    } finally {
      this.editing = false;
    }
  }

  record(): Promise<boolean> {
    return whileBusy(
      this.newRun(this.settings.source, {}, (onProgress) => this.model.record(onProgress)),
    );
  }

  private async newRun(
    source: Source,
    settings: Partial<Settings>,
    start: (onProgress: Progress) => Promise<Summary>,
  ): Promise<boolean> {
    const run = ++this.lastRun;
    const isLast = () => run === this.lastRun;
    showMessage(null);
    // Progress has a port of its own: the last of it may come after the result.
    let running = true;
    try {
      const summary = await start(
        Comlink.proxy((progress) => running && isLast() && showBusy(progress)),
      );
      if (!isLast()) return false;
      const before = this.settings;
      const isNew = source !== before.source;
      if (isNew) {
        if (!this.following && this.summary) this.address.leave();
        if (source.dimension !== before.source.dimension) this.left = { ...before };
        if (source.kind !== before.source.kind) before.color = colorFor(source);
        Object.assign(before, {
          source,
          filter: filterFor(source),
          layers: { ...before.layers, skin: true },
          ...FRESH,
        });
      }
      Object.assign(before, settings);
      this.summary = summary;
      this.cutting.forget();
      this.round = null;
      this.drawn = '';
      showResult(summary, titleOf(this.settings.source));
      showStrip(summary);
      for (const part of this.parts) part.ran?.(summary);
      this.sweep = (isNew || run === 1) && this.opensSlowly ? 1 : null;
      await this.newMesh();
      this.change(settings);
      this.address.write();
      await this.cutSlowly(run);
      return true;
    } catch (error) {
      if (isLast()) {
        this.tell();
        showMessage(complaint(source, error));
      }
      return false;
    } finally {
      running = false;
      if (isLast()) showBusy(null);
    }
  }

  change(settings: Partial<Settings>): void {
    Object.assign(this.settings, settings);
    if (
      (settings.color === 'phase' || settings.layers?.facets) &&
      this.summary &&
      !this.summary.trace &&
      this.canRecord
    ) {
      void this.record();
    }
    if (settings.camera !== undefined && this.viewer) this.viewer.pose = this.view.camera;
    this.tell();
    void this.draw();
  }

  restore(): void {
    showResult(this.summary!, titleOf(this.settings.source));
    showStrip(this.summary!);
    this.drawn = '';
    void whileBusy(this.newMesh().then(() => this.draw()));
  }

  private get canRecord(): boolean {
    return whyNotRecord(this) === null;
  }

  showRound(round: number | null): void {
    this.round = round;
    void this.draw();
  }

  private tellMoved(): void {
    for (const part of this.parts) part.moved?.();
  }

  private tell(): void {
    document.documentElement.toggleAttribute('data-embed', this.settings.embed);
    for (const part of this.parts) part.changed?.(this.settings);
    this.address.remember();
  }

  private async startViewer(): Promise<void> {
    let Viewer: typeof import('./view/viewer').Viewer;
    try {
      ({ Viewer } = await import('./view/viewer'));
    } catch (error) {
      showMessage(complaintAbout('The drawing', error));
      return;
    }
    try {
      this.viewer = await Viewer.create(
        byId<HTMLCanvasElement>('canvas'),
        () => this.cameraMoved(),
        () => this.tellMoved(),
        () =>
          showMessage(
            'The GPU was reset, and the drawing is lost. Reload the page to get it back.',
          ),
      );
    } catch {
      showMessage(
        'This browser can draw neither with WebGPU nor with WebGL 2. Triangulating and downloading still work.',
      );
      return;
    }
    paint(this.viewer);
    if (!this.summary) return;
    this.sweep = this.opensSlowly ? 1 : null;
    await this.newMesh();
    await this.draw();
    await this.cutSlowly(this.lastRun);
  }

  /** Gives the viewer what stays the same for a mesh, however it is cut. */
  private async newMesh(): Promise<void> {
    if (!this.viewer) return;
    this.viewer.setDimension(this.summary!.dimension);
    this.viewer.pose = this.view.camera;
    this.positions = await this.model.positions();
    this.viewer.showPoints(this.positions, await this.model.colors());
    this.viewer.showHull(await this.model.hull());
    this.viewer.showFacets(await this.model.nonDelaunayFacets());
    this.look();
  }

  /**
   * Draws what the settings say. Of settings that change while a drawing is made, only the last are
   * drawn.
   */
  private draw(): Promise<void> {
    this.look();
    this.moveCut();
    return whileBusy(this.followSettings().then(() => this.onScreen()));
  }

  /** Cuts the mesh on the GPU, if it is there, before the worker knows what is to be seen. */
  private moveCut(): void {
    const level = this.cutting.levelOf(this.request().plane);
    if (level !== null) this.viewer?.moveCut(level);
  }

  /** Brings the mesh to the GPU, which from then on cuts it by itself. */
  private async cutOnGpu(): Promise<void> {
    const device = this.viewer?.device;
    if (device && (await this.cutting.begin(device, () => this.lastDrawing?.cut)))
      await this.followSettings();
  }

  /** Resolves once the browser shows what the viewer was given. */
  private async onScreen(): Promise<void> {
    await this.viewer?.drawn();
  }

  private async followSettings(): Promise<void> {
    if (this.drawing || this.live || !this.viewer || !this.summary) return;
    this.drawing = true;
    try {
      for (
        let request = this.request();
        JSON.stringify(request) !== this.drawn;
        request = this.request()
      ) {
        this.drawn = JSON.stringify(request);
        const drawing = await this.model.draw(request);
        if (request.onGpu && drawing.cut && !(await this.cutting.follow(drawing.cut)))
          this.cutting.forget();
        else this.show(drawing);
      }
    } finally {
      this.drawing = false;
    }
  }

  private show(drawing: Drawing): void {
    this.lastDrawing = drawing;
    showLegend(drawing, this.settings, this.summary?.colorSource != null);
    for (const part of this.parts) part.drew?.(drawing);
    if (!this.viewer) return;
    const { cut } = drawing;
    const onGpu = cut && !drawing.surface ? this.cutting.ready : null;
    // The plane may have moved on meanwhile.
    const level = (onGpu && this.cutting.levelOf(this.request().plane)) ?? drawing.level;
    if (onGpu) this.viewer.showCut(onGpu, level, cut!.skin);
    else this.viewer.showSurface(drawing.surface);
    this.cutting.free();
    if (cut && !onGpu) void this.cutOnGpu();
    byId('stage').dataset.cut = this.viewer.cutBy;
    this.viewer.showPieces(drawing.pieces);
    this.viewer.showVoronoi(drawing.voronoi);
    const { planeNormal, pointsAbove } = this.viewer.look;
    planeNormal.value.set(...this.view.normal);
    pointsAbove.value = Math.min(level, 1e9);
    this.look();
  }

  private request(): DrawRequest {
    const { filter, alpha, keep, color, apart, layers } = this.settings;
    return {
      filter: { kind: filter, alpha },
      plane: { normal: this.view.normal, keep: this.sweep ?? keep },
      // Only a recorded run tells the phases.
      color: color === 'phase' && !this.summary?.trace ? 'quality' : color,
      pieces: apart > 0,
      round: this.round,
      skin: layers.skin,
      voronoi: layers.voronoi,
      cells: layers.voronoi && this.settings.source.dimension === 3 ? apart : null,
      onGpu: this.cutting.ready !== null,
    };
  }

  get view(): ReturnType<typeof viewOf> {
    return viewOf(this.settings, this.summary);
  }

  look(): void {
    const { viewer } = this;
    if (!viewer) return;
    const { layers, map, color, apart, source } = this.settings;
    const flat = source.dimension === 2;
    viewer.setUp(this.view.up);
    viewer.setColorMap(color === 'phase' && this.summary?.trace ? 'phases' : map);
    // Facets of Voronoi cells are drawn as several triangles.
    viewer.look.edges.value = layers.edges && !this.lastDrawing?.cells ? 1 : 0;
    viewer.look.apart.value = this.round === null ? apart : Math.max(apart, 0.02);
    viewer.look.ownColors.value = layers.skin ? 1 : 0;
    viewer.look.fill.value = layers.simplices ? 1 : 0;
    viewer.setVisible('surface', layers.simplices);
    viewer.setVisible('cut', layers.simplices);
    viewer.setVisible('flat', layers.simplices || layers.edges);
    viewer.setVisible('pieces', layers.simplices);
    viewer.setVisible('voronoi', layers.voronoi);
    viewer.setVisible('hull', layers.hull);
    viewer.setVisible('hullEdges', layers.hull);
    viewer.setVisible('facets', layers.facets);
    viewer.setVisible('points', layers.points);
    viewer.look.pointsEverywhere.value =
      layers.simplices && !flat && this.summary?.dimension === 3 ? 0 : 1;
  }

  private cameraMoved(): void {
    if (!this.viewer) return;
    this.settings.camera = this.viewer.pose;
    this.tellMoved();
    this.address.remember();
  }

  /** The visitor followed a link to another view of this page, or went back to one. */
  private async followHash(): Promise<void> {
    const settings = await this.address.read();
    if (haveSamePoints(settings, this.settings)) {
      this.change({ ...settings, source: this.settings.source });
      return;
    }
    this.following = true;
    try {
      await this.run(settings.source, settings);
    } finally {
      this.following = false;
    }
  }

  /** Whether a new object is shown whole before it is cut. */
  private get opensSlowly(): boolean {
    return (
      this.summary!.dimension === 3 &&
      this.settings.keep === null &&
      !matchMedia('(prefers-reduced-motion: reduce)').matches
    );
  }

  /**
   * Cuts an object that is shown whole, along the side that faces the camera, unless the visitor
   * cuts it or goes on to something else.
   */
  private async cutSlowly(run: number): Promise<void> {
    if (this.sweep === null || !this.viewer) return;
    await this.draw();
    const started = performance.now();
    for (
      let at = 0;
      at < 1 && run === this.lastRun && this.settings.keep === null;
      at = (performance.now() - started - WHOLE) / OPENING
    ) {
      const eased = Math.max(0, at) ** 2 * (3 - 2 * Math.max(0, at));
      this.sweep = 1 + eased * ((this.lastDrawing?.half ?? 1) - 1);
      await this.draw();
    }
    if (run !== this.lastRun) return;
    this.sweep = null;
    await this.draw();
  }
}

/** How long a new object is shown whole, and how long the cut then moves, in milliseconds. */
const [WHOLE, OPENING] = [500, 900];
