// Chromium's compiler takes every kernel. It is stricter than the one of wgpu about where barriers may stand.

import assert from 'node:assert/strict';
import { readdirSync } from 'node:fs';
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
  const files = readdirSync(`${root}/shaders`, { recursive: true }).filter((path) =>
    /^(plane.)?\w+\.wgsl$/.test(path),
  );
  assert.ok(files.length > 30, `${files}`);
  for (const file of files) {
    for (const width of ['narrow', 'wide']) {
      const module = device.createShaderModule({ code: assemble(`shaders/${file}`, width) });
      const { messages } = await module.getCompilationInfo();
      assert.deepEqual(
        messages.map(({ lineNum, message }) => `${file}, ${width}, ${lineNum}: ${message}`),
        [],
      );
    }
  }
  device.destroy();
});
