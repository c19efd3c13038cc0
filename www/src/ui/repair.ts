import type { Summary } from '../model/model';
import { count, share } from './dom';

/** What Phase 1 of a recorded run left to splaying, in words. */
export function repairOf(
  { nonDelaunayFacets, repaired, splayed }: NonNullable<Summary['trace']>,
  { simplices, hullFacets }: Pick<Summary, 'simplices' | 'hullFacets'>,
): string {
  if (nonDelaunayFacets === 0) return 'Every facet was locally Delaunay after Phase 1.';
  return (
    `Facets that were not locally Delaunay after Phase 1: ${count(nonDelaunayFacets)}, ${share(nonDelaunayFacets, 2 * simplices + hullFacets / 2)} of all. ` +
    `Star splaying repaired ${share(repaired, nonDelaunayFacets)} of them. It created ${count(splayed)} of the tetrahedra, ${share(splayed, simplices)}.`
  );
}
