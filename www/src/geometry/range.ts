/** So many values are looked at for percentiles. */
const SAMPLE = 50_000;

/** How many of the values at either end may be outliers. */
const TAIL = 0.01;

/** How far beyond the rest values are no outliers yet, as a share of the range of the rest. */
const MARGIN = 0.3;

/** A sample of some numbers, ascending, from which percentiles are read. */
export class Sample {
  private readonly sorted: Float64Array;
  readonly low: number;
  readonly high: number;

  /** Takes the numbers `at(0)` … `at(count − 1)`, of which there is at least one. */
  constructor(count: number, at: (i: number) => number) {
    let [low, high] = [Infinity, -Infinity];
    for (let i = 0; i < count; i++) {
      const x = at(i);
      if (x < low) low = x;
      if (x > high) high = x;
    }
    [this.low, this.high] = [low, high];
    const taken = Math.min(count, SAMPLE);
    this.sorted = new Float64Array(taken);
    for (let i = 0; i < taken; i++) this.sorted[i] = at(Math.floor((i * count) / taken));
    this.sorted.sort();
  }

  /** The number below which a share of the numbers lies. */
  quantile(share: number): number {
    const { sorted } = this;
    return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
  }

  /**
   * The lowest and the highest number, without outliers: a few birds above a city do not make it
   * any taller.
   */
  get range(): [low: number, high: number] {
    const [low, high] = [this.quantile(TAIL), this.quantile(1 - TAIL)];
    const margin = MARGIN * (high - low);
    return [Math.max(this.low, low - margin), Math.min(this.high, high + margin)];
  }
}

/** The range of one coordinate of points, of which there is at least one, without outliers. */
export function rangeAlong(
  points: ArrayLike<number>,
  axis: number,
  dimension: 2 | 3,
): [low: number, high: number] {
  return new Sample(points.length / dimension, (i) => points[dimension * i + axis]).range;
}

/** The range of one coordinate of points, of which there is at least one, with outliers. */
export function wholeRange(
  points: ArrayLike<number>,
  axis: number,
  dimension: 2 | 3,
): [low: number, high: number] {
  const { low, high } = new Sample(points.length / dimension, (i) => points[dimension * i + axis]);
  return [low, high];
}
