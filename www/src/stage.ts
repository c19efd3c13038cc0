import { Cutting } from './cutting';
import type { Drawing, DrawRequest } from './model/model';
import type { Edited } from './model/worker';
import type { Page } from './page';
import { whileBusy } from './ui/busy';
import { complaintAbout } from './ui/complaint';
import { byId } from './ui/dom';
import { showMessage } from './ui/message';
import { paint } from './ui/theme';
import type { CameraPose, Viewer } from './view/viewer';

/** How long a new object is shown whole, and how long the cut then moves, in milliseconds. */
const [WHOLE, OPENING] = [500, 900];

/** What stays the same for a mesh, however it is cut. */
type MeshParts = Pick<Edited, 'positions' | 'colors' | 'hull'> & { facets: Float32Array | null };

/** What the stage tells the page. */
export interface StageEvents {
  /** There is a new drawing. */
  drew(drawing: Drawing): void;
  /** The camera has moved, by hand or not, or the drawing has another size. */
  moved(): void;
  /** The visitor has moved the camera. */
  turned(camera: CameraPose): void;
}

/** The drawing: gives the viewer what mesh and settings say. */
export class Stage {
  /** Null until three.js is there, and where the browser cannot draw. */
  viewer: Viewer | null = null;
  lastDrawing: Drawing | null = null;
  /** The points as drawn; null before there are any. */
  positions: Float32Array | null = null;
  /**
   * Of a mesh that is not shown yet: the viewer gets it with the first drawing, and shows what was
   * there before until then.
   */
  private waiting: MeshParts | null = null;
  private readonly cutting: Cutting;
  private round: number | null = null;
  private drawing = false;
  /** What the last drawing was asked to show; empty where the next one has to be made in any case. */
  private drawn = '';
  /** Counts the meshes: the opening of an earlier one ends. */
  private meshes = 0;
  /** The cut while it moves by itself, from everything to where it stays; else null. */
  private sweep: number | null = null;

  constructor(
    private readonly page: Page,
    private readonly events: StageEvents,
  ) {
    this.cutting = new Cutting(page.model);
  }

