import { test } from 'node:test';
import { niceLength } from '../../src/ui/scaleBar';
import { closeTo } from './close';

test('a scale is 1, 2 or 5 times a power of ten', () => {
  for (const [longest, nice] of [
    [1, 1],
    [1.9, 1],
    [2, 2],
    [4.99, 2],
    [7, 5],
    [99, 50],
    [0.03, 0.02],
    [123456, 100000],
  ])
    closeTo(niceLength(longest) / nice, 1, 9);
});
