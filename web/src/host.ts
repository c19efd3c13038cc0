// Where tasks run: in a worker for each module, which is started when it is needed, or in the calling
// thread. One task runs at a time; others wait. A second worker is kept ready where runs are aborted,
// since that can end the first.

import { type Coordinates, isDetached } from './arrays.js';
import { type Connection, callerConnection, workerConnection } from './connection.js';
import type { Core } from './core.js';
import { type Device, gpuOf } from './device.js';
import { GdelError, giveBack, type PlainError, toGdelError } from './errors.js';
import { compiled } from './modules.js';
import type { Done, Helper, ModuleName, TaskName, Tasks } from './protocol.js';
import { loadCode, type ModuleAsset, messageOf, startWorker } from './runtime.js';
import { Stop } from './stop.js';
import type { Progress, TaskOptions } from './types.js';

/** A run that can be aborted and takes longer than this has a second worker started beside it. */
const WARM_MILLISECONDS = 100;

/** Workers that have taken part of a run end after this time without another one. */
const REST_MILLISECONDS = 10_000;

export interface HostOptions {
  gpu?: object | undefined;
  device?: Device | undefined;
  worker?: boolean | undefined;
  selfTest?: boolean | undefined;
}

/** What the arguments of a task were made of. */
export interface Sending {
  transfer: ArrayBuffer[];
  /** Whether errors give the points back, because the caller gave them away. */
  isGiven?: boolean;
}

export class Host {
  readonly #gpu: object | undefined;
  readonly #device: Device | undefined;
  readonly #selfTest: boolean | undefined;
  /** The instances that drive the device in this thread, while a worker computes. */
  readonly #drivers = new Map<ModuleName, Core>();
  readonly #connections = new Map<ModuleName, Promise<Connection>>();
  /** Workers that wait for others to be ended. */
  readonly #spares = new Map<ModuleName, Promise<Connection>>();
  /** Why no worker can be used here, if that is known. */
  #noWorker: string | null = null;
  #last: Promise<unknown> = Promise.resolve();
  #disposed = false;
  /** The hosts of workers that take parts of a run. */
  readonly #helpers: Host[] = [];
  #rest: ReturnType<typeof setTimeout> | undefined;

  constructor({ gpu, device, worker, selfTest }: HostOptions = {}) {
    this.#gpu = device ? gpuOf(device) : gpu;
    this.#device = device;
    this.#selfTest = selfTest;
    if (gpu) this.#noWorker = 'a GPU object cannot be sent to another thread';
    else if (worker === false) this.#noWorker = 'the option worker is false';
  }

  /** Whether tasks run in workers, as far as that is known. */
  get hasWorkers(): boolean {
    return this.#noWorker === null;
  }

  /**
   * Does what takes several workers, after all earlier tasks. The workers wait for more of it for a while, since the
   * system takes long to provide memory, and end if it fails.
   */
  together<R>(workers: number, work: (hosts: readonly Host[]) => Promise<R>): Promise<R> {
    const done = this.#last.then(async () => {
      this.#throwIfDisposed();
      clearTimeout(this.#rest);
      while (this.#helpers.length < workers) this.#helpers.push(new Host());
      try {
        return await work(this.#helpers.slice(0, workers));
      } catch (error) {
        this.#endHelpers();
        throw error;
      } finally {
        this.#rest = setTimeout(() => this.#endHelpers(), REST_MILLISECONDS);
        // Node does not wait for it.
        (this.#rest as { unref?(): void }).unref?.();
      }
    });
    this.#last = done.catch(() => {});
    return done;
  }

  #endHelpers(): void {
    for (const helper of this.#helpers.splice(0)) helper.dispose();
  }

  /** Runs a task after all earlier ones. */
  run<T extends TaskName>(
    asset: ModuleAsset,
    task: T,
    args: Tasks[T]['args'],
    { transfer, isGiven = false }: Sending,
    options: TaskOptions,
  ): Promise<Done<T>> {
    const stop = new Stop(options);
    const work = this.#last.then(async () => {
      try {
        return await this.#perform(asset, task, args, transfer, stop);
      } catch (thrown) {
        stop.throwIfStopped();
        const { error, points } = failureOf(thrown, args as { points?: Coordinates });
        if (isGiven && points && !isDetached(points)) giveBack(error, points);
        throw error;
      }
    });
    this.#last = work.catch(() => {});
    return new Promise<Done<T>>((resolve, reject) => {
      stop.onStop(reject);
      work.then(resolve, reject).finally(() => stop.release());
    });
  }

