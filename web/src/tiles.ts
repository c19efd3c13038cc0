// Triangulations by several workers, each of which has a tile of the points. A part of the code that is loaded when there
// are several.

import {
  type Bytes,
  buffersOf,
  type Coordinates,
  type Indices,
  type SignedIndices,
} from './arrays.js';
import { giveBack } from './errors.js';
import type { Host, Sending } from './host.js';
import { onlyOutputs } from './outputs.js';
import type { CoreStats, Done, Task, Tasks, TileArrays } from './protocol.js';
import type { ModuleAsset } from './runtime.js';
import type { Stop } from './stop.js';
import type { Output, Progress } from './types.js';

/** A run on points. */
interface Run {
  task: Task;
  dimension: 2 | 3;
  args: { points: Coordinates };
  sending: Sending;
  outputs: readonly Output[];
}

/**
 * Triangulates points by several workers, until `stop` ends that. Returns null and leaves the points where they are if one
 * worker has to do it, or is as fast.
 */
export async function inWorkers(
  hosts: readonly Host[],
  asset: ModuleAsset,
  run: Run,
  stop: Stop,
): Promise<Done<Task> | null> {
  const { task, dimension, args, sending, outputs } = run;
  const started = performance.now();
  const work = async () => {
    const { isGiven = false } = sending;
    const to = { transfer: [args.points.buffer], isGiven };
    const given = { dimension, points: args.points, tiles: hosts.length };
    const { result: split, place } = await hosts[0]!.run(asset, 'splitPoints', given, to, {});
    args.points = split.points;
    sending.transfer[0] = args.points.buffer;
    if (split.spanned < dimension || place.thread !== 'worker') return null;
    const onProgress = (progress: Progress) => stop.report(progress);
    const tiling = inTiles({ hosts, asset }, dimension, split, started, onProgress);
    const joined = await tiling.catch((error) => {
      if (isGiven) giveBack(error, args.points);
      throw error;
    });
    if (!joined) return null;
    const { simplices, ...others } = joined.arrays;
    const arrays =
      task === 'delaunay3d'
        ? { tetrahedra: simplices, ...onlyOutputs(others, outputs) }
        : { triangles: simplices, halfedges: others.neighbors, ...others };
    const stats = { ...joined.stats, milliseconds: performance.now() - started };
    onProgress({ phase: 'finish', fraction: 1 });
    const result = { points: args.points, dimension, ...arrays, stats };
    return { result: result as unknown as Tasks[Task]['result'], place };
  };
  const stopped = new Promise<never>((_, reject) => stop.onStop(reject));
  return Promise.race([work(), stopped]);
}

/** The workers, and the module with the tasks. */
interface Workers {
  hosts: readonly Host[];
  asset: ModuleAsset;
}

/** The arrays of a mesh that several workers have made. */
interface Joined {
  arrays: Tasks['joinTiles']['result'];
  stats: CoreStats;
}

/** If tiles have to know this share of all points of other tiles, one worker is as fast. */
const MUCH = 0.5;

type Messages = (number | Bytes)[];

/**
 * Triangulates points that are split: has each worker triangulate its tile, passes on what the tiles send each other
 * until they have nothing left to say, and joins them in the first worker. Returns null where one worker is as fast, since
 * each tile needs most of the points.
 */
async function inTiles(
  { hosts, asset }: Workers,
  dimension: 2 | 3,
  { plan, parts, points }: Tasks['splitPoints']['result'],
  started: number,
  onProgress: (progress: Progress) => void,
): Promise<Joined | null> {
  const phases: CoreStats['phases'] = [];
  let last = started;
  const lap = (name: string) => {
    const now = performance.now();
    phases.push({ name, milliseconds: now - last });
    last = now;
  };
  const done = parts.map(() => 0);
  const step = async (number: number, args: Tasks['stepTile']['args'], transfer: ArrayBuffer[]) => {
    const { result } = await hosts[number]!.run(
      asset,
      'stepTile',
      args,
      { transfer },
      {
        onProgress({ phase, fraction }) {
          done[number] = Math.max(done[number]!, fraction);
          const share = done.reduce((sum, part) => sum + part, 0) / done.length;
          onProgress({ phase, fraction: 0.8 * share });
        },
      },
    );
    return result.messages;
  };
  const begun = parts.map(({ points, indices }, number) => {
    const begin = { dimension, plan, number, points, indices };
    return step(number, { begin, messages: [] }, [points.buffer, indices.buffer]);
  });
  let sent = await Promise.all(begun);
  lap('split');
  for (let steps = 1; steps === 1 || sent.some(({ length }) => length > 0); steps++) {
    const { received, bytes } = delivered(sent);
    // A point takes eight bytes, and eight for each coordinate.
    const pointBytes = 8 * (1 + dimension);
    if (steps === 2 && bytes > MUCH * (points.length / dimension) * pointBytes) return null;
    const taken = received.map((messages, number) =>
      step(number, { messages }, buffersOf(messages)),
    );
    sent = await Promise.all(taken);
    if (steps === 1) lap('insert');
  }
  lap('exchange');
  onProgress({ phase: 'finish', fraction: 0.8 });

  const joined = await collected({ hosts, asset }, dimension, points, onProgress);
  lap('finish');
  return { ...joined, stats: { ...joined.stats, threads: hosts.length, phases } };
}

