// Calls of wgpu for which WebGPU has a faster way: pipelines are compiled while the thread goes on, and
// side by side, and large arrays are written through memory that stays.

import type { Device, Queue } from './device.js';
import { Staging } from './staging.js';

/** A pipeline that is compiled aside, or when it is needed before. */
class Pipeline {
  #compiled: object | undefined;
  #aside: Promise<void> | undefined;

  #device: Device;
  #descriptor: object;

  constructor(device: Device, descriptor: object) {
    this.#device = device;
    this.#descriptor = descriptor;
  }

  /** Has a thread of the device compile it, unless it was needed. Fulfilled when that is done. */
  compile(): Promise<void> | undefined {
    if (this.#compiled) return;
    this.#aside ??= this.#device.createComputePipelineAsync(this.#descriptor).then((pipeline) => {
      this.#compiled ??= pipeline;
    });
    return this.#aside;
  }

  get now(): object {
    this.#compiled ??= this.#device.createComputePipeline(this.#descriptor);
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
  /** The pipelines of the innermost scope. */
  let created: Pipeline[] = [];
  let staging: Staging | undefined;
  const stagingOf = (queue: Queue): Queue => (queue === staging?.queue ? staging : queue);

  return {
    queue(device: Device): Queue {
      if (isRemote(device)) return device.queue;
      staging?.end();
      staging = new Staging(device);
      return staging.queue;
    },
    createComputePipeline(device: Device, descriptor: object): object {
      if (isRemote(device)) return device.createComputePipeline(descriptor);
      // What is needed at once is so before the next one is created.
      created.at(-1)?.compile();
      const pipeline = new Pipeline(device, descriptor);
      created.push(pipeline);
      return pipeline;
    },
    setPipeline(pass: { setPipeline(pipeline: object): void }, pipeline: object): void {
      pass.setPipeline(pipeline instanceof Pipeline ? pipeline.now : pipeline);
    },
    popErrorScope(device: Device): Promise<{ message: string } | null> {
      const answer = device.popErrorScope();
      if (created.length === 0) return answer;
      const compiled = created.map((pipeline) => pipeline.compile());
      created = [];
      return Promise.all([answer, ...compiled]).then(([error]) => error, notCompiled);
    },
    writeBuffer: (queue: Queue, ...call: Parameters<Queue['writeBuffer']>) =>
      stagingOf(queue).writeBuffer(...call),
    submit: (queue: Queue, commands: object[]) => stagingOf(queue).submit(commands),
    /** Frees what the calls keep. */
    end(): void {
      staging?.end();
    },
  };
}
