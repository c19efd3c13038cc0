import * as Comlink from 'comlink';
import { Address, haveSamePoints, wholeHash } from './address';
import type { Dimension } from './geometry/dimension';
import { connect } from './model/client';
import type { Edit } from './model/edits';
import type { Drawing, Summary } from './model/model';
import type { Found } from './model/scanned';
import { filterFor, isShapes, type Source, titleOf } from './model/source';
import type { Progress } from './model/worker';
import type { Page, Part } from './page';
import {
  colorFor,
  defaults,
  FRESH,
  fileIn,
  fromHash,
  type LinkedFile,
  type Settings,
  type Tool,
  viewOf,
} from './settings';
import { Stage } from './stage';
import { about } from './ui/about';
import { axes } from './ui/axes';
import { showBusy, whileBusy } from './ui/busy';
import { comparePanel } from './ui/comparePanel';
import { complaint } from './ui/complaint';
import { dimensionSwitch } from './ui/dimension';
import { dock } from './ui/dock';
import { byId } from './ui/dom';
import { wireDrop } from './ui/drop';
import { editor } from './ui/editor';
import { firstVisit } from './ui/firstVisit';
import { wireKeyboard } from './ui/keyboard';
import { polygons, weights } from './ui/lazy';
import { showLegend } from './ui/legend';
import { live } from './ui/live';
import { showMessage, wireMessage } from './ui/message';
import { notes } from './ui/notes';
import { keepOffline } from './ui/offline';
import { pointer } from './ui/pointer';
import { pointsPanel } from './ui/pointsPanel';
import { showResult } from './ui/result';
import { ruler } from './ui/ruler';
import { runPanel, whyNotRecord } from './ui/runPanel';
import { scaleBar } from './ui/scaleBar';
import { wireShare } from './ui/share';
import { showStrip } from './ui/strip';
import { surfaceLine } from './ui/surface';
import { wireTabs } from './ui/tabs';
import { paint, wireTheme } from './ui/theme';
import { usePanel } from './ui/usePanel';
import { viewPanel } from './ui/viewPanel';
import type { Viewer } from './view/viewer';

