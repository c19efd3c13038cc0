import assert from 'node:assert/strict';
import { test } from 'node:test';
import { repairOf } from '../../src/ui/repair';

const MESH = { simplices: 2000, hullFacets: 400 };

test('says how much splaying had to do', () => {
  assert.equal(
    repairOf({ rounds: 9, nonDelaunayFacets: 21, repaired: 21, splayed: 1200 }, MESH),
    'Facets that were not locally Delaunay after Phase 1: 21, 0.5 % of all. Splaying repaired 100 % of them. It made 1,200 of the tetrahedra, 60 %.',
  );
});

test('says that there was nothing to do', () => {
  assert.equal(
    repairOf({ rounds: 9, nonDelaunayFacets: 0, repaired: 0, splayed: 0 }, MESH),
    'Every facet was locally Delaunay after Phase 1.',
  );
});
