// The calls that wgpu makes in a worker (`remote.ts`), made on the caller's device in the thread that
// has it: in slices, between which that thread handles other events.

import type { Buffer, Device } from './device.js';
import type { Call, ToWorker } from './protocol.js';
import { copyInSlices, Slice } from './slices.js';
import { Staging } from './staging.js';
import { notCompiled } from './wgpu-calls.js';

/** Somebody's error scope, which is closed and opened again around every pause. */
interface Scope {
  filter: string;
  /** What it has caught. */
  errors: Promise<{ message: string } | null>[];
}

/** The calls of one worker. */
export interface Served {
  /** Makes these calls after those that came before. */
  take(calls: Call[]): Promise<void>;
  /** Returns the buffers that a result names. They outlast the worker. */
  handOver(buffers: object[]): object[];
  /** Makes no more calls, and frees what nobody else has. */
  end(): void;
}

/** Returns the numbers and texts that an object has, by getters of its class. */
function attributesOf(object: any): object {
  const attributes: Record<string, unknown> = {};
  for (const name in object) if (typeof object[name] !== 'object') attributes[name] = object[name];
  return attributes;
}

/**
 * Lets a worker use a device. A call that throws is a bug, and reported by `fail`: what goes wrong on
 * a device comes as the error of a scope, or of a promise.
 */
