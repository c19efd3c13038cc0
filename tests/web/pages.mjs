// Pages with restrictions, in whatever browser: the tests of Chromium and Firefox share these.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { serve } from './server.mjs';

/** What a page or a frame finds: run there, with the URL of the package. */
async function triangulated(url) {
  const gdel = await import(url);
  const points = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1];
  const mesh = await gdel.delaunay3d(points);
  await gdel.load3d();
  const { thread, whyThread, whyInlined } = mesh.stats;
  const several = await gdel.delaunay3d(points, { backend: 'cpu', threads: 2 });
  // Where there are no workers, the calling thread is alone.
  const workers = several.stats.threads === (thread === 'worker' ? 2 : 1);
  const others = [several, gdel.delaunay3dSync(points)];
  const same = others.every(({ tetrahedra }) => tetrahedra.join() === mesh.tetrahedra.join());
  const { passed } = await gdel.verify(points, mesh);
  const { length } = mesh.tetrahedra;
  return { tetrahedra: length, same, workers, passed, thread, whyThread, whyInlined };
}

const RIGHT = { tetrahedra: 4, same: true, workers: true, passed: true };

/**
 * The tests.
 *
 * @param open returns the running browser
 * @param folders what the server serves, with the package at /gdel/
 */
export function testPages(open, folders) {
  async function inPage(t, headers, use) {
    const server = await serve(folders, { headers });
    const page = await open().newPage();
    t.after(() => {
      server.close();
      return page.close();
    });
    await page.goto(server.url);
    return use(page, server.url);
  }

  test('a policy that allows what is needed and nothing else', async (t) => {
    const policy =
      "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'";
    const found = await inPage(t, { 'content-security-policy': policy }, (page) =>
      page.evaluate(triangulated, '/gdel/index.js'),
    );
    assert.deepEqual(found, { ...RIGHT, thread: 'worker', whyThread: null, whyInlined: null });
  });

  test('a policy that forbids connections: the copies are scripts', async (t) => {
    const policy =
      "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'none'";
    const found = await inPage(t, { 'content-security-policy': policy }, (page) =>
      page.evaluate(triangulated, '/gdel/index.js'),
    );
    const { whyInlined, ...others } = found;
    assert.deepEqual(others, { ...RIGHT, thread: 'worker', whyThread: null });
    assert.equal(typeof whyInlined, 'string');
  });

  test('a sandboxed frame, whose origin is that of nobody', async (t) => {
    const headers = { 'access-control-allow-origin': '*' };
    const found = await inPage(t, headers, async (page, url) => {
      // What loads the frame may be answered before it is known that there is one.
      const navigated = page.waitForEvent('framenavigated', {
        predicate: (frame) => frame.parentFrame() && frame.url().startsWith(url),
      });
      await page.evaluate((url) => {
        const frame = document.createElement('iframe');
        frame.sandbox = 'allow-scripts';
        frame.src = url;
        document.body.append(frame);
        return new Promise((resolve) => (frame.onload = resolve));
      }, url);
      const frame = await navigated;
      assert.equal(await frame.evaluate(() => globalThis.origin), 'null');
      return frame.evaluate(triangulated, `${url}/gdel/index.js`);
    });
    const { whyInlined, ...others } = found;
    assert.deepEqual(others, { ...RIGHT, thread: 'worker', whyThread: null });
    assert.equal(typeof whyInlined, 'string');
  });

  test('arrays of a frame are as good as those of the page', async (t) => {
    const found = await inPage(t, {}, (page) =>
      page.evaluate(async () => {
        const { delaunay3d, delaunay3dSync, Delaunator, GdelError, load3d } = await import(
          '/gdel/index.js'
        );
        const frame = document.createElement('iframe');
        document.body.append(frame);
        const { Float64Array: There, AbortController: Controller } = frame.contentWindow;
        const points = There.of(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1);
        await Promise.all([load3d(), Delaunator.load()]);
        const { signal } = new Controller();
        const controller = new Controller();
        controller.abort();
        return [
          points instanceof Float64Array,
          (await delaunay3d(points)).tetrahedra.length,
          (await delaunay3d(points, { signal, transfer: true })).tetrahedra.length,
          points.length,
          delaunay3dSync(There.of(0, 0, 0)).dimension,
          new Delaunator(There.of(0, 0, 1, 0, 0, 1)).triangles.length,
          await delaunay3d([], { signal: controller.signal }).catch(
            (error) => error instanceof GdelError && error.code,
          ),
        ];
      }),
    );
    assert.deepEqual(found, [false, 4, 4, 0, 0, 3, 'ABORTED']);
  });
}
