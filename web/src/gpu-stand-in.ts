// The GPU object that wgpu gets. It is like a given one, but for two things that its devices do in ways
// that are faster than those of wgpu: pipelines are compiled while the thread goes on, and side by side,
// and large arrays are written through memory that stays.

import type { Adapter, Gpu } from './adapter.js';
import { builtin } from './builtin.js';
import type { Device, Encoder, Queue } from './device.js';
import { Staging } from './staging.js';

/** A pipeline that is compiled aside, or when it is needed before. */
interface Pipeline {
  /** Has a thread of the device compile it, unless it was needed. Returns the pipeline, or a promise of it. */
  compile(): object;
  /** The pipeline, compiled by this thread if it is not yet compiled. */
  readonly now: object;
}

function pipelineOf(device: Device, descriptor: object): Pipeline {
  let compiled: object | undefined;
  let aside: Promise<object> | undefined;
  return {
    compile: () =>
      compiled ??
      (aside ??= device
        .createComputePipelineAsync(descriptor)
        .then((pipeline) => (compiled ??= pipeline))),
    get now() {
      return (compiled ??= device.createComputePipeline(descriptor));
    },
  };
}

/** What a scope answers if a pipeline cannot be compiled: wgpu tells errors apart by their classes' names. */
const notCompiled = ({ message }: { message: string }) => ({
  message,
  constructor: { name: 'GPUValidationError' },
});

/** Returns an object that has these members, and all others of `object`, which are called on that. */
function like<T extends object>(object: T, members: Partial<T>): T {
  return new Proxy({} as T, {
    get(_, key) {
      if (Object.hasOwn(members, key)) return members[key as keyof T];
      const value = object[key as keyof T];
      return typeof value === 'function' ? value.bind(object) : value;
    },
    set: (_, key, value) => Reflect.set(object, key, value, object),
  });
}

/** Makes the passes of an encoder take a {@link Pipeline}. */
function takePipelines(encoder: Encoder): Encoder {
  return like(encoder, {
    beginComputePass(descriptor) {
      const pass = encoder.beginComputePass(descriptor);
      return like(pass, {
        setPipeline: (pipeline) => pass.setPipeline((pipeline as Pipeline).now),
      });
    },
  });
}

/**
 * Returns what wgpu gets for a device. If it `mayWait`, its thread compiles some of the pipelines. Large
 * arrays go through `staging`.
 */
function deviceLike(device: Device, staging: Staging, mayWait: boolean): Device {
  /** The pipelines of the innermost scope. */
  let created: Pipeline[] = [];
  // Whether this thread compiles a pipeline in Node, where the device is part of the process: Dawn has two
  // threads for that, and this one would only wait. In a browser, it would hold up the process that draws.
  const isForThisThread = (i: number) => mayWait && i % 3 === 1;

  return like(device, {
    queue: like(device.queue, {
      writeBuffer: (to, at, bytes) => staging.writeBuffer(to, at, bytes),
      submit: (commands) => staging.submit(commands),
    }),
    createCommandEncoder: (descriptor) => takePipelines(device.createCommandEncoder(descriptor)),
    createComputePipeline(descriptor) {
      // What is needed at once is so before the next one is created.
      if (!isForThisThread(created.length - 1)) created.at(-1)?.compile();
      const pipeline = pipelineOf(device, descriptor);
      created.push(pipeline);
      return pipeline;
    },
    popErrorScope() {
      const compiled = created.map((pipeline, i) =>
        isForThisThread(i) && builtin('node:worker_threads') ? pipeline.now : pipeline.compile(),
      );
      created = [];
      const answer = device.popErrorScope();
      if (compiled.length === 0) return answer;
      return Promise.all([answer, ...compiled]).then(([error]) => error, notCompiled);
    },
  });
}

/** Stands for a GPU object. If it `mayWait`, its thread compiles some of the pipelines. */
export class GpuStandIn implements Gpu {
  readonly #gpu: Gpu;
  readonly #mayWait: boolean;
  #staging: Staging | undefined;
  /** The queue of the last device, for others who write to it between wgpu's calls. */
  queue: Queue | undefined;

  constructor(gpu: Gpu, mayWait: boolean) {
    this.#gpu = gpu;
    this.#mayWait = mayWait;
  }

  async requestAdapter(options?: object): Promise<Adapter | null> {
    const adapter = await this.#gpu.requestAdapter(options);
    const requestDevice = async (descriptor?: object) =>
      this.#deviceLike((await adapter!.requestDevice(descriptor)) as Device);
    return adapter && like(adapter, { requestDevice });
  }

  #deviceLike(device: Device): Device {
    this.end();
    this.#staging = new Staging(device);
    const made = deviceLike(device, this.#staging, this.#mayWait);
    this.queue = made.queue;
    return made;
  }

  /** Frees what it keeps. */
  end(): void {
    this.#staging?.end();
  }
}
