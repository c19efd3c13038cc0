// The interface of the npm package d3-voronoi-map, in the calling thread.

import { areaOf, type Clipped, Clipping, clippedMethods, property } from './clipping.js';
import { GdelError, loadPower, powerNow } from './index.js';
import type { TreemapArrays } from './nested.js';
import { type Position, polygonOf } from './treemap.js';

/** The error of `d3-voronoi-map`, by its name. */
export { GdelError as d3VoronoiMapError };

/** What a site was made of. */
interface SiteData<T> {
  index: number;
  /** The value of the datum, which is at least `minWeightRatio` of the largest. */
  weight: number;
  initialPosition: Position | null;
  initialWeight: number;
  /** The element of the data. */
  originalData: T;
}

/** A site. */
export interface MapPoint<T> {
  index: number;
  /** The area that the cell is to have. */
  targetedArea: number;
  data: SiteData<T>;
  x: number;
  y: number;
  /** The weight in the power diagram. */
  weight: number;
}

/** A cell: its corners, counter-clockwise on a screen, without the first one again. */
export interface MapPolygon<T> extends Array<Position> {
  site: { x: number; y: number; weight: number; originalObject: MapPoint<T> };
}

/** What a simulation has come to. */
export interface SimulationState<T> {
  /** The cells of all data whose weight is not 0, in their order. */
  polygons: MapPolygon<T>[];
  iterationCount: number;
  /** The sum of what the areas lack or have too much, as a share of the clip polygon's area. */
  convergenceRatio: number;
  /** Whether nothing is left to do. */
  ended: boolean;
}

/** An accessor, which also gets the index, the data, and the simulation. */
export type SimulationAccessor<T, R> = (
  datum: T,
  index: number,
  data: readonly T[],
  simulation: VoronoiMapSimulation<T>,
) => R;

type Listener<T> = (this: VoronoiMapSimulation<T>) => void;

/** A simulation. Without an argument, a setter returns its value. */
export interface VoronoiMapSimulation<T> extends Clipped<VoronoiMapSimulation<T>> {
  weight(): (datum: T) => number;
  /** Sets the accessor to the weight, by default `d => d.weight`. */
  weight(weight: (datum: T) => number): this;
  convergenceRatio(): number;
  /** Sets the convergence ratio at which the areas are right enough, by default 0.001. */
  convergenceRatio(ratio: number): this;
  maxIterationCount(): number;
  /** Sets the largest number of iterations, by default 50. */
  maxIterationCount(count: number): this;
  minWeightRatio(): number;
  /** Sets the share of the largest weight below which others count as that share, by default 0. */
  minWeightRatio(ratio: number): this;
  prng(): () => number;
  /** Sets the source of random numbers for positions, by default `Math.random`. */
  prng(prng: () => number): this;
  initialPosition(): SimulationAccessor<T, ArrayLike<number> | null | undefined>;
  /** Sets where sites begin. By default, and where that is not inside, a place that suits the weights. */
  initialPosition(accessor: SimulationAccessor<T, ArrayLike<number> | null | undefined>): this;
  initialWeight(): SimulationAccessor<T, number>;
  /** Sets an accessor whose values change nothing: for the positions, the weights are unique. */
  initialWeight(accessor: SimulationAccessor<T, number>): this;
  /** Does one iteration, without events. */
  tick(): void;
  /** Starts the timer again. */
  restart(): this;
  /** Stops the timer. */
  stop(): this;
  /** Returns what it has come to. */
  state(): SimulationState<T>;
  /** Returns the listener for events of a type, `'tick'` or `'end'`, each with a name as in `'tick.mine'`. */
  on(typenames: string): Listener<T> | undefined;
  /** Sets or, with null, removes a listener for events of these types. */
  on(typenames: string, listener: Listener<T> | null): this;
}

/** Sites have settled if on average they are no further from the centres of their cells than this, in their radii. */
const SETTLED = 0.1;

/** The share by which areas may be wrong, if the convergence ratio asks for less. */
const TOLERANCE = 1e-3;

