// The interface of the npm package d3-voronoi-treemap, in the calling thread.

import { type Clipped, Clipping, clippedMethods, property } from './clipping.js';
import { loadPower } from './index.js';
import { type Position, type TreemapCell, treemapSync } from './treemap.js';

/** A node of `d3.hierarchy` after `sum` was called. */
export interface HierarchyNode {
  value?: number | undefined;
  children?: HierarchyNode[] | undefined;
}

/** The polygon of a node: its corners, counter-clockwise on a screen, without the first one again. */
export interface NodePolygon<N> extends Array<Position> {
  site?: { x: number; y: number; weight: number; originalObject: SitePoint<N> };
}

/** A site, with the node that it is of. */
interface SitePoint<N> {
  index: number;
  /** The share of the polygon around it that it is to have. */
  share: number;
  x: number;
  y: number;
  weight: number;
  data: { index: number; weight: number; originalData: N };
}

/** A function that lays out hierarchies, and its settings. */
export interface VoronoiTreemap extends Clipped<VoronoiTreemap> {
  /**
   * Gives each node that has a value a property `polygon`; that of the others is removed.
   *
   * @throws `GdelError` `NOT_LOADED` before `voronoiTreemap.load()` is done; `BAD_INPUT` as from `treemapSync`.
   */
  <N extends HierarchyNode>(root: N): void;
  convergenceRatio(): number;
  /** Sets the share by which areas may be wrong, by default 0.001. */
  convergenceRatio(ratio: number): this;
  maxIterationCount(): number;
  /** Sets how often sites move at most, by default 50; of these, 2 are used. */
  maxIterationCount(count: number): this;
  minWeightRatio(): number;
  /** Sets the share of the largest value among siblings below which others count as that share, by default 0. */
  minWeightRatio(ratio: number): this;
  prng(): () => number;
  /** Accepted for the sake of code that sets it: nothing is random. */
  prng(prng: () => number): this;
}

/** How often sites move to the centres of their cells. */
const RELAX = 2;

/**
 * Returns a function that lays out hierarchies, with the interface of `d3.voronoiTreemap`: synchronous, in the calling
 * thread.
 *
 * ```js
 * import { voronoiTreemap } from 'gdel-wasm/d3-voronoi-treemap';
 * await voronoiTreemap.load(); // once
 * const root = hierarchy(data).sum((d) => d.weight);
 * voronoiTreemap().clip(polygon)(root);
 * root.leaves().map((leaf) => leaf.polygon);
 * ```
 */
export function voronoiTreemap(): VoronoiTreemap {
  const clipping = new Clipping();
  const settings = {
    convergenceRatio: 1e-3,
    maxIterationCount: 50,
    minWeightRatio: 0,
    prng: Math.random as () => number,
  };
  type Laid = HierarchyNode & { polygon?: NodePolygon<HierarchyNode> };

  const layOut = (root: HierarchyNode) => {
    forget(root);
    const pending: { node: Laid; polygon: NodePolygon<HierarchyNode> }[] = [
      { node: root, polygon: clipping.polygon.map(([x, y]) => [x, y]) },
    ];
    for (let next = pending.pop(); next; next = pending.pop()) {
      const { node, polygon } = next;
      node.polygon = polygon;
      const children = node.children ?? [];
      const values = children.map(({ value }) => Number(value));
      const least = settings.minWeightRatio * values.reduce((most, own) => Math.max(most, own), 0);
      const raised = values.map((own) => Math.max(own, least));
      const sum = raised.reduce((sum, own) => sum + own, 0);
      // A leaf, or one in which nothing has a value.
      if (!(sum > 0) && raised.every((own) => own === 0)) continue;
      const { cells } = treemapSync(raised, {
        shape: polygon,
        relax: Math.min(RELAX, settings.maxIterationCount),
        tolerance: Math.min(1e-3, Math.max(settings.convergenceRatio, 1e-9)),
      });
      cells.forEach((cell, i) => {
        if (cell)
          pending.push({ node: children[i]!, polygon: polygonFor(cell, children[i]!, sum) });
      });
    }
  };
  const self = () => layout;
  const setting = <K extends keyof typeof settings>(key: K) =>
    property<VoronoiTreemap, (typeof settings)[K]>(
      () => settings[key],
      (value) => {
        settings[key] = value;
      },
      self,
    );
  const layout: VoronoiTreemap = Object.assign(layOut, clippedMethods(clipping, self), {
    convergenceRatio: setting('convergenceRatio'),
    maxIterationCount: setting('maxIterationCount'),
    minWeightRatio: setting('minWeightRatio'),
    prng: setting('prng'),
  }) as VoronoiTreemap;
  return layout;
}

/** Loads the WebAssembly module that layouts need. Later calls do nothing. */
voronoiTreemap.load = (): Promise<void> => loadPower();

/** Removes the polygons of a node and all below it. */
function forget(node: HierarchyNode & { polygon?: unknown }): void {
  const pending = [node];
  for (let next = pending.pop(); next; next = pending.pop()) {
    delete next.polygon;
    pending.push(...(next.children ?? []));
  }
}

/** Returns the polygon of a node from its cell beside others, whose values have this sum. */
function polygonFor(
  cell: TreemapCell<number>,
  originalData: HierarchyNode,
  sum: number,
): NodePolygon<HierarchyNode> {
  const { index, site, weight, value } = cell;
  const place = { x: site[0], y: site[1], weight };
  const data = { index, weight: value, originalData };
  const share = value / sum;
  return Object.assign(
    cell.map(([x, y]): Position => [x, y]),
    { site: { ...place, originalObject: { index, share, ...place, data } } },
  );
}
