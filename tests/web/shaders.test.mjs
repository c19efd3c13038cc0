// Chromium's compiler takes every kernel. It is stricter than the one of wgpu about where barriers may stand.

import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import { create, globals } from 'webgpu';
import { root } from './package.mjs';
import { assemble } from './predicates.mjs';

Object.assign(globalThis, globals);
// Kept until the end: Dawn does not survive its instance.
const gpu = create(['backend=null']);

test('every kernel is valid', async () => {
  const adapter = await gpu.requestAdapter();
  const device = await adapter.requestDevice();
  const files = readdirSync(`${root}/shaders`, { recursive: true })
    .filter((path) => path.endsWith('.wgsl'))
    .map((path) => `shaders/${path.replaceAll('\\', '/')}`)
    .filter((path) => readFileSync(`${root}/${path}`, 'utf8').includes('@compute'));
  assert.ok(files.length > 30, `${files}`);
  for (const file of files) {
    // The kernels outside the folders of the dimensions are for both.
    const dimensions = file.match(/^shaders\/(d[23])\//)?.slice(1) ?? ['d2', 'd3'];
    for (const dim of dimensions) {
      for (const width of ['narrow', 'wide']) {
        const module = device.createShaderModule({ code: assemble(file, { width, dim }) });
        const { messages } = await module.getCompilationInfo();
        assert.deepEqual(
          messages.map(
            ({ lineNum, message }) => `${file}, ${dim}, ${width}, ${lineNum}: ${message}`,
          ),
          [],
        );
      }
    }
  }
  device.destroy();
});