/**
 * Starts a simulation that divides a convex polygon into cells of areas that are proportional to weights, with the
 * interface of `d3.voronoiMapSimulation`: in the calling thread. The first iteration makes all areas right; later ones
 * move the sites to the centres of their cells, and make the areas right again.
 *
 * ```js
 * import { voronoiMapSimulation } from 'gdel-wasm/d3-voronoi-map';
 * await voronoiMapSimulation.load(); // once
 * const simulation = voronoiMapSimulation(data).clip(polygon).stop();
 * while (!simulation.state().ended) simulation.tick();
 * draw(simulation.state().polygons);
 * ```
 *
 * @throws `GdelError` from `tick` and `state`: `NOT_LOADED` before `voronoiMapSimulation.load()` is done, `BAD_INPUT` with
 * the `index` of a weight that is negative or not finite, or if all are 0.
 */
export function voronoiMapSimulation<T = { weight: number }>(
  data: readonly T[],
): VoronoiMapSimulation<T> {
  const clipping = new Clipping();
  const settings = {
    weight: (datum: T) => (datum as { weight: number }).weight,
    convergenceRatio: TOLERANCE,
    maxIterationCount: 50,
    minWeightRatio: 0,
    prng: Math.random as () => number,
    initialPosition: (() => null) as SimulationAccessor<T, ArrayLike<number> | null | undefined>,
    initialWeight: (() => 1) as SimulationAccessor<T, number>,
  };
  const listeners = new Map<string, Listener<T>>();
  let timer: ReturnType<typeof setTimeout> | undefined;
  let run: Run<T> | undefined;

  const fresh = () => {
    run = undefined;
  };
  const current = () => {
    run ??= new Run(data, clipping, settings, simulation);
    return run;
  };
  const dispatch = (type: string) => {
    for (const [name, listener] of listeners)
      if (name === type || name.startsWith(`${type}.`)) listener.call(simulation);
  };
  const stop = () => {
    clearTimeout(timer);
    timer = undefined;
  };
  const step = () => {
    timer = undefined;
    simulation.tick();
    const { ended } = current().state();
    if (!ended) start();
    dispatch('tick');
    if (ended) dispatch('end');
  };
  const start = () => {
    stop();
    timer = setTimeout(step, FRAME_MILLISECONDS);
  };

  const self = () => simulation;
  const setting = <K extends keyof typeof settings>(key: K) =>
    property<VoronoiMapSimulation<T>, (typeof settings)[K]>(
      () => settings[key],
      (value) => {
        settings[key] = value;
        fresh();
      },
      self,
    );
  const simulation: VoronoiMapSimulation<T> = {
    ...clippedMethods(clipping, self, fresh),
    weight: setting('weight'),
    convergenceRatio: setting('convergenceRatio'),
    maxIterationCount: setting('maxIterationCount'),
    minWeightRatio: setting('minWeightRatio'),
    prng: setting('prng'),
    initialPosition: setting('initialPosition'),
    initialWeight: setting('initialWeight'),
    tick: () => current().tick(),
    state: () => current().state(),
    stop() {
      stop();
      return simulation;
    },
    restart() {
      start();
      return simulation;
    },
    on(typenames: string, listener?: Listener<T> | null) {
      const names = typenames.trim().split(/\s+/);
      for (const name of names)
        if (!/^(tick|end)(\.|$)/.test(name))
          throw new GdelError('BAD_INPUT', `unknown type: ${name}`);
      if (listener === undefined) return listeners.get(names[0]!);
      for (const name of names) {
        if (listener) listeners.set(name, listener);
        else listeners.delete(name);
      }
      return simulation;
    },
  } as VoronoiMapSimulation<T>;
  start();
  return simulation;
}

/** Loads the WebAssembly module that simulations need. Later calls do nothing. */
voronoiMapSimulation.load = (): Promise<void> => loadPower();

/** The time between two iterations of the timer. */
const FRAME_MILLISECONDS = 17;

