// What differs between the dimensions, and how errors are expected, for tests of meshes that change.

import assert from 'node:assert/strict';

/** Returns the functions and the names of the arrays of both dimensions of the package. */
export const dimensionsOf = (gdel) => ({
  3: {
    triangulate: gdel.delaunay3d,
    blocking: () => gdel.load3d().then(() => gdel.delaunay3dSync),
    generate: gdel.generate,
    verify: gdel.verify,
    arrays: ['tetrahedra', 'neighbors', 'hull', 'duplicateOf', 'points'],
  },
  2: {
    triangulate: gdel.delaunay2d,
    blocking: () => gdel.load2d().then(() => gdel.delaunay2dSync),
    generate: gdel.generate2d,
    verify: gdel.verify2d,
    arrays: ['triangles', 'halfedges', 'hull', 'duplicateOf', 'coords'],
  },
});

/** Returns a function that expects a promise to be rejected with an error of the package. */
export const rejectsOf =
  ({ GdelError }) =>
  (promise, code, message) =>
    assert.rejects(promise, (error) => {
      assert.ok(error instanceof GdelError, String(error));
      assert.equal(error.code, code, error.message);
      if (message) assert.match(error.message, message);
      return true;
    });
