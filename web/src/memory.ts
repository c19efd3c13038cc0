// Memory for the arrays of results. Fresh memory comes from the system page by page when it is first
// written to, which takes three times as long as to copy what goes there. So large arrays get memory
// that the caller no longer needs, or that other threads have written to while the GPU was at work.

import { buffersOf } from './arrays.js';
import { builtin } from './builtin.js';

/** Takes the memory of typed arrays: they, and other views of it, become empty. */
export function memoryOf(arrays: object): ArrayBuffer[] {
  if (typeof structuredClone !== 'function') return [];
  const buffers = buffersOf(arrays).filter(({ byteLength }) => byteLength > 0);
  return buffers.map((buffer) => structuredClone(buffer, { transfer: [buffer] }));
}

/** Memory for one run, some of which is ready. */
export class Memory {
  /** The bytes of arrays for which memory was ready. */
  readyBytes = 0;
  readonly #ready: ArrayBuffer[];
  /** How much larger fresh memory is than needed, so that it can serve again. */
  readonly #room: number;

  constructor(ready: ArrayBuffer[] = []) {
    this.#ready = ready;
    this.#room = ready.length > 0 ? 1.05 : 1;
  }

  /** Whether the caller has given none. */
  get isEmpty(): boolean {
    return this.#ready.length === 0;
  }

  add(buffer: ArrayBuffer): void {
    this.#ready.push(buffer);
  }

  /** Returns memory for an array: what is ready if it is hardly larger, else fresh memory. */
  readonly take = (bytes: number): Uint8Array<ArrayBuffer> => {
    const at = this.#ready.findIndex((b) => b.byteLength >= bytes && b.byteLength <= 1.25 * bytes);
    const [found] = at < 0 ? [] : this.#ready.splice(at, 1);
    if (found) this.readyBytes += bytes;
    return new Uint8Array(found ?? new ArrayBuffer(Math.ceil(this.#room * bytes)), 0, bytes);
  };
}

/** Smaller arrays are read before another thread has answered. */
const LEAST_BYTES = 2 ** 20;

/** What another thread does: it writes to each page. */
const CODE = `port.onmessage = ({ data: [id, length] }) => {
  const bytes = new Uint8Array(length);
  for (let i = 0; i < length; i += 4096) bytes[i] = 0;
  port.postMessage([id, bytes.buffer], [bytes.buffer]);
};`;

interface Thread {
  post(message: [id: number, length: number]): void;
  end(): void;
}

/** Threads that get memory ready, one for each array. They are started when they are first needed. */
export class MemoryThreads {
  readonly #threads: Thread[] = [];
  #isBroken = false;
  #id = 0;
  #memory: Memory | undefined;

  /** Gets `count` times as many bytes ready for a run. What comes when it has ended is dropped. */
  serve(memory: Memory, count: number, bytes: number): void {
    this.#id++;
    this.#memory = memory;
    if (bytes < LEAST_BYTES || this.#isBroken) return;
    try {
      for (let i = 0; i < count; i++) {
        this.#threads[i] ??= start(this.#add, () => this.end());
        this.#threads[i]!.post([this.#id, bytes]);
      }
    } catch {
      this.end();
    }
  }

  readonly #add = ([id, buffer]: [id: number, buffer: ArrayBuffer]) => {
    if (id === this.#id) this.#memory?.add(buffer);
  };

  /** Says that the run has ended. */
  release(): void {
    this.#memory = undefined;
  }

  /** Ends the threads. Without them, memory is not ready, which `readyBytes` shows. */
  end(): void {
    this.#isBroken = true;
    for (const thread of this.#threads) thread.end();
  }
}

/** Memory for the large arrays of runs on the GPU, as much as the run before tells. */
export class ArrayMemory {
  readonly #threads = new MemoryThreads();
  /** Of the simplices in the run before. */
  #bytesPerCoordinate: number;

  constructor(bytesPerCoordinate: number) {
    this.#bytesPerCoordinate = bytesPerCoordinate;
  }

  /** Gets memory ready for `count` arrays of a run with so many coordinates, unless the caller has given some. */
  serve(memory: Memory, count: number, coordinates: number): void {
    if (!memory.isEmpty) return;
    this.#threads.serve(memory, count, Math.ceil(this.#bytesPerCoordinate * coordinates));
  }

  /** Says that the run has ended, and how many bytes its simplices take, if it made any. */
  release(coordinates: number, bytes?: number): void {
    this.#threads.release();
    // The next run may have a few more of them.
    if (bytes && coordinates > 0) this.#bytesPerCoordinate = (1.02 * bytes) / coordinates;
  }

  end(): void {
    this.#threads.end();
  }
}

function start(
  onReady: (message: [id: number, buffer: ArrayBuffer]) => void,
  onError: () => void,
): Thread {
  const threads = builtin('node:worker_threads');
  if (threads && typeof document === 'undefined') {
    const source = `import { parentPort as port } from 'node:worker_threads'; ${CODE}`;
    const thread = new threads.Worker(
      new URL(`data:text/javascript,${encodeURIComponent(source)}`),
    );
    thread.on('message', onReady);
    thread.on('error', onError);
    thread.unref();
    return { post: (message) => thread.postMessage(message), end: () => void thread.terminate() };
  }
  const url = URL.createObjectURL(new Blob([`const port = self; ${CODE}`]));
  const thread = new Worker(url);
  thread.onmessage = ({ data }) => onReady(data);
  thread.onerror = (event) => {
    event.preventDefault();
    onError();
  };
  return {
    post: (message) => thread.postMessage(message),
    end() {
      thread.terminate();
      URL.revokeObjectURL(url);
    },
  };
}
