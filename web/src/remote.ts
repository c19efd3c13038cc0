// The caller's device in a worker: wgpu calls what looks like a `GPUDevice`, and the calling thread,
// which has the device, makes the same calls in the same order (`calls.ts`).

import { type DeviceInfo, gpuOf } from './device.js';
import type { Call, FromWorker, ToWorker } from './protocol.js';
import { STEP_BYTES } from './slices.js';

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
  const waiting = new Map<number, ((value: any) => void)[]>();
  /** Copies of the buffers that are mapped. */
  const mapped = new Map<number, ArrayBuffer>();
  /** The objects that the calling thread keeps for this one. */
  const kept = new Set<number>();
  /** The pass of the next dispatch, its pipeline and its bindings. */
  let dispatch: number[] = [];
  /** How many objects had been created when each of the open error scopes was opened, and now. */
  const scopes: number[] = [];
  let created = 0;
  /** The error of a scope for which nobody waited. */
  let late: { message: string } | null = null;

  function send(): void {
    if (calls.length > 0) post({ type: 'calls', calls }, transfer);
    calls = [];
    transfer = [];
  }

  function add(call: Call): void {
    if (calls.push(call) === 1) queueMicrotask(send);
  }

  function answerTo(id: number): Promise<any> {
    return new Promise((...settle) => waiting.set(id, settle));
  }

  function takeLate() {
    const error = late;
    late = null;
    return error;
  }

  function call(object: number, method: string, args: any[]) {
    // wgpu maps what it looks at, and no more.
    if (method === 'getMappedRange') return mapped.get(object);
    if (method === 'unmap') return unmap(object);
    // A kernel has one group of bindings. What is set for a dispatch goes with it.
    if (method === 'setPipeline') dispatch = [object, args[0].remote];
    else if (method === 'setBindGroup') dispatch[2] = args[1].remote;
    else if (method === 'dispatchWorkgroups') add([...dispatch, args[0]] as Call);
    else if (method === 'writeBuffer') write(args);
    else return callByName(object, method, args);
  }

  /** Unmaps a buffer. The memory of a large copy goes back for what is mapped later. */
  function unmap(object: number): void {
    const bytes = mapped.get(object);
    mapped.delete(object);
    const large = bytes && bytes.byteLength >= STEP_BYTES ? [bytes] : [];
    transfer.push(...large);
    add([object, 'unmap', large, 0]);
  }

  /** Writes a view of WebAssembly's memory, in pieces: one is written while this thread goes on. */
  function write([buffer, offset, bytes]: any[]): void {
    for (let at = 0; at < bytes.length; ) {
      const piece = bytes.slice(at, at + STEP_BYTES);
      transfer.push(piece.buffer);
      add([1, 'writeBuffer', [buffer, offset + at, piece], 0]);
      at += piece.length;
      if (piece.length > STEP_BYTES / 4) send();
    }
  }

  function callByName(object: number, method: string, args: any[]) {
    const id = ++last;
    add([object, method, args, id]);
    if (method === 'pushErrorScope') scopes.push(created);
    // The device begins while this thread goes on.
    if (/^(submit|map|pop)/.test(method)) send();
    if (method === 'mapAsync') {
      // The errors of the scopes before have come by then.
      return answerTo(id).then((bytes) => {
        mapped.set(object, bytes);
        const error = takeLate();
        if (error) throw error;
      });
    }
    if (method === 'popErrorScope') {
      const answer = answerTo(id).then((error) => (late ??= error));
      // Where nothing was created, memory cannot have been lacking, and nobody waits for an answer: the
      // next scope has the error, or what is mapped.
      return scopes.pop() === created ? Promise.resolve(takeLate()) : answer.then(takeLate);
    }
    // The others return nothing.
    if (!/^(create|begin|finish)/.test(method)) return;
    // What records commands has no memory of the device.
    if (object === 0 && method !== 'createCommandEncoder') created++;
    kept.add(id);
    return objectOf(id);
  }

  const methods = new Proxy({} as any, {
    get(known, name: string) {
      // wgpu passes the label of an encoder on, which nothing here looks at. What has no `then` can be
      // what a promise is fulfilled with. All else that is asked for is a method.
      if (name === 'label') return '';
      if (name !== 'then')
        return (known[name] ??= function (this: Remote, ...args: any[]) {
          return call(this.remote, name, args);
        });
    },
  });

  function objectOf(id: number): Remote {
    return Object.assign(Object.create(methods), { remote: id });
  }

  const device = Object.assign(objectOf(0), info, { queue: objectOf(1), lost: answerTo(0) });
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
      for (const id of kept) if (!held.has(id) && kept.delete(id)) add([id, 'free', [], 0]);
    },
    answer({ id, value, error }: ToWorker & { type: 'answer' }): void {
      waiting.get(id)![error ? 1 : 0]!(error ?? value);
      waiting.delete(id);
    },
  };
}
