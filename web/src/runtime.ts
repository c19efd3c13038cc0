// What environments differ in: where files are, how they are read, and how a worker is started. One
// build serves all of them, by what is there.

import { builtin } from './builtin.js';
import type { OpenCore } from './core.js';
import { GdelError } from './errors.js';
import type { FromWorker, ModuleName, ToWorker } from './protocol.js';

/** A file of the package. Its copy is a JavaScript module, which any bundler finds. */
interface Asset {
  file?(): URL;
  /** Returns the content as text: base64 of the compressed file, or the worker's source. */
  copy?(): Promise<{ default: string }>;
}

export interface WasmAsset extends Asset {
  name: ModuleName;
}

export interface WorkerAsset extends Asset {
  /** Starts a worker of the web's interface from the file. */
  start?(): Worker;
}

/** A wasm module with the code that runs its tasks. */
export interface ModuleAsset {
  wasm: WasmAsset;
  worker: WorkerAsset;
  /** The tasks, for the calling thread. */
  code(): Promise<{ openCore: OpenCore }>;
}

/** Something that was loaded, and why it is the copy; null if it is the file. */
export interface Loaded<T> {
  value: T;
  whyInlined: string | null;
}

/**
 * How long a worker may take to load its code, in milliseconds. No machine needs nearly as long: it
 * would otherwise be waited for without end.
 */
const HANG_MILLISECONDS = 60_000;

export const messageOf = (error: unknown): string =>
  String((error as Partial<Error> | null | undefined)?.message ?? error);

/**
 * Tries the file of an asset and then its copy. Why the file failed is told: by the result, or by
 * the error if the copy failed, too.
 */
async function fileOrCopy<T>(
  fromFile: (() => Promise<T>) | undefined,
  copy: Asset['copy'],
  fromCopy: (content: string) => Promise<T>,
): Promise<Loaded<T>> {
  let whyInlined = 'gdel-wasm/inline was imported';
  if (fromFile) {
    try {
      return { value: await fromFile(), whyInlined: null };
    } catch (error) {
      if (!copy || error instanceof GdelError) throw error;
      whyInlined = messageOf(error);
    }
  }
  try {
    return { value: await fromCopy((await copy!()).default), whyInlined };
  } catch (error) {
    if (!fromFile || error instanceof GdelError) throw error;
    const reasons = new Set([whyInlined, messageOf(error)]);
    throw new Error([...reasons].join('; '), { cause: error });
  }
}

/** Compiles a wasm module. */
export async function compile({ file, copy }: WasmAsset): Promise<Loaded<WebAssembly.Module>> {
  try {
    return await fileOrCopy(file && (() => compileFile(file())), copy, async (base64) =>
      WebAssembly.compile(await decompressed(base64)),
    );
  } catch (cause) {
    throw loadError('WebAssembly cannot be loaded', cause);
  }
}

/** Imports code of the package. */
export async function loadCode<T>(code: () => Promise<T>): Promise<T> {
  try {
    return await code();
  } catch (cause) {
    throw loadError('a part of gdel-wasm cannot be loaded', cause);
  }
}

/** Returns an error that says what to do. */
function loadError(what: string, cause: unknown): GdelError {
  const why = messageOf(cause);
  const isForbidden = /content security policy|unsafe-eval|disallowed by embedder/i.test(why);
  const remedy = isForbidden
    ? "Add 'wasm-unsafe-eval' to script-src in the page's Content-Security-Policy"
    : 'Deploy the .wasm files and the chunks of gdel-wasm beside the code that imports it';
  return new GdelError('LOAD_FAILED', `${what}: ${why}. ${remedy}`, { cause });
}