interface Settings<T> {
  weight: (datum: T) => number;
  convergenceRatio: number;
  maxIterationCount: number;
  minWeightRatio: number;
  initialPosition: SimulationAccessor<T, ArrayLike<number> | null | undefined>;
  initialWeight: SimulationAccessor<T, number>;
}

/** The iterations with certain settings. */
class Run<T> {
  /** All data with a weight that is not 0. */
  readonly #points: MapPoint<T>[];
  readonly #settings: Settings<T>;
  readonly #corners: Float64Array<ArrayBuffer>;
  readonly #area: number;
  /** What the next iteration shows. */
  #next: TreemapArrays | undefined;
  #state: SimulationState<T>;

  constructor(
    data: readonly T[],
    clipping: Clipping,
    settings: Settings<T>,
    simulation: VoronoiMapSimulation<T>,
  ) {
    this.#settings = settings;
    this.#corners = Float64Array.from(clipping.polygon.flat());
    this.#area = areaOf(clipping.polygon);
    const { weight, minWeightRatio, initialPosition, initialWeight } = settings;
    const weights = data.map((datum, i) => {
      const value = Number(weight(datum));
      if (value >= 0 && value < Infinity) return value;
      const message = `weight ${i} must be a finite number from 0 on, not ${value}`;
      throw new GdelError('BAD_INPUT', message, { index: i });
    });
    const least = minWeightRatio * weights.reduce((most, own) => Math.max(most, own), 0);
    const raised = weights.map((own) => Math.max(own, least));
    const sum = raised.reduce((sum, own) => sum + own, 0);
    if (data.length > 0 && !(sum > 0)) throw new GdelError('BAD_INPUT', 'all weights are 0');
    const points = data.map((originalData, index): MapPoint<T> => {
      const given = initialPosition(originalData, index, data, simulation);
      const place = given && ([Number(given[0]), Number(given[1])] as Position);
      return {
        index,
        targetedArea: (this.#area * raised[index]!) / sum,
        data: {
          index,
          weight: raised[index]!,
          initialPosition: place && clipping.contains(place) ? place : null,
          initialWeight: Number(initialWeight(originalData, index, data, simulation)),
          originalData,
        },
        x: NaN,
        y: NaN,
        weight: 0,
      };
    });
    this.#points = points.filter(({ targetedArea }) => targetedArea > 0);
    this.#next = this.#solve(this.#points.map(({ data }) => data.initialPosition));
    const { sites } = this.#next;
    this.#points.forEach((point, i) => {
      [point.x, point.y] = [sites[2 * i]!, sites[2 * i + 1]!];
    });
    // At first, the Voronoi diagram of the sites.
    const weightsAtFirst = new Float64Array(this.#points.length);
    const cells = powerNow('powerCells', {
      points: sites,
      weights: weightsAtFirst,
      corners: this.#corners,
    });
    this.#state = this.#stateOf(cells, 0);
  }

  /** Returns a map with sites at these places, as far as there are some. */
  #solve(places: readonly (Position | null)[]): TreemapArrays {
    const tolerance = Math.min(TOLERANCE, Math.max(this.#settings.convergenceRatio / 2, 1e-9));
    return powerNow('treemap', {
      corners: this.#corners,
      parents: new Int32Array(places.length).fill(-1),
      values: Float64Array.from(this.#points, ({ targetedArea }) => targetedArea),
      sites: Float64Array.from(places.flatMap((place) => place ?? [NaN, NaN])),
      options: { relax: 0, tolerance },
    });
  }

  #stateOf(
    found: Pick<TreemapArrays, 'offsets' | 'outlines' | 'areas'>,
    iterationCount: number,
  ): SimulationState<T> {
    let error = 0;
    const polygons = this.#points.map((point, i) => {
      error += Math.abs(found.areas[i]! - point.targetedArea);
      const { x, y, weight } = point;
      const site = { x, y, weight, originalObject: point };
      return Object.assign(polygonOf(found, i), { site });
    });
    const convergenceRatio = error / this.#area;
    const isRight = iterationCount > 0 && convergenceRatio <= this.#settings.convergenceRatio;
    const ended =
      iterationCount >= this.#settings.maxIterationCount ||
      (isRight && this.#restlessness(polygons) <= SETTLED);
    return { polygons, iterationCount, convergenceRatio, ended };
  }