  /** Loads the viewer, and shows what there is by then. */
  async start(): Promise<void> {
    let loaded: typeof import('./view/viewer');
    try {
      loaded = await import('./view/viewer');
    } catch (error) {
      showMessage(complaintAbout('The drawing', error));
      return;
    }
    try {
      this.viewer = await loaded.Viewer.create(
        byId<HTMLCanvasElement>('canvas'),
        () => this.viewer && this.events.turned(this.viewer.pose),
        () => this.events.moved(),
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
    if (!this.page.summary) return;
    await this.newMesh(true);
    await this.draw();
    await this.open();
  }

  /**
   * Has the next drawing be of a new mesh. Of a new object, the first drawing shows all, and
   * {@link open} cuts it.
   */
  async newMesh(isNewObject: boolean): Promise<void> {
    this.meshes++;
    this.cutting.forget();
    this.round = null;
    this.sweep = isNewObject && this.opensSlowly ? 1 : null;
    await this.fetchMesh();
  }

  /** Shows the mesh again, after the live mode. */
  async again(): Promise<void> {
    await this.fetchMesh();
    await this.draw();
  }

  private async fetchMesh(): Promise<void> {
    this.drawn = '';
    if (!this.viewer) return;
    const { meshes } = this;
    const { model } = this.page;
    const [positions, colors, hull, facets] = await Promise.all([
      model.positions(),
      model.colors(),
      model.hull(),
      model.nonDelaunayFacets(),
    ]);
    if (meshes === this.meshes) this.waiting = { positions, colors, hull, facets };
  }

  /** Gives the viewer the mesh that waits for its first drawing. */
  catchUp(): void {
    const { waiting, viewer } = this;
    if (!waiting || !viewer) return;
    this.waiting = null;
    viewer.setDimension(this.page.summary!.dimension);
    this.place();
    this.give(waiting);
  }

  /** Shows the mesh of points that were changed by hand, as was asked for. */
  showEdited({ drawing, ...parts }: Edited, request: DrawRequest): void {
    this.drawn = JSON.stringify(request);
    if (this.waiting) Object.assign(this.waiting, parts);
    else this.give({ ...parts, facets: null });
    this.show(drawing);
  }

  private give({ positions, colors, hull, facets }: MeshParts): void {
    this.positions = positions;
    this.viewer?.showPoints(positions, colors);
    this.viewer?.showHull(hull);
    this.viewer?.showFacets(facets);
  }

  /** Places the camera as the settings say. */
  place(): void {
    if (this.viewer && !this.waiting) this.viewer.pose = this.page.view.camera;
  }

  /** Shows the triangulation after a round of the trace; null for the result. */
  showRound(round: number | null): void {
    this.round = round;
    void this.draw();
  }

  /**
   * Draws what the settings say. Of settings that change while a drawing is made, only the last are
   * drawn.
   */
  draw(): Promise<void> {
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
  async onScreen(): Promise<void> {
    await this.viewer?.drawn();
  }

  private async followSettings(): Promise<void> {
    const { page } = this;
    if (this.drawing || page.live || !this.viewer || !page.summary) return;
    this.drawing = true;
    try {
      for (
        let request = this.request();
        JSON.stringify(request) !== this.drawn;
        request = this.request()
      ) {
        this.drawn = JSON.stringify(request);
        const drawing = await page.model.draw(request);
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
    this.events.drew(drawing);
    if (!this.viewer) return;
    this.catchUp();
    const { cut } = drawing;
    const onGpu = cut && !drawing.surface ? this.cutting.ready : null;
    // The plane may have moved on meanwhile.
    const level = (onGpu && this.cutting.levelOf(this.request().plane)) ?? drawing.level;
    if (onGpu) this.viewer.showCut(onGpu, level, cut!.skin);
    else this.viewer.showSurface(drawing.surface);
    this.cutting.free();
    if (cut && !onGpu) void this.onScreen().then(() => this.cutOnGpu());
    byId('stage').dataset.cut = this.viewer.cutBy;
    this.viewer.showPieces(drawing.pieces);
    this.viewer.showVoronoi(drawing.voronoi);
    const { planeNormal, pointsAbove } = this.viewer.look;
    planeNormal.value.set(...this.page.view.normal);
    pointsAbove.value = Math.min(level, 1e9);
    this.look();
  }

  /** What the settings ask for. */
  request(): DrawRequest {
    const { settings, summary, view } = this.page;
    const { filter, alpha, keep, color, apart, layers, source } = settings;
    const isSurface = filter === 'surface';
    const isSought = filter === 'alpha' && alpha === null && !this.page.isRadiusFound;
    return {
      // All is shown until the radius is found: drawings do not wait.
      filter: { kind: filter, alpha: isSought ? 'any' : alpha },
      // Until the surface is found.
      pointsOnly: isSurface && !this.page.surface,
      // A surface is whole unless it was cut by hand.
      plane: { normal: view.normal, keep: this.sweep ?? keep ?? (isSurface ? 1 : null) },
      // Only a recorded run tells the phases.
      color: color === 'phase' && !summary?.trace ? 'quality' : color,
      pieces: apart > 0,
      round: this.round,
      skin: layers.skin,
      voronoi: layers.voronoi,
      cells: layers.voronoi && source.dimension === 3 ? apart : null,
      onGpu: this.cutting.ready !== null,
    };
  }

  /** Shows and hides layers as the settings say, after other things were given to the viewer. */
  look(): void {
    const { viewer } = this;
    if (!viewer || this.waiting) return;
    const { settings, summary, view } = this.page;
    const { layers, map, color, apart, source } = settings;
    const flat = source.dimension === 2;
    viewer.setUp(view.up);
    viewer.setColorMap(color === 'phase' && summary?.trace ? 'phases' : map);
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
      layers.simplices && !flat && summary?.dimension === 3 ? 0 : 1;
  }

  /** Whether a new object is shown whole before it is cut. */
  private get opensSlowly(): boolean {
    return (
      this.page.summary!.dimension === 3 &&
      this.page.settings.keep === null &&
      !matchMedia('(prefers-reduced-motion: reduce)').matches
    );
  }

  /**
   * Cuts an object that is shown whole, along the side that faces the camera, unless the visitor
   * cuts it or goes on to something else.
   */
  async open(): Promise<void> {
    if (this.sweep === null || !this.viewer) return;
    if (this.page.settings.filter === 'surface') {
      this.sweep = null;
      return;
    }
    const { meshes } = this;
    await this.draw();
    const started = performance.now();
    for (
      let at = 0;
      at < 1 && meshes === this.meshes && this.page.settings.keep === null;
      at = (performance.now() - started - WHOLE) / OPENING
    ) {
      const eased = Math.max(0, at) ** 2 * (3 - 2 * Math.max(0, at));
      this.sweep = 1 + eased * ((this.lastDrawing?.half ?? 1) - 1);
      await this.draw();
    }
    if (meshes !== this.meshes) return;
    this.sweep = null;
    await this.draw();
  }
}
