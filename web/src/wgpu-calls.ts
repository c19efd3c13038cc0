// Calls of wgpu for which WebGPU has a faster way: pipelines are compiled while the thread goes on, and
// side by side, and large arrays are written through memory that stays.

import type { Device, Queue } from './device.js';
import { Staging } from './staging.js';

/** A pipeline that is compiled when it is needed, or when the error scope ends in which it was created. */
class Pipeline {
  #compiled: object | undefined;

  constructor(
    private readonly device: Device,
    private readonly descriptor: object,
  ) {}

  async compile(): Promise<void> {
    this.#compiled ??= await this.device.createComputePipelineAsync(this.descriptor);
  }

  get now(): object {
    this.#compiled ??= this.device.createComputePipeline(this.descriptor);
    return this.#compiled;
  }
}

/** What a scope answers if a pipeline cannot be compiled: wgpu tells errors apart by their classes' names. */
export const notCompiled = ({ message }: { message: string }) => ({
  message,
  constructor: { name: 'GPUValidationError' },
});

/** Whether the calling thread makes the calls (`remote.ts`), in these ways. */
const isRemote = (object: object) => 'remote' in object;

/** Returns the calls of an instance of WebAssembly, each with the object of which it is a method. */
export function wgpuCalls() {
  let created: Pipeline[] = [];
  let staging: Staging | undefined;

  return {
    queue(device: Device): Queue {
      if (isRemote(device)) return device.queue;
      staging?.end();
      staging = new Staging(device);
      return staging.queue;
    },
    createComputePipeline(device: Device, descriptor: object): object {
      if (isRemote(device)) return device.createComputePipeline(descriptor);
      const pipeline = new Pipeline(device, descriptor);
      created.push(pipeline);
      return pipeline;
    },
    setPipeline(pass: { setPipeline(pipeline: object): void }, pipeline: object): void {
      pass.setPipeline(pipeline instanceof Pipeline ? pipeline.now : pipeline);
    },
    popErrorScope(device: Device): Promise<{ message: string } | null> {
      const answer = device.popErrorScope();
      const compiled = created.map((pipeline) => pipeline.compile());
      created = [];
      if (compiled.length === 0) return answer;
      return Promise.all([answer, ...compiled]).then(([error]) => error, notCompiled);
    },
    writeBuffer(queue: Queue, to: object, at: number, bytes: Uint8Array): void {
      if (queue === staging?.queue) staging.write(to, at, bytes);
      else queue.writeBuffer(to, at, bytes, 0, bytes.length);
    },
    submit(queue: Queue, commands: object[]): void {
      (queue === staging?.queue ? staging : queue).submit(commands);
    },
    /** Frees what the calls keep. */
    end(): void {
      staging?.end();
    },
  };
}
