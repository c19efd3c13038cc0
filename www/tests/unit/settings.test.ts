import { expect, test } from 'vitest';
import { defaults, fromHash, toHash } from '../../src/settings';

test('the first view needs no more than the name of its points', () => {
  expect(toHash(defaults())).toBe('points=bunny');
  expect(fromHash('')).toEqual(defaults());
});

test('a link restores every setting', () => {
  const settings = {
    ...defaults(),
    source: { kind: 'generator', distribution: 'thin-sphere', count: 1234, seed: 9 },
    engine: 'cpu',
    color: 'volume',
    map: 'magma',
    filter: 'alpha',
    alpha: 0.25,
    normal: [0, -1, 0],
    keep: 0.375,
    up: 'z',
    apart: 0.5,
    layers: { tetrahedra: true, edges: false, points: false, hull: true, facets: false },
    camera: [1, -0.5, 3, 0.1, 0.2, -0.3],
  } as const;
  expect(fromHash(toHash(settings as never))).toEqual(settings);
});

test('what makes no sense in a link is left out', () => {
  for (const hash of [
    '#points=toString', '#points=uniform_-5_1', '#points=uniform_1e99_1', '#engine=magic', '#cut=0_0_0_0.5', '#cut=1_2',
    '#camera=NaN_0_0_0_0_0', '#camera=0_0_-1_0_0_0', '#alpha=-1', '#map=constructor',
  ]) {
    expect(fromHash(hash), hash).toEqual(defaults());
  }
  expect(fromHash('#apart=7').apart).toBe(1);
});
