// The caller's device in a worker: wgpu calls what looks like a `GPUDevice`, and the calling thread,
// which has the device, makes the same calls in the same order (`calls.ts`).

import { type DeviceInfo, gpuOf } from './device.js';
import type { Call, FromWorker, ToWorker } from './protocol.js';

/** The methods that are called: those that return an object, those that return a promise, and others. */
const MAKES = /^(create|begin|finish)/;
const PROMISES = /^(mapAsync|pop)/;
const OTHERS = /^(set|dispatch|end|copy|clear|write|submit|push|unmap|destroy|getMapped)/;

/** The most calls in a message: reading it does not block the calling thread for long. */
const MOST_CALLS = 500;

/** An object of the calling thread. Its methods are no properties of its own, and not sent with it. */
interface Remote {
  remote: number;
}

/** Returns a GPU object for wgpu, and what takes the answers to its calls. */
export function remoteGpu(
  info: DeviceInfo,
  post: (message: FromWorker, transfer: ArrayBuffer[]) => void,
) {
  let calls: Call[] = [];
  let transfer: ArrayBuffer[] = [];
  // The device and its queue are 0 and 1.
  let last = 1;
  const waiting = new Map<number, (value: any, error?: string) => void>();
  /** Copies of the buffers that are mapped. */
  const mapped = new Map<number, ArrayBuffer>();
  /** The objects that the calling thread keeps for this one. */
  const kept = new Set<number>();

  function send(): void {
    if (calls.length > 0) post({ type: 'calls', calls }, transfer);
    calls = [];
    transfer = [];
  }

  function answerTo(id: number, object: number): Promise<unknown> {
    return new Promise((resolve, reject) => {
      waiting.set(id, (value, error) => {
        waiting.delete(id);
        if (value instanceof ArrayBuffer) mapped.set(object, value);
        if (error === undefined) resolve(value);
        else reject(new Error(error));
      });
    });
  }

  function call(object: number, method: string, args: any[]) {
    // wgpu maps what it looks at, and no more.
    if (method === 'getMappedRange') return mapped.get(object);
    if (method === 'unmap') mapped.delete(object);
    if (method === 'writeBuffer') {
      // It is a view of WebAssembly's memory.
      args[2] = args[2].slice();
      transfer.push(args[2].buffer);
    }
    const id = ++last;
    calls.push([object, method, args, id]);
    const isPromise = PROMISES.test(method);
    // The device begins while this thread goes on.
    if (isPromise || method === 'submit' || calls.length >= MOST_CALLS) send();
    else if (calls.length === 1) queueMicrotask(send);
    if (isPromise) return answerTo(id, object);
    if (!MAKES.test(method)) return;
    kept.add(id);
    return objectOf(id);
  }

  const methods = new Proxy({} as any, {
    get: (_, name, { remote }: Remote) =>
      [MAKES, PROMISES, OTHERS].some((methods) => methods.test(String(name)))
        ? (...args: unknown[]) => call(remote, String(name), args)
        : // wgpu passes the label of an encoder on, which nothing here looks at.
          name === 'label'
          ? ''
          : undefined,
  });

  function objectOf(id: number): Remote {
    return Object.assign(Object.create(methods), { remote: id });
  }

  const device = Object.assign(objectOf(0), { ...info, queue: objectOf(1), lost: answerTo(0, 0) });
  return {
    gpu: gpuOf(device),
    /**
     * Has the calling thread forget what is in none of these tables, in which instances of WebAssembly
     * have what they refer to. It cannot wait for the garbage of this thread to be collected: that
     * takes little memory here, and the buffers much of the device.
     */
    sweep(tables: WebAssembly.Table[]): void {
      const held = new Set<number>();
      for (const table of tables)
        for (let i = 0; i < table.length; i++) held.add(table.get(i)?.remote);
      for (const id of kept) {
        if (held.has(id)) continue;
        kept.delete(id);
        call(id, 'free', []);
      }
    },
    answer: ({ id, value, error }: ToWorker & { type: 'answer' }) =>
      waiting.get(id)?.(value, error),
  };
}
