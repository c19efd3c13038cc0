// Calls of wgpu for which WebGPU has a faster way: pipelines are compiled while the thread goes on, and
// side by side, and large arrays are written through memory that stays.

import { builtin } from './builtin.js';
import type { Device, Queue } from './device.js';
import { Staging } from './staging.js';

/** A pipeline that is compiled aside, or when it is needed before. */
interface Pipeline {
  /** Has a thread of the device compile it, unless it was needed. Returns it, or a promise of it. */
  compile(): object;
  /** It, compiled by this thread if it is not yet. */
  now: object;
}

function pipelineOf(device: Device, descriptor: object): Pipeline {
  let compiled: object | undefined;
  let aside: Promise<object> | undefined;
  const compileAside = () =>
    device.createComputePipelineAsync(descriptor).then((pipeline) => (compiled ??= pipeline));
  return {
    compile: () => compiled ?? (aside ??= compileAside()),
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

/** Whether the calling thread makes the calls (`remote.ts`), in these ways. */
const isRemote = (object: object) => 'remote' in object;

/** Returns the calls of an instance of WebAssembly, each with the object of which it is a method. */
export function wgpuCalls() {
  /** The pipelines of the innermost scope. */
  let created: Pipeline[] = [];
  // In Node, the device is part of the process, and its threads, two in Dawn, compile all but the second of
  // every three pipelines: this thread takes that, while it would wait. Elsewhere it would hold up who draws.
  const share = 3;
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
      if (created.length % share !== 2) created.at(-1)?.compile();
      const pipeline = pipelineOf(device, descriptor);
      created.push(pipeline);
      return pipeline;
    },
    setPipeline(pass: { setPipeline(pipeline: object): void }, pipeline: object): void {
      pass.setPipeline(isRemote(pipeline) ? pipeline : (pipeline as Pipeline).now);
    },
    popErrorScope(device: Device): Promise<{ message: string } | null> {
      const isInProcess = builtin('node:worker_threads');
      const compiled = created.map((pipeline, i) =>
        isInProcess && i % share === 1 ? pipeline.now : pipeline.compile(),
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
