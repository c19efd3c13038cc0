// The GPU engine in Node, by the npm package `webgpu` (Dawn) on Chromium's software driver.

import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { test } from 'node:test';
import { fingerprint } from './fingerprints.mjs';
import { importFrom, pinned, project } from './package.mjs';

const swiftshader = '/usr/lib/chromium/vk_swiftshader_icd.json';
if (!process.env.VK_DRIVER_FILES && existsSync(swiftshader))
  process.env.VK_DRIVER_FILES = swiftshader;
const { create } = await import('webgpu');

test('the mesh is the native one; a run can be aborted', { timeout: 600_000 }, async () => {
  const { createEngine, generate } = await importFrom(project());
  const gpu = create([]);
  const engine = await createEngine({ gpu, engine: 'gpu' });
  assert.equal(engine.info.engine, 'gpu');
  assert.equal(engine.info.thread, 'caller');
  assert.match(engine.info.whyThread, /another thread/);
  const { kind, count, seed, fingerprint: expected } = pinned.find(({ count }) => count < 100);
  const points = await generate(kind, count, { seed });
  const mesh = await engine.delaunay3d(points);
  assert.equal(fingerprint(mesh.tetrahedra), expected);
  assert.equal(mesh.stats.engine, 'gpu');
  assert.equal(mesh.stats.why, null);
  assert.ok(mesh.stats.gpu.dispatches > 0);
  assert.ok(mesh.stats.adapter.maxStorageBufferBindingSize >= 128 * 2 ** 20);

  const controller = new AbortController();
  const run = engine.delaunay3d(points, {
    signal: controller.signal,
    onProgress: () => controller.abort(),
  });
  await assert.rejects(run, { code: 'ABORTED' });
  engine.dispose();
  await assert.rejects(engine.delaunay3d(points), { code: 'DISPOSED' });
});