/** What is said while a radius is sought. */
const SEEKING = { phase: 'Finding the radius', fraction: 0 };

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
  summary: Summary | null = null;
  surface: Found | null = null;
  isRadiusFound = false;
  live = false;
  hasGpu: boolean | null = null;
  tool: Tool = 'move';
  private readonly parts: Part[];
  /** What was there when the visitor left for the other dimension. */
  private left: Settings | null = null;
  private editing = false;
  /** The search for a surface, and of which run that is. */
  private finding: { run: number; done: Promise<void> } | null = null;
  /** The search for a radius, and of which mesh that is. */
  private seeking: { mesh: number; done: Promise<void> } | null = null;
  /** Counts the meshes, also those of points that were changed by hand. */
  private meshes = 0;
  /** Counts the runs: what an earlier one still says is no longer of interest. */
  private lastRun = 0;
  /** Whether a run comes from the browser's history. */
  private following = false;
  private readonly stage: Stage = new Stage(this, {
    drew: (drawing) => {
      showLegend(drawing, this.settings, this.summary?.colorSource != null);
      for (const part of this.parts) part.drew?.(drawing);
    },
    moved: () => {
      for (const part of this.parts) part.moved?.();
    },
    turned: (camera) => {
      this.settings.camera = camera;
      for (const part of this.parts) part.moved?.();
      this.address.remember();
    },
  });
  private readonly address = new Address(() => this.settings);
  /** The view in the link that was followed here, for a file that the visitor does not have yet. */
  private awaited: { asked: LinkedFile; settings: Settings } | null = null;

  constructor() {
    wireMessage();
    wireTabs((panel) => {
      for (const part of this.parts) part.showed?.(panel);
    });
    wireTheme(() => this.viewer && paint(this.viewer));
    wireDrop(this);
    wireShare(this);
    this.parts = [
      dimensionSwitch(this),
      pointsPanel(this),
      viewPanel(this),
      dock(this),
      notes(this),
      surfaceLine(this),
      weights(this),
      polygons(this),
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
      about(this),
      firstVisit(this),
    ];
    wireKeyboard(this);
    byId('cancel').addEventListener('click', () => this.model.cancel());
    window.addEventListener('hashchange', () => void this.followHash());
    this.tell();
    void whileBusy(this.stage.start());
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
    this.awaited = { asked, settings };
    this.settings = defaults(settings.source.dimension);
    await this.run(this.settings.source);
    showMessage(
      `This link shows “${asked.name}”, a file that stayed with the person who shared it. Open the same file here to see it as they did.`,
    );
  }

  run(source: Source, settings: Partial<Settings> = {}): Promise<boolean> {
    this.address.keep(source);
    if (source.kind === 'file' && this.awaited?.asked.name === titleOf(source)) {
      if (this.awaited.asked.bare) source.bare = true;
      settings = { ...this.awaited.settings, source, ...settings };
    }
    const { dimension } = source;
    // Shapes are in 2D, wherever they are dropped.
    if (dimension !== this.settings.source.dimension)
      settings = { layers: defaults(dimension).layers, ...settings };
    const {
      edits = [],
      backend = this.settings.backend,
      weights = source === this.settings.source ? this.settings.weights : null,
    } = settings;
    return whileBusy(
      this.newRun(source, { edits, weights, ...settings }, (onProgress) =>
        this.model.run(source, edits, weights, backend, onProgress),
      ),
    );
  }

  goTo(dimension: Dimension): void {
    const { settings, left } = this;
    if (dimension === settings.source.dimension) return;
    const to = left?.source.dimension === dimension ? left : defaults(dimension);
    // A scan can be looked at in both.
    const { kind } = settings.source;
    if ((kind === 'file' || kind === 'url') && !isShapes(titleOf(settings.source))) {
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
        const { edits, backend, filter, alpha } = this.settings;
        done = edits;
        // Each of many meshes in a row is drawn once: with its radius, if that is to be seen.
        const request = { ...this.stage.request(), filter: { kind: filter, alpha } };
        const edited = await this.model.edit(done, backend, request);
        if (run !== this.lastRun) return;
        const { summary } = edited;
        this.hasNewMesh(summary, filter === 'alpha' && alpha === null);
        showResult(summary, titleOf(this.settings.source));
        showStrip(summary);
        this.stage.showEdited(edited, request);
        for (const part of this.parts) part.edited?.(summary);
      }
      this.tell();
    } catch (error) {
      if (run === this.lastRun) showMessage(complaint(this.settings.source, error));
    } finally {
      this.editing = false;
    }
    // Settings may have changed meanwhile.
    if (run === this.lastRun) await this.draw();
  }

  goLive(on: boolean): void {
    this.live = on;
    if (on) this.stage.catchUp();
    for (const part of this.parts) part.lived?.(on);
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
      this.hasNewMesh(summary, false);
      this.surface = null;
      showResult(summary, titleOf(this.settings.source));
      showStrip(summary);
      for (const part of this.parts) part.ran?.(summary);
      await this.stage.newMesh(isNew || run === 1);
      this.change(settings);
      this.address.write();
      if (this.settings.filter === 'surface') await this.findSurface();
      await this.seekRadius();
      if (isLast()) await this.stage.open();
      return true;
    } catch (error) {
      if (isLast()) {
        this.tell();
        showMessage(complaint(source, error));
        // The run has ended the search that was on.
        void this.draw();
      }
      return false;
    } finally {
      running = false;
      if (isLast()) showBusy(null);
    }
  }

  /**
   * Finds the surface of the points, which are shown until then, and shows it. Where they are no scan, and nobody
   * has asked for it, they are shown as a carved solid.
   */
  private findSurface(): Promise<void> {
    const run = this.lastRun;
    if (this.finding?.run !== run || this.surface) this.finding = { run, done: this.find(run) };
    return this.finding.done;
  }

  private async find(run: number): Promise<void> {
    let found: Found | null = null;
    showBusy({ phase: 'Finding the surface', fraction: 0 });
    try {
      found = await this.model.findSurface();
    } catch (error) {
      // Points of a file were to be seen, and are.
      if (run === this.lastRun && !this.isSurfaceDefault)
        showMessage(complaint(this.settings.source, error));
    }
    if (run !== this.lastRun) return;
    showBusy(this.seeking && SEEKING);
    if (this.settings.filter !== 'surface') return;
    if (!found?.triangles || (this.isSurfaceDefault && !found.suits)) {
      this.change({ filter: 'carve' });
      return;
    }
    this.surface = found;
    for (const part of this.parts) part.found?.(found);
    this.tell();
    await this.stage.draw();
  }

  /** Takes over the summary of a new mesh. */
  private hasNewMesh(summary: Summary, isRadiusFound: boolean): void {
    this.meshes++;
    this.summary = summary;
    this.isRadiusFound = isRadiusFound;
  }

  /** Finds the radius that suits the filter `alpha` and shows it, if that is asked for and not there yet. */
  private seekRadius(): Promise<void> {
    // Changes by hand bring it.
    if (!this.lacksRadius || !this.summary || this.live || this.editing) return Promise.resolve();
    const mesh = this.meshes;
    if (this.seeking?.mesh !== mesh) this.seeking = { mesh, done: this.seek(mesh) };
    return this.seeking.done;
  }

  private async seek(mesh: number): Promise<void> {
    const run = this.lastRun;
    showBusy(SEEKING);
    let error: unknown = null;
    try {
      await this.model.findRadius();
    } catch (thrown) {
      error = thrown;
    }
    if (this.seeking?.mesh === mesh) this.seeking = null;
    if (run !== this.lastRun) return;
    showBusy(this.seeking && SEEKING);
    // Points that are changed meanwhile get another one.
    if (mesh !== this.meshes || this.editing) return;
    if (error === null) {
      this.isRadiusFound = true;
      await this.stage.draw();
    } else if (this.lacksRadius) {
      showMessage(complaint(this.settings.source, error));
      this.change({ filter: 'all' });
    }
  }

  /** Whether a radius is to be seen that is not found yet. */
  private get lacksRadius(): boolean {
    const { filter, alpha } = this.settings;
    return filter === 'alpha' && alpha === null && !this.isRadiusFound;
  }

  /** Whether the surface is shown unless something else is asked for. */
  private get isSurfaceDefault(): boolean {
    return filterFor(this.settings.source) === 'surface';
  }

  change(settings: Partial<Settings>): void {
    Object.assign(this.settings, settings);
    if (settings.filter === 'surface' && !this.surface && this.summary && !this.live)
      void whileBusy(this.findSurface());
    if (
      (settings.color === 'phase' || settings.layers?.facets) &&
      this.summary &&
      !this.summary.trace &&
      this.canRecord
    ) {
      void this.record();
    }
    if (settings.camera !== undefined) this.stage.place();
    this.tell();
    void this.draw();
  }

  /** Draws what the settings say, and then with the radius that this may take. */
  private async draw(): Promise<void> {
    await Promise.all([this.stage.draw(), whileBusy(this.seekRadius())]);
  }

  restore(): void {
    showResult(this.summary!, titleOf(this.settings.source));
    showStrip(this.summary!);
    void whileBusy(this.stage.again());
    void whileBusy(this.seekRadius());
  }

  private get canRecord(): boolean {
    return whyNotRecord(this) === null;
  }

  showRound(round: number | null): void {
    this.stage.showRound(round);
  }

  private tell(): void {
    document.documentElement.toggleAttribute('data-embed', this.settings.embed);
    for (const part of this.parts) part.changed?.(this.settings);
    this.address.remember();
  }

  get view(): ReturnType<typeof viewOf> {
    return viewOf(this.settings, this.summary);
  }

  get viewer(): Viewer | null {
    return this.stage.viewer;
  }

  get lastDrawing(): Drawing | null {
    return this.stage.lastDrawing;
  }

  get positions(): Float32Array | null {
    return this.stage.positions;
  }

  look(): void {
    this.stage.look();
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
}
