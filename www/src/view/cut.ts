import { CUT_PARTS, type CutPart, levelInOrder, OUTSIDE } from '../geometry/cut';
import code from './cut.wgsl?raw';

/** That of the kernels. */
const WIDTH = 256;

/** `GPUBufferUsage` and `GPUShaderStage`, which TypeScript's own library lacks. */
const USAGE = { COPY_SRC: 4, COPY_DST: 8, UNIFORM: 64, STORAGE: 128, INDIRECT: 256 } as const;
const COMPUTE = 4;

/** The names of the parts, and of what only the GPU writes. */
const BINDINGS = ['neighbors', 'heights', 'filtered', 'reach', 'facets', 'draw'] as const;

/** How much there is to cut, and how many facets are drawn at most. */
interface Size {
  tetrahedra: number;
  points: number;
  most: number;
}

/**
 * A mesh on the GPU that draws, which finds out there what a cutting plane leaves to be seen: to
 * move the plane takes one dispatch, and nothing is read back.
 */
export class Cut {
  /** The arguments of the draw: three vertices a facet. */
  readonly draw: GPUBuffer;
  /** 4 · tetrahedron + the number of the vertex opposite, and {@link OUTSIDE}. */
  readonly facets: GPUBuffer;
  private readonly reach: GPUBuffer;
  private readonly uniforms: GPUBuffer;
  private readonly bindings: GPUBindGroup;
  private readonly own: GPUBuffer[];
  /** What is listed; null if that is out of date. */
  private listed: { level: number; skin: boolean } | null = null;

  private constructor(
    private readonly device: GPUDevice,
    private readonly pipelines: Pipelines,
    private readonly size: Size,
    readonly parts: Record<CutPart, GPUBuffer>,
  ) {
    const { STORAGE, COPY_DST, COPY_SRC, INDIRECT, UNIFORM } = USAGE;
    const buffer = (size: number, usage: number) => device.createBuffer({ size, usage });
    this.draw = buffer(16, STORAGE | INDIRECT | COPY_DST | COPY_SRC);
    this.facets = buffer(4 * Math.max(1, size.most), STORAGE | COPY_SRC);
    this.reach = buffer(parts.heights.size, STORAGE);
    this.uniforms = buffer(16, UNIFORM | COPY_DST);
    this.own = [this.draw, this.facets, this.reach, this.uniforms, ...Object.values(parts)];
    const { draw, facets, reach } = this;
    const bound = { ...parts, draw, facets, reach };
    this.bindings = device.createBindGroup({
      layout: pipelines.layout,
      entries: [this.uniforms, ...BINDINGS.map((name) => bound[name])].map((buffer, binding) => ({
        binding,
        resource: { buffer },
      })),
    });
  }

  /** Resolves to null where the device has no room for the mesh, or does not take the kernels. */
  static async create(device: GPUDevice, size: Size): Promise<Cut | null> {
    const { maxBufferSize, maxStorageBufferBindingSize, maxStorageBuffersPerShaderStage } =
      device.limits;
    const largest = Math.min(maxBufferSize, maxStorageBufferBindingSize);
    const fits =
      Object.keys(CUT_PARTS).every((part) => bytesOf(part as CutPart, size) <= largest) &&
      4 * size.most <= largest &&
      maxStorageBuffersPerShaderStage >= BINDINGS.length;
    if (!fits) return null;
    const pipelines = await pipelinesOf(device).catch(() => null);
    if (!pipelines) return null;
    device.pushErrorScope('out-of-memory');
    device.pushErrorScope('validation');
    const parts = {} as Record<CutPart, GPUBuffer>;
    for (const part of Object.keys(CUT_PARTS) as CutPart[])
      parts[part] = bufferFor(device, part, size);
    const cut = new Cut(device, pipelines, size, parts);
    const errors = await Promise.all([device.popErrorScope(), device.popErrorScope()]);
    if (errors.every((error) => error === null)) return cut;
    cut.destroy();
    return null;
  }

  /** Returns a buffer for other contents of a part, to be handed to {@link replace}. */
  spare(part: CutPart): GPUBuffer {
    return bufferFor(this.device, part, this.size);
  }

