// The caller's device, for wgpu in the calling thread and in a worker.

/** What is used of a `GPUBuffer`. */
export interface Buffer {
  size: number;
  mapAsync(mode: number, at?: number, size?: number): Promise<void>;
  getMappedRange(at?: number, size?: number): ArrayBuffer;
  unmap(): void;
  destroy(): void;
}

/** What wgpu is told of a device. */
export interface DeviceInfo {
  features: Iterable<string>;
  limits: object;
  adapterInfo?: object | undefined;
}

/** What is used of a `GPUQueue`. */
export interface Queue {
  submit(commands: object[]): void;
  writeBuffer(buffer: object, at: number, data: Uint8Array, start: number, size: number): void;
}

/** What is used of a `GPUComputePassEncoder`. */
export interface Pass {
  setPipeline(pipeline: object): void;
}

/** What is used of a `GPUCommandEncoder`. */
export interface Encoder {
  beginComputePass(descriptor?: object): Pass;
  copyBufferToBuffer(from: object, at: number, to: object, start: number, size: number): void;
  finish(): object;
}

/** What is used of a `GPUDevice`. */
export interface Device extends DeviceInfo {
  lost: Promise<{ reason: string; message: string }>;
  queue: Queue;
  createBuffer(descriptor: object): Buffer;
  createComputePipeline(descriptor: object): object;
  createComputePipelineAsync(descriptor: object): Promise<object>;
  createCommandEncoder(descriptor?: object): Encoder;
  pushErrorScope(filter: string): void;
  popErrorScope(): Promise<{ message: string } | null>;
}

/** Returns a GPU object for wgpu, which asks for a device and gets this one. */
export function gpuOf(device: DeviceInfo): object {
  const { features, limits, adapterInfo } = device;
  const none = { vendor: '', architecture: '', device: '', description: '' };
  const adapter = {
    features,
    limits,
    info: adapterInfo ?? none,
    requestDevice: async () => device,
  };
  return { isGiven: true, requestAdapter: async () => adapter };
}
