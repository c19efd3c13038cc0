import type { LiveFrame } from './live';
import type { Model } from './model';

/** What the page shows and the pointer picks from: the mesh, or a frame of the live mode. */
export class Shown {
  private shown: Model | null = null;
  /** Counts the meshes that were shown. */
  private meshes = 0;

  get model(): Model | null {
    return this.shown;
  }

  /** Shows a mesh, which ends the live mode. */
  mesh(model: Model): void {
    this.meshes++;
    this.shown = model;
  }

  /**
   * Shows a frame of the live mode once it is made, unless a mesh was shown meanwhile: the live
   * mode ends while the worker still triangulates its last frame.
   */
  async frame(making: Promise<{ model: Model; frame: LiveFrame }>): Promise<LiveFrame> {
    const { meshes } = this;
    const { model, frame } = await making;
    if (meshes === this.meshes) this.shown = model;
    return frame;
  }
}
