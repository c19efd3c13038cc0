// Calls of wgpu for which WebGPU has a faster way: pipelines are compiled while the thread goes on, and
// side by side, and large arrays are written through memory that stays.

import { builtin } from './builtin.js';
import type { Device, Queue } from './device.js';
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
export const notCompiled = ({ message }: { message: string }) => ({
  message,
  constructor: { name: 'GPUValidationError' },
});

/**
 * Returns the calls of an instance of WebAssembly, each with the object of which it is a method. If it `mayWait`,
 * its thread compiles some of the pipelines.
 */
export function wgpuCalls(mayWait: boolean) {
  /** The pipelines of the innermost scope. */
  let created: Pipeline[] = [];
  // Whether this thread compiles a pipeline in Node, where the device is part of the process: Dawn has two
  // threads for that, and this one would only wait. In a browser, it would hold up the process that draws.
  const isForThisThread = (i: number) => mayWait && i % 3 === 1;
  let staging: Staging | undefined;
  const stagingOf = (queue: Queue): Queue => (queue === staging?.queue ? staging : queue);

  return {
    queue(device: Device): Queue {
      staging?.end();
      staging = new Staging(device);
      return staging.queue;
    },
    createComputePipeline(device: Device, descriptor: object): object {
      // What is needed at once is so before the next one is created.
      if (!isForThisThread(created.length - 1)) created.at(-1)?.compile();
      const pipeline = pipelineOf(device, descriptor);
      created.push(pipeline);
      return pipeline;
    },
    setPipeline(pass: { setPipeline(pipeline: object): void }, pipeline: object): void {
      pass.setPipeline((pipeline as Pipeline).now);
    },
    popErrorScope(device: Device): Promise<{ message: string } | null> {
      const compiled = created.map((pipeline, i) =>
        isForThisThread(i) && builtin('node:worker_threads') ? pipeline.now : pipeline.compile(),
      );
      created = [];
      const answer = device.popErrorScope();
      if (compiled.length === 0) return answer;
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
