import * as Comlink from 'comlink';
import type { ModelWorker } from './worker';

/** The model in its worker. */
export type ModelClient = Comlink.Remote<ModelWorker>;

export function connect(): ModelClient {
  return Comlink.wrap<ModelWorker>(
    new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' }),
  );
}
