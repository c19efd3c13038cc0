import assert from 'node:assert/strict';
import { test } from 'node:test';
import { updateOf } from '../../src/ui/update';

const none = {
  inverted: 0,
  notLocallyDelaunay: 0,
  flips: 0,
  stars: 0,
  reinserted: 0,
  inserted: 0,
  restarted: null,
};

test('the line under a frame says how it was made from the one before', () => {
  assert.equal(updateOf(null, 3), 'The first frame, from scratch');
  assert.equal(updateOf(none, 2), 'Mesh kept: 0 triangles inverted, 0 flips');
  assert.equal(
    updateOf({ ...none, inverted: 1, flips: 1234, stars: 5 }, 3),
    'Mesh kept: 1 tetrahedron inverted, 1,234 flips, 5 stars mended',
  );
  assert.equal(
    updateOf({ ...none, inverted: 9, restarted: 'inverted' }, 3),
    'From scratch: too many tetrahedra are inverted',
  );
  // A reason that is newer than this page.
  assert.equal(updateOf({ ...none, restarted: 'later' }, 2), 'From scratch: later');
});
