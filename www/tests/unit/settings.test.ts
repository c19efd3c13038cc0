import assert from 'node:assert/strict';
import { test } from 'node:test';
import { filesSource } from '../../src/model/source';
import { defaults, fileIn, fromHash, toHash } from '../../src/settings';

test('the first view needs no more than the name of its points', () => {
  assert.equal(toHash(defaults()), 'points=bunny');
  assert.deepEqual(fromHash(''), defaults());
});

test('a link restores every setting', () => {
  const settings = {
    ...defaults(),
    source: { kind: 'generator', dimension: 3, distribution: 'thin-sphere', count: 1234, seed: 9 },
    backend: 'cpu',
    color: 'volume',
    map: 'magma',
    filter: 'alpha',
    alpha: 0.25,
    normal: [0, -1, 0],
    keep: 0.375,
    up: '-z',
    apart: 0.5,
    layers: {
      simplices: true,
      edges: false,
      points: false,
      hull: true,
      facets: false,
      voronoi: false,
      skin: false,
    },
    camera: [1, -0.5, 3, 0.1, 0.2, -0.3],
    embed: true,
  } as const;
  assert.deepEqual(fromHash(toHash(settings as never)), settings);
});

test('a link to a model without points on its faces says so', () => {
  const source = { kind: 'url', dimension: 3, url: 'https://a.org/b.stl', bare: true } as const;
  assert.deepEqual(fromHash(toHash({ ...defaults(), source, filter: 'carve' })).source, source);
  const file = { ...filesSource([new File([], 'b.stl')], 3), bare: true } as const;
  const hash = toHash({ ...defaults(), source: file as never });
  assert.deepEqual(fileIn(hash), { name: 'b.stl', packed: null, bare: true });
});

test('a link to 2D restores the points and what was changed by hand', () => {
  assert.deepEqual(fromHash('#dim=2'), defaults(2));
  const settings = {
    ...defaults(2),
    source: { kind: 'generator', dimension: 2, distribution: 'two-lines', count: 0, seed: 9 },
    edits: [
      { do: 'add', at: [0.5, -2] },
      { do: 'move', point: 0, at: [1e-7, 3] },
      { do: 'remove', point: 0 },
    ],
    color: 'volume',
    filter: 'alpha',
    alpha: 0.25,
    layers: {
      simplices: false,
      edges: true,
      points: true,
      hull: false,
      facets: false,
      voronoi: true,
      skin: true,
    },
    camera: [0, 0, 0.5, 0.1, -0.2, 0],
  } as const;
  assert.deepEqual(fromHash(toHash(settings as never)), settings);
});

test('in 2D there is nothing to carve, no phase of creation, and nothing to look at from the side', () => {
  for (const hash of [
    '#dim=2&filter=carve',
    '#dim=2&color=phase',
    '#dim=2&points=bunny',
    '#dim=2&points=sphere_5_1',
    '#dim=2&edits=add_1',
  ]) {
    assert.deepEqual(fromHash(hash), defaults(2), hash);
  }
  assert.deepEqual(fromHash('#dim=2&camera=1_1_2_3_4_5').camera, [0, 0, 2, 3, 4, 0]);
  assert.equal(fromHash('#dim=2').camera, null);
  assert.deepEqual(fromHash('#edits=add_1_2').edits, []);
});

test('what makes no sense in a link is left out', () => {
  for (const hash of [
    '#points=toString',
    '#points=uniform_-5_1',
    '#points=uniform_1e99_1',
    '#points=uniform_0_1',
    '#points=uniform',
    '#dim=4',
    '#backend=magic',
    '#normal=0_0_0',
    '#normal=1_2',
    '#keep=',
    '#keep=half',
    '#up=w',
    '#camera=NaN_0_0_0_0_0',
    '#camera=0_0_-1_0_0_0',
    '#alpha=-1',
    '#map=constructor',
    '#url=javascript:alert(1)',
    '#url=scan.ply',
  ]) {
    assert.deepEqual(fromHash(hash), defaults(), hash);
  }
  assert.equal(fromHash('#apart=7').apart, 1);
});

test('a link made from a file names it', () => {
  const file = new File([], 'scan of a cat.ply');
  const hash = toHash({ ...defaults(), source: filesSource([file], 3) });
  assert.deepEqual(fileIn(`#${hash}`), { name: 'scan of a cat.ply', packed: null });
  const source = filesSource([file, new File([], 'dog.ply')], 3);
  assert.equal(
    fileIn(`#${toHash({ ...defaults(), source })}`)?.name,
    'scan of a cat.ply and 1 more',
  );
  assert.equal(fileIn('#points=bunny'), null);
});

test('a link may name a file on the web', () => {
  const url = 'https://example.org/a%20cat.ply?x=1&y=2';
  const settings = fromHash(`#url=${encodeURIComponent(url)}&embed`);
  assert.deepEqual(settings.source, { kind: 'url', dimension: 3, url });
  assert.equal(settings.embed, true);
  assert.deepEqual(fromHash(toHash(settings)), settings);
});

test('a link to a file of shapes is to 2D, with what was changed by hand', () => {
  const map = fromHash('#url=https://a.org/b.geojson');
  assert.equal(map.source.dimension, 2);
  const edits = [{ do: 'mesh', split: 0, fill: 0, minAngle: 30, maxArea: 0.5 }] as const;
  assert.deepEqual(fromHash(toHash({ ...map, edits })).edits, edits);
  assert.equal(filesSource([new File([], 'a.csv'), new File([], 'b.SVG.gz')], 3).dimension, 2);
  assert.equal(filesSource([new File([], 'b.svg.csv')], 3).dimension, 3);
});