/** Has the workers finish their tiles, and joins these in the first worker. */
async function collected(
  { hosts, asset }: Workers,
  dimension: 2 | 3,
  points: Coordinates,
  onProgress: (progress: Progress) => void,
): Promise<Joined> {
  const nothing = { transfer: [] };
  const tiles = await Promise.all(
    hosts.map((host) => host.run(asset, 'finishTile', {}, nothing, {})),
  );
  let base = tiles[0]!.result.simplices;
  const takings = hosts.slice(1).map((host, i) => {
    const taking = host.run(asset, 'takeTile', { base }, nothing, {});
    base += tiles[i + 1]!.result.simplices;
    return taking;
  });
  const others = (await Promise.all(takings)).map(({ result }) => result);
  onProgress({ phase: 'finish', fraction: 0.9 });
  const all = {
    dimension,
    points: points.length / dimension,
    simplices: tiles[0]!.result.simplices,
    others,
    duplicates: tiles.map(({ result }) => result.duplicates),
  };
  const { result: arrays } = await hosts[0]!.run(
    asset,
    'joinTiles',
    all,
    { transfer: buffersOf(others) },
    {},
  );
  const stats = { ...tiles[0]!.result.stats };
  for (const { result } of tiles.slice(1)) addTo(stats, result.stats);
  return { arrays, stats };
}

/** Returns for each tile what the others have sent to it, and the size of all that. */
function delivered(sent: Messages[]): { received: Messages[]; bytes: number } {
  const received = sent.map((): Messages => []);
  let bytes = 0;
  for (const [from, messages] of sent.entries()) {
    for (let i = 0; i < messages.length; i += 2) {
      const message = messages[i + 1] as Bytes;
      received[messages[i] as number]!.push(from, message);
      bytes += message.byteLength;
    }
  }
  return { received, bytes };
}

/** Adds what another worker has counted. */
function addTo(stats: CoreStats, { exact, wasmBytes }: CoreStats): void {
  const { integer, expansion, symbolic } = stats.exact;
  stats.exact = {
    integer: integer + exact.integer,
    expansion: expansion + exact.expansion,
    symbolic: symbolic + exact.symbolic,
  };
  stats.wasmBytes += wasmBytes;
}

/** What joins tiles. */
interface Joining {
  /** Copies the arrays of the first tile to the beginning of these, and returns the others. */
  copyTo(simplices: Indices, neighbors: SignedIndices): Omit<TileArrays, 'simplices' | 'neighbors'>;
  /** Enters the neighbours in other tiles, and returns the hull. */
  link(dimension: number, borders: Indices, hull: Indices, neighbors: SignedIndices): Uint32Array;
}

/** Joins the tile of a worker to the others. */
export function joinTiles(
  { dimension, points, simplices: own, others, duplicates }: Tasks['joinTiles']['args'],
  { copyTo, link }: Joining,
): Tasks['joinTiles']['result'] {
  const start = own * (dimension + 1);
  const length = others.reduce((sum, { simplices }) => sum + simplices.length, start);
  const simplices = new Uint32Array(length);
  const neighbors = new Int32Array(length);
  const { borders, hull } = copyTo(simplices, neighbors);
  let at = start;
  for (const tile of others) {
    simplices.set(tile.simplices, at);
    neighbors.set(tile.neighbors, at);
    at += tile.simplices.length;
    // Each is large, and is not needed any more.
    [tile.simplices, tile.neighbors] = [new Uint32Array(0), new Int32Array(0)];
  }
  const allBorders = concatenated([borders, ...others.map((tile) => tile.borders)]);
  const facets = concatenated([hull, ...others.map((tile) => tile.hull)]);
  const duplicateOf = new Int32Array(points).fill(-1);
  for (const pairs of duplicates)
    for (let i = 0; i < pairs.length; i += 2) duplicateOf[pairs[i]!] = pairs[i + 1]!;
  const joined = link(dimension, allBorders, facets, neighbors);
  return { simplices, neighbors, hull: joined as Indices, duplicateOf };
}

function concatenated(arrays: Indices[]): Indices {
  const all = new Uint32Array(arrays.reduce((length, array) => length + array.length, 0));
  let at = 0;
  for (const array of arrays) {
    all.set(array, at);
    at += array.length;
  }
  return all;
}