async function compileFile(url: URL): Promise<WebAssembly.Module> {
  if (url.protocol === 'file:') {
    const [fs, urls] = [builtin('node:fs/promises'), builtin('node:url')];
    // The URL's class may be a bundler's or jsdom's own, so its text is converted.
    if (fs && urls) return WebAssembly.compile(await fs.readFile(urls.fileURLToPath(url.href)));
  }
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url.href}: ${response.status} ${response.statusText}`);
  // Streaming compilation needs the right type, which not every server sends.
  const isStream = response.headers.get('content-type')?.startsWith('application/wasm');
  try {
    return await (isStream
      ? WebAssembly.compileStreaming(response)
      : WebAssembly.compile(await response.arrayBuffer()));
  } catch (cause) {
    throw new Error(`${url.href}: ${messageOf(cause)}`, { cause });
  }
}

async function decompressed(base64: string): Promise<BufferSource> {
  const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  const zlib = builtin('node:zlib');
  if (zlib) return zlib.gunzipSync(bytes);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

/** A worker thread. */
export interface WorkerThread {
  post(message: ToWorker, transfer: ArrayBuffer[]): void;
  onMessage(handler: (message: FromWorker) => void): void;
  /** The thread did not start, or died. */
  onError(handler: (error: Error) => void): void;
  terminate(): void;
  /** Says whether the process must stay alive for it. Browsers do not ask. */
  keepAlive(busy: boolean): void;
}

/** Starts a worker, and returns it when it has loaded its code. */
export async function startWorker({
  start,
  file,
  copy,
}: WorkerAsset): Promise<Loaded<WorkerThread>> {
  const threads = builtin('node:worker_threads');
  const isPage = typeof document !== 'undefined' && typeof Worker === 'function';
  // Deno and Bun have both: the process does not wait for idle threads, but for idle workers.
  if (threads && !isPage) {
    return fileOrCopy(file && (() => whenReady(nodeWorker(file().href))), copy, (source) =>
      whenReady(nodeWorker(`data:text/javascript,${encodeURIComponent(source)}`)),
    );
  }
  if (typeof Worker !== 'function') throw new Error('there are no workers here');
  return fileOrCopy(start && (() => whenReady(webWorker(start()))), copy, (source) =>
    whenReady(blobWorker(source)),
  );
}

/** Waits until a worker has loaded its code. To be called in the turn that started it. */
function whenReady(thread: WorkerThread): Promise<WorkerThread> {
  return new Promise<WorkerThread>((resolve, reject) => {
    const timer = setTimeout(() => {
      const seconds = HANG_MILLISECONDS / 1000;
      const message = `the worker has not answered for ${seconds} s. The option worker: false does without`;
      fail(new GdelError('LOAD_FAILED', message));
    }, HANG_MILLISECONDS);
    const fail = (error: Error) => {
      clearTimeout(timer);
      thread.terminate();
      reject(error);
    };
    thread.onError(fail);
    thread.onMessage((message) => {
      if (message.type !== 'ready') return;
      clearTimeout(timer);
      resolve(thread);
    });
  });
}

/** A worker of the web's interface. */
function webWorker(worker: Worker): WorkerThread {
  return {
    post: (message, transfer) => worker.postMessage(message, transfer),
    onMessage: (handler) => worker.addEventListener('message', (event) => handler(event.data)),
    onError(handler) {
      worker.addEventListener('error', (event) => {
        event.preventDefault();
        handler(new Error(event.message || 'the worker was blocked or could not be loaded'));
      });
      worker.addEventListener('messageerror', () =>
        handler(new Error('a message could not be read')),
      );
    },
    terminate: () => worker.terminate(),
    keepAlive() {},
  };
}

/**
 * A worker of the web's interface, from its source text. A classic script: pages from a disk may
 * not load modules.
 */
function blobWorker(source: string): WorkerThread {
  const url = URL.createObjectURL(new Blob([source], { type: 'text/javascript' }));
  const thread = webWorker(new Worker(url, { name: 'gdel' }));
  // The worker fetches its script after this, and says that it is there by its first message.
  const revoke = () => URL.revokeObjectURL(url);
  thread.onMessage(revoke);
  thread.onError(revoke);
  return thread;
}

/** A thread of Node. */
function nodeWorker(href: string): WorkerThread {
  const { Worker } = builtin('node:worker_threads')!;
  // The global class may be jsdom's.
  const { URL } = builtin('node:url')!;
  const worker = new Worker(new URL(href), { name: 'gdel' });
  return {
    post: (message, transfer) => worker.postMessage(message, transfer),
    onMessage: (handler) => worker.on('message', handler),
    onError: (handler) => worker.on('error', handler),
    terminate: () => void worker.terminate(),
    keepAlive: (busy) => (busy ? worker.ref() : worker.unref()),
  };
}