export function serveDevice(
  device: Device,
  post: (message: ToWorker, transfer: ArrayBuffer[]) => void,
  fail: (error: Error) => void,
): Served {
  const { features, limits, adapterInfo, lost } = device;
  const staging = new Staging(device);
  const objects = new Map<number, any>([
    [0, device],
    [1, staging.queue],
  ]);
  const handedOver = new Set<number>();
  const waiting: Call[] = [];
  const scopes: Scope[] = [];
  /** Memory of copies that the worker has given back: fresh memory takes three times as long to fill. */
  const spare: ArrayBuffer[] = [];
  /** Fulfilled when no copy is under way. Copies are made one after another, or their slices would add up. */
  let copied: Promise<unknown> = Promise.resolve();
  /** Fulfilled when the scopes that were closed have been answered. */
  let closed: Promise<unknown> = Promise.resolve();
  let isBusy = false;
  let isEnded = false;

  const answer = (id: number, value: unknown, error?: string) => {
    if (isEnded) return;
    post({ type: 'answer', id, value, error }, value instanceof ArrayBuffer ? [value] : []);
  };
  const info = {
    features: new Set(features),
    limits: attributesOf(limits),
    adapterInfo: adapterInfo && attributesOf(adapterInfo),
  };
  post({ type: 'device', info }, []);
  void lost.then(({ reason, message }) => answer(0, { reason, message }));

  /** Replaces what stands for objects by these. */
  function own(value: any): any {
    if (typeof value !== 'object' || value === null || ArrayBuffer.isView(value)) return value;
    if (Array.isArray(value)) return value.map(own);
    if ('remote' in value) return objects.get(value.remote);
    return Object.fromEntries(Object.entries(value).map(([key, item]) => [key, own(item)]));
  }

  // The device has one stack of scopes for everybody. Between two slices there is none of ours on it,
  // or others would close it in place of theirs.
  let isOpen = false;
  const open = () => {
    for (const { filter } of scopes) device.pushErrorScope(filter);
    isOpen = true;
  };
  const close = () => {
    if (isOpen) for (const { errors } of [...scopes].reverse()) errors.push(popped());
    isOpen = false;
  };
  const popped = () => device.popErrorScope().catch(() => null);

  async function closeScope(id: number): Promise<void> {
    const { errors } = scopes.pop()!;
    errors.push(popped());
    const error = (await Promise.all(errors)).find(Boolean);
    // wgpu tells errors apart by the names of their classes.
    const { name } = error?.constructor ?? {};
    answer(id, error ? { message: error.message, constructor: { name } } : null);
  }

  async function map(id: number, buffer: Buffer, mode: number, at: number, size: number) {
    const before = closed;
    try {
      await buffer.mapAsync(mode, at, size);
      const copy = copied.then(async () => {
        const found = spare.findIndex(({ byteLength }) => byteLength === size);
        const [memory] = found < 0 ? [] : spare.splice(found, 1);
        const bytes = new Uint8Array(memory ?? new ArrayBuffer(size));
        await copyInSlices(buffer.getMappedRange(at, size), bytes);
        return bytes.buffer;
      });
      copied = copy.catch(() => {});
      const bytes = await copy;
      await before;
      answer(id, bytes);
    } catch (error) {
      answer(id, undefined, String(error));
    }
  }

  async function makeCalls(): Promise<void> {
    const slice = new Slice();
    /** Handles other events, until there is `what`. The caller opens the scopes again. */
    const pause = async (what?: Promise<unknown>) => {
      close();
      await what;
      await slice.next();
    };
    open();
    for (let i = 0; i < waiting.length && !isEnded; i++) {
      if (slice.isOver) {
        await pause();
        if (isEnded) return;
        open();
      }
      const [object, method, sent, id] = waiting[i]!;
      if (typeof method === 'number') {
        const pass = objects.get(object);
        if (objects.get(method) instanceof Promise) {
          await pause(objects.get(method));
          if (isEnded) return;
          open();
        }
        const pipeline = objects.get(method);
        // If it could not be compiled, the scope in which it was created has the error.
        if (pipeline === null) continue;
        pass.setPipeline(pipeline);
        pass.setBindGroup(0, objects.get(sent));
        pass.dispatchWorkgroups(id);
        continue;
      }
      const args = own(sent);
      if (method === 'pushErrorScope') {
        scopes.push({ filter: args[0], errors: [] });
        device.pushErrorScope(args[0]);
      } else if (method === 'popErrorScope') {
        closed = Promise.all([closed, closeScope(id)]);
      } else if (method === 'createComputePipeline') {
        // Some devices compile in the call, which takes up to seconds, and others when they first carry
        // commands out. This way, threads of the device compile side by side.
        const compiled = (pipeline: object | null) => {
          if (objects.has(id)) objects.set(id, pipeline);
        };
        const failed = device.createComputePipelineAsync(args[0]).then(
          (pipeline) => {
            compiled(pipeline);
            return null;
          },
          (error) => {
            compiled(null);
            return notCompiled(error);
          },
        );
        objects.set(id, failed);
        scopes.at(-1)?.errors.push(failed);
      } else if (method === 'writeBuffer') {
        staging.writeBuffer(args[0], args[1], args[2]);
      } else if (method === 'submit') {
        staging.submit(args[0]);
      } else if (method === 'mapAsync') {
        void map(id, objects.get(object), args[0], args[1], args[2]);
      } else if (method === 'unmap') {
        spare.push(...(sent as ArrayBuffer[]));
        objects.get(object).unmap();
      } else if (method === 'free') {
        // The worker has ended its task.
        spare.length = 0;
        objects.delete(object);
        handedOver.delete(object);
      } else {
        const made = objects.get(object)[method](...args);
        if (made) objects.set(id, made);
      }
    }
  }

  return {
    async take(calls) {
      waiting.push(...calls);
      if (isBusy) return;
      isBusy = true;
      try {
        await makeCalls();
      } catch (error) {
        fail(error as Error);
      } finally {
        close();
        waiting.length = 0;
        isBusy = false;
      }
    },
    handOver: (buffers) =>
      (buffers as { remote: number }[]).map(({ remote }) => {
        handedOver.add(remote);
        return objects.get(remote);
      }),
    end() {
      isEnded = true;
      waiting.length = 0;
      for (const [id, object] of objects)
        if (object !== device && !handedOver.has(id)) object.destroy?.();
      objects.clear();
      // The device, which may outlast this, refers to it.
      spare.length = 0;
      staging.end();
    },
  };
}