  /** Returns how far sites are from the centres of their cells, on average, in radii of these. */
  #restlessness(polygons: readonly MapPolygon<T>[]): number {
    const all = polygons.map((polygon, i) => {
      const [x, y] = centroidOf(polygon);
      const { x: sx, y: sy, targetedArea } = this.#points[i]!;
      return Math.hypot(x - sx, y - sy) / Math.sqrt(targetedArea / Math.PI);
    });
    return all.reduce((sum, own) => sum + own, 0) / (all.length || 1);
  }

  tick(): void {
    const { ended, iterationCount, polygons } = this.#state;
    if (ended) return;
    const found = this.#next ?? this.#solve(polygons.map(centroidOf));
    this.#next = undefined;
    this.#points.forEach((point, i) => {
      [point.x, point.y] = [found.sites[2 * i]!, found.sites[2 * i + 1]!];
      point.weight = found.weights[i]!;
    });
    this.#state = this.#stateOf(found, iterationCount + 1);
  }

  state(): SimulationState<T> {
    return this.#state;
  }
}

/** Returns the centre of mass of a polygon. */
function centroidOf(polygon: readonly Position[]): Position {
  const [[x0, y0]] = polygon as [Position];
  let [sum, x, y] = [0, 0, 0];
  polygon.forEach(([ax, ay], i) => {
    const [bx, by] = polygon[(i + 1) % polygon.length]!;
    const cross = (ax - x0) * (by - y0) - (ay - y0) * (bx - x0);
    sum += cross;
    x += cross * (ax - x0 + bx - x0);
    y += cross * (ay - y0 + by - y0);
  });
  return sum === 0 ? [x0, y0] : [x0 + x / sum / 3, y0 + y / sum / 3];
}

/** Returns an accessor for random positions in the clip polygon. */
export function voronoiMapInitialPositionRandom<T>(): SimulationAccessor<T, Position> {
  return (_datum, _index, _data, simulation) => {
    const clipping = new Clipping();
    clipping.setPolygon(simulation.clip());
    const [x, y] = clipping.extent[0];
    const [width, height] = clipping.size;
    const prng = simulation.prng();
    for (let i = 0; i < 1000; i++) {
      const place: Position = [x + width * prng(), y + height * prng()];
      if (clipping.contains(place)) return place;
    }
    // Numbers that are not random.
    return centroidOf(clipping.polygon);
  };
}

/** An accessor for positions on a circle, and where it begins. */
export interface PiePosition<T> extends SimulationAccessor<T, Position> {
  startAngle(): number;
  /** Sets the angle of the first datum, in radians, by default 0. */
  startAngle(angle: number): this;
}

/** Returns an accessor for positions on a circle around the middle of the clip polygon, one datum after the other. */
export function voronoiMapInitialPositionPie<T>(): PiePosition<T> {
  let startAngle = 0;
  const pie = (
    _datum: T,
    index: number,
    data: readonly T[],
    simulation: VoronoiMapSimulation<T>,
  ) => {
    const polygon = simulation.clip();
    const [x, y] = centroidOf(polygon);
    const distances = polygon.map(([ax, ay], i) => {
      const [bx, by] = polygon[(i + 1) % polygon.length]!;
      return Math.abs((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / Math.hypot(bx - ax, by - ay);
    });
    const radius = distances.reduce((least, own) => Math.min(least, own), Infinity) / 2;
    const angle = startAngle + (2 * Math.PI * index) / data.length;
    return [x + radius * Math.cos(angle), y + radius * Math.sin(angle)] as Position;
  };
  const accessor: PiePosition<T> = Object.assign(pie, {
    startAngle: property<PiePosition<T>, number>(
      () => startAngle,
      (angle) => {
        startAngle = angle;
      },
      () => accessor,
    ),
  }) as PiePosition<T>;
  return accessor;
}