  /** Writes items of a part, of which the first one has this number: a multiple of four. */
  write(part: CutPart, into: GPUBuffer, first: number, items: ArrayBufferView<ArrayBuffer>): void {
    const { buffer, byteOffset, byteLength } = items;
    const at = first * CUT_PARTS[part].bytes;
    const whole = byteLength & ~3;
    this.device.queue.writeBuffer(into, at, buffer, byteOffset, whole);
    if (whole === byteLength) return;
    const rest = new Uint8Array(4);
    rest.set(new Uint8Array(buffer, byteOffset + whole, byteLength - whole));
    this.device.queue.writeBuffer(into, at + whole, rest);
  }

  /**
   * Takes over contents that were written to buffers of their own, all at once, and destroys these.
   * Measures what follows from them.
   */
  replace(spares: Partial<Record<CutPart, GPUBuffer>>): void {
    const encoder = this.device.createCommandEncoder();
    for (const [part, spare] of Object.entries(spares))
      encoder.copyBufferToBuffer(spare, 0, this.parts[part as CutPart], 0, spare.size);
    // How many there are is among the uniforms.
    this.setUniforms(-Infinity, false);
    this.dispatch(encoder, this.pipelines.measure);
    this.device.queue.submit([encoder.finish()]);
    for (const spare of Object.values(spares)) spare.destroy();
    this.listed = null;
  }

  /**
   * Lists the facets of what is kept below this height, unless it has; those of the outside marked,
   * or not.
   */
  at(level: number, skin: boolean): void {
    if (this.listed?.level === level && this.listed.skin === skin) return;
    this.listed = { level, skin };
    const { queue } = this.device;
    this.setUniforms(level, skin);
    queue.writeBuffer(this.draw, 0, Uint32Array.of(0, 1, 0, 0));
    const encoder = this.device.createCommandEncoder();
    this.dispatch(encoder, this.pipelines.list);
    queue.submit([encoder.finish()]);
  }

  destroy(): void {
    for (const buffer of this.own) buffer.destroy();
  }

  private setUniforms(level: number, skin: boolean): void {
    const { tetrahedra, most } = this.size;
    const values = Uint32Array.of(levelInOrder(level), tetrahedra, most, skin ? OUTSIDE : 0);
    this.device.queue.writeBuffer(this.uniforms, 0, values);
  }

  private dispatch(encoder: GPUCommandEncoder, pipeline: GPUComputePipeline): void {
    const groups = Math.ceil(this.size.tetrahedra / WIDTH);
    if (groups === 0) return;
    const rows = Math.ceil(groups / this.device.limits.maxComputeWorkgroupsPerDimension);
    const pass = encoder.beginComputePass();
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, this.bindings);
    pass.dispatchWorkgroups(Math.ceil(groups / rows), rows);
    pass.end();
  }
}

function bytesOf(part: CutPart, size: Size): number {
  const { of, bytes } = CUT_PARTS[part];
  return Math.max(4, Math.ceil((size[of] * bytes) / 4) * 4);
}

function bufferFor(device: GPUDevice, part: CutPart, size: Size): GPUBuffer {
  const { STORAGE, COPY_DST, COPY_SRC } = USAGE;
  return device.createBuffer({
    size: bytesOf(part, size),
    usage: STORAGE | COPY_DST | COPY_SRC,
    label: part,
  });
}

interface Pipelines {
  layout: GPUBindGroupLayout;
  measure: GPUComputePipeline;
  list: GPUComputePipeline;
}

/** The kernels of each device, compiled once. */
const compiled = new WeakMap<GPUDevice, Promise<Pipelines>>();

function pipelinesOf(device: GPUDevice): Promise<Pipelines> {
  const known = compiled.get(device) ?? compile(device);
  compiled.set(device, known);
  return known;
}

async function compile(device: GPUDevice): Promise<Pipelines> {
  const types = BINDINGS.map(
    (_, i): GPUBufferBindingType => (i < 3 ? 'read-only-storage' : 'storage'),
  );
  const layout = device.createBindGroupLayout({
    entries: (['uniform', ...types] as GPUBufferBindingType[]).map((type, binding) => ({
      binding,
      visibility: COMPUTE,
      buffer: { type },
    })),
  });
  const module = device.createShaderModule({ code });
  const pipeline = (entryPoint: string) =>
    device.createComputePipelineAsync({
      layout: device.createPipelineLayout({ bindGroupLayouts: [layout] }),
      compute: { module, entryPoint },
    });
  const [measure, list] = await Promise.all([pipeline('measure'), pipeline('list')]);
  return { layout, measure, list };
}