  async #perform<T extends TaskName>(
    asset: ModuleAsset,
    task: T,
    args: Tasks[T]['args'],
    transfer: ArrayBuffer[],
    stop: Stop,
  ): Promise<Done<T>> {
    stop.throwIfStopped();
    const connection = await this.#connect(asset);
    stop.throwIfStopped();
    this.#throwIfDisposed();
    let timer: ReturnType<typeof setTimeout> | undefined;
    if (connection.thread === 'worker' && stop.canBeAborted) {
      const warm = () => this.#warm(asset);
      timer = setTimeout(warm, WARM_MILLISECONDS);
      stop.onStop(warm);
    }
    try {
      const { thread, whyThread, whyInlined } = connection;
      const place = { thread, whyThread, whyInlined };
      if (this.#device && thread === 'worker' && isDriven(task)) {
        const driver = await this.#driver(asset);
        const result = await this.#drive({ driver, connection, asset }, task, args, stop);
        return { result, place, free: driver.free };
      }
      const result = await connection.run(task, args, transfer, stop);
      return { result, place, free: (key) => connection.free?.(key) };
    } catch (thrown) {
      if ((thrown as PlainError).fatal) this.#drop(connection, asset);
      throw thrown;
    } finally {
      clearTimeout(timer);
    }
  }

  /** Returns the instance of a module that drives the device. */
  async #driver({ wasm, code }: ModuleAsset): Promise<Core> {
    const { value } = await compiled(wasm);
    const { openCore } = await loadCode(code);
    const uses = { gpu: this.#gpu, device: this.#device, selfTest: this.#selfTest };
    const driver = this.#drivers.get(wasm.name) ?? openCore(value, uses);
    this.#drivers.set(wasm.name, driver);
    return driver;
  }

  /** Runs a task on the device, with the help of the worker. */
  async #drive<T extends TaskName>(
    { driver, connection, asset }: { driver: Core; connection: Connection; asset: ModuleAsset },
    task: T,
    args: Tasks[T]['args'],
    stop: Stop,
  ): Promise<Tasks[T]['result']> {
    let isOfWorker = false;
    const helper: Helper = {
      run: (...task) =>
        connection.run(...task, stop).catch((error) => {
          isOfWorker = true;
          throw error;
        }),
    };
    const control = {
      onProgress: (progress: Progress) => stop.report(progress),
      onBlocking() {},
      isAborted: () => stop.isStopped,
    };
    try {
      return await driver.run(task, args, control, helper);
    } catch (thrown) {
      if (isOfWorker) throw thrown;
      // What breaks here does not break the worker.
      const { fatal, ...error } = thrown as PlainError;
      if (fatal) this.#drivers.delete(asset.wasm.name);
      throw { ...error, fatal: false } satisfies PlainError;
    }
  }

  #throwIfDisposed(): void {
    if (this.#disposed) throw new GdelError('DISPOSED', 'the triangulator was disposed of');
  }

  dispose(): void {
    this.#disposed = true;
    for (const connection of [...this.#connections.values(), ...this.#spares.values()]) {
      void connection.then(
        (connection) => connection.close(),
        () => {},
      );
    }
    this.#connections.clear();
    this.#spares.clear();
    this.#endHelpers();
    for (const driver of this.#drivers.values()) driver.dispose();
  }

  #drop(connection: Connection, { wasm }: ModuleAsset): void {
    connection.close();
    this.#connections.delete(wasm.name);
  }

  async #connect(asset: ModuleAsset): Promise<Connection> {
    const { name } = asset.wasm;
    const current = await this.#connections.get(name)?.catch(() => undefined);
    if (current?.isAlive) return current;
    this.#throwIfDisposed();
    const spare = this.#spares.get(name);
    this.#spares.delete(name);
    const open = () => this.#open(asset);
    const connection = spare
      ? spare.then((ready) => (ready.isAlive ? ready : open()), open)
      : open();
    this.#connections.set(name, connection);
    return connection;
  }

  /** Starts the second worker of a module. */
  #warm(asset: ModuleAsset): void {
    const { name } = asset.wasm;
    if (this.#disposed || this.#spares.has(name)) return;
    const spare = this.#start(asset);
    this.#spares.set(name, spare);
    // If it fails, the run that needs it starts another one, and tells why that fails.
    spare.catch(() => {});
  }

  /** Starts a worker, while its module is compiled. */
  async #start({ wasm, worker }: ModuleAsset): Promise<Connection> {
    const module = compiled(wasm);
    module.catch(() => {});
    const thread = await startWorker(worker);
    try {
      return workerConnection(thread, await module, this.#selfTest);
    } catch (error) {
      thread.value.terminate();
      throw error;
    }
  }

  async #open(asset: ModuleAsset): Promise<Connection> {
    if (this.#noWorker === null) {
      try {
        return await this.#start(asset);
      } catch (error) {
        if (error instanceof GdelError) throw error;
        this.#noWorker = messageOf(error);
      }
    }
    const { openCore } = await loadCode(asset.code);
    const { value, whyInlined } = await compiled(asset.wasm);
    const core = openCore(value, { gpu: this.#gpu, selfTest: this.#selfTest });
    return callerConnection(core, { whyThread: this.#noWorker, whyInlined });
  }
}

/** Returns whether a task uses the device. */
const isDriven = (task: TaskName): boolean =>
  task === 'open' || task === 'delaunay3d' || task === 'delaunay2d';

/** Returns what a run is rejected with, and where its points are. */
function failureOf(
  thrown: unknown,
  args: { points?: Coordinates },
): { error: GdelError; points: Coordinates | undefined } {
  // Not sent yet, or sent and back again.
  if (thrown instanceof GdelError) return { error: thrown, points: args.points };
  const error = thrown as PlainError;
  return { error: toGdelError(error), points: error.points };
}
