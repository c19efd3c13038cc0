import { CUT_PARTS, type CutOf, type CutPart } from './geometry/cut';
import { levelOf, type Plane } from './geometry/plane';
import type { ModelClient } from './model/client';
import { MAX_FACETS } from './model/model';
import type { Cut } from './view/cut';

/** So many items of a part are uploaded at a time: at most 4 MB, so that the page stays smooth. */
const SLICE = 1 << 18;

const PARTS = Object.keys(CUT_PARTS) as CutPart[];

/**
 * Has the mesh that is shown on the GPU that draws, beside the worker, which still knows how much is
 * to be seen, and what the pointer is at. The plane then moves without waiting for it.
 */
export class Cutting {
  private cut: Cut | null = null;
  /** Which tetrahedra it is made for. */
  private mesh = '';
  /** What is in the parts. */
  private has: Partial<CutOf['parts']> = {};
  /** What the mesh on the GPU is cut by; null until all parts are there. */
  private of: CutOf | null = null;
  /** What is not shown any more from the next drawing on. */
  private old: Cut[] = [];
  private isBusy = false;
  /** Whether there is no room for the mesh, or it cannot be had. */
  private isRefused = false;
  /** Counts the meshes: what is still on its way for an earlier one is of no use. */
  private meshes = 0;

  constructor(private readonly model: ModelClient) {}

  /** The mesh on the GPU, once all of it is there. */
  get ready(): Cut | null {
    return this.of && this.cut;
  }

  /** Has no mesh any more. The one that is shown stays until {@link free}. */
  forget(): void {
    this.meshes++;
    if (this.cut) this.old.push(this.cut);
    this.cut = this.of = null;
    this.has = {};
    this.isBusy = this.isRefused = false;
  }

  /** Frees the memory of meshes that were forgotten, once something else is shown. */
  free(): void {
    for (const cut of this.old.splice(0)) cut.destroy();
  }

  /**
   * Brings the mesh of the latest drawing to the GPU, or goes on with it, unless it is there.
   * Resolves to whether this has completed it.
   */
  async begin(device: GPUDevice, latest: () => CutOf | undefined): Promise<boolean> {
    if (this.isBusy || this.isRefused || this.ready) return false;
    const { meshes } = this;
    this.isBusy = true;
    try {
      return await this.load(device, latest);
    } catch {
      // The worker goes on cutting.
      if (meshes === this.meshes) this.isRefused = true;
      return false;
    } finally {
      if (meshes === this.meshes) this.isBusy = false;
    }
  }

  private async load(device: GPUDevice, latest: () => CutOf | undefined): Promise<boolean> {
    const { meshes } = this;
    let of = latest();
    if (of && !this.cut) {
      const { Cut } = await import('./view/cut');
      const most = Math.min(MAX_FACETS, 4 * of.tetrahedra);
      const cut = await Cut.create(device, { ...of, most });
      if (meshes !== this.meshes) {
        cut?.destroy();
        return false;
      }
      this.cut = cut;
      this.mesh = of.parts.tetrahedra;
      this.isRefused = !cut;
    }
    const { cut } = this;
    while (of && cut) {
      // Another filter may have other tetrahedra: those of a surface's solid, or all.
      if (of.parts.tetrahedra !== this.mesh) {
        this.forget();
        return this.begin(device, latest);
      }
      const missing = PARTS.filter((part) => this.has[part] !== of!.parts[part]);
      if (missing.length === 0) {
        cut.replace({});
        this.of = of;
        return true;
      }
      const [part] = missing;
      const contents = of.parts[part];
      const isThere = await this.fill(cut, part, of, cut.parts[part]);
      if (meshes !== this.meshes) return false;
      this.has[part] = isThere ? contents : undefined;
      // The settings have changed: if the drawing that they ask for is not here yet, it goes on.
      if (!isThere && latest()?.parts[part] === contents) return false;
      of = latest();
    }
    return false;
  }

  /**
   * Takes over what has changed on the way to another drawing of the same mesh. Resolves to whether
   * that is complete.
   */
  async follow(of: CutOf): Promise<boolean> {
    const { ready: cut, meshes } = this;
    if (!cut || this.has.tetrahedra !== of.parts.tetrahedra) return false;
    const spares: Partial<Record<CutPart, GPUBuffer>> = {};
    let isThere = true;
    for (const part of PARTS.filter((part) => this.has[part] !== of.parts[part])) {
      const spare = (spares[part] = cut.spare(part));
      isThere &&= await this.fill(cut, part, of, spare);
      if (!isThere) break;
    }
    if (!isThere || meshes !== this.meshes) {
      for (const spare of Object.values(spares)) spare.destroy();
      return false;
    }
    if (Object.keys(spares).length > 0) cut.replace(spares);
    this.has = of.parts;
    this.of = of;
    return true;
  }

  /** How high a plane lies in the mesh on the GPU; null if that is not measured along its normal. */
  levelOf(plane: Plane): number | null {
    const heights = this.of?.heights;
    return heights?.normal.join() === plane.normal.join() ? levelOf(plane, heights!) : null;
  }

  /** Resolves to false where the mesh, or what the part has, is no longer asked for. */
  private async fill(cut: Cut, part: CutPart, of: CutOf, into: GPUBuffer): Promise<boolean> {
    const { meshes } = this;
    const count = of[CUT_PARTS[part].of];
    for (let from = 0; from < count; from += SLICE) {
      const to = Math.min(count, from + SLICE);
      const items = await this.model.cutPart(part, of.parts[part], from, to);
      if (!items || meshes !== this.meshes) return false;
      cut.write(part, into, from, items);
    }
    return true;
  }
}
