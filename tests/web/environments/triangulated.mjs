// What every environment does: copied into each project, to be bundled with it.

import { delaunay3d, delaunay3dSync, load3d, verify } from 'gdel-wasm';

const POINTS = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1];

/** The number of tetrahedra and whether they are right, and where the work was done. */
export async function triangulated() {
  try {
    const mesh = await delaunay3d(POINTS);
    const { passed } = await verify(POINTS, mesh);
    await load3d();
    const same = delaunay3dSync(POINTS).tetrahedra.join() === mesh.tetrahedra.join();
    const { thread, whyInlined } = mesh.stats;
    const { code } = await delaunay3d([0, NaN, 0]).catch((error) => error);
    return { tetrahedra: mesh.tetrahedra.length / 4, passed, same, thread, whyInlined, code };
  } catch (error) {
    return { error: String(error) };
  }
}
