import * as Comlink from 'comlink';
import type { Filter } from './geometry/filter';
import { connect } from './model/client';
import type { Summary } from './model/model';
import { SAMPLES, type Source } from './model/source';
import { fromHash, type Settings, toHash } from './settings';
import { showBusy } from './ui/busy';
import { byId } from './ui/dom';
import { showLegend } from './ui/legend';
import { showMessage, wireMessage } from './ui/message';
import { showResult } from './ui/result';
import { showStrip } from './ui/strip';
import { wireTabs } from './ui/tabs';
import { paint, wireTheme } from './ui/theme';
import type { Viewer } from './view/viewer';

/** Ties the parts together: settings in, model in its worker, viewer and panel out. */
export class App {
  private settings: Settings = fromHash(location.hash);
  private readonly model = connect();
  private viewer: Viewer | null = null;
  private summary: Summary | null = null;

  async start(): Promise<void> {
    wireMessage();
    wireTabs(() => undefined);
    wireTheme(() => this.viewer && paint(this.viewer));
    const viewer = import('./view/viewer').then(({ Viewer }) =>
      Viewer.create(byId<HTMLCanvasElement>('canvas'), () => this.cameraMoved()),
    );
    await Promise.all([this.run(this.settings.source), viewer.then((v) => { this.viewer = v; paint(v); v.pose = this.settings.camera; })]);
    await this.show();
  }

  async run(source: Source): Promise<void> {
    showMessage(null);
    this.summary = await this.model.run(source, this.settings.engine, Comlink.proxy(showBusy));
    showBusy(null);
    this.settings.source = source;
    showResult(this.summary);
    showStrip(this.summary);
  }

  get filter(): Filter {
    const { filter, alpha, source } = this.settings;
    if (filter === 'all') return { kind: 'all' };
    const fallback = source.kind === 'sample' ? SAMPLES[source.sample].alpha : this.summary!.alpha.typical;
    return { kind: filter, alpha: alpha ?? fallback };
  }

  async show(): Promise<void> {
    if (!this.viewer) return;
    const { normal, keep, color, apart, map } = this.settings;
    const drawing = await this.model.draw({ filter: this.filter, plane: { normal, keep }, color, pieces: apart > 0, round: null });
    this.viewer.showSurface(drawing.surface);
    this.viewer.showPieces(drawing.pieces);
    this.viewer.showPoints(await this.model.positions());
    this.viewer.look.planeNormal.value.set(...normal);
    this.viewer.look.pointsAbove.value = drawing.level;
    showLegend(drawing, map);
  }

  private cameraMoved(): void {
    if (this.viewer) this.settings.camera = this.viewer.pose;
    void toHash;
  }
}
