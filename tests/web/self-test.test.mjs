// Whether a GPU has to compute known meshes before it is used: in Chromium, with a device that numbers neighbours
// wrongly, in the worker of a triangulator.

import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { launchChromium, WEBGPU } from './browsers.mjs';
import { like } from './like.mjs';
import { dist, project } from './package.mjs';
import { serve } from './server.mjs';

const browser = await launchChromium(WEBGPU);
const server = await serve({ '/gdel/': dist(project()) });
after(async () => {
  await browser.close();
  server.close();
});

/** Runs in the worker: replaces its GPU by one that is wrong, and is described so. */
function breakGpu({ description, isFallbackAdapter }, like) {
  const { gpu } = navigator;
  const info = { vendor: 'a', architecture: 'b', device: 'c', description, isFallbackAdapter };
  const createShaderModule = (device) => (descriptor) => {
    const isEdited = descriptor.label === 'd3/mesh_compact';
    const code = isEdited ? descriptor.code.replaceAll('~3', '~7') : descriptor.code;
    if (isEdited && code === descriptor.code) throw new Error('there is nothing to edit');
    return device.createShaderModule({ ...descriptor, code });
  };
  const broken = {
    async requestAdapter(options) {
      const adapter = await gpu.requestAdapter(options);
      const requestDevice = async (descriptor) => {
        const device = await adapter.requestDevice(descriptor);
        return like(device, { adapterInfo: info, createShaderModule: createShaderModule(device) });
      };
      return like(adapter, { info, requestDevice });
    },
  };
  Object.defineProperty(navigator, 'gpu', { value: broken });
}

/** Opens the wrong device with these options. Returns the code and the message of the error, if there is one. */
async function open(options, { isSoftware = false } = {}) {
  const info = { description: 'GPU', isFallbackAdapter: isSoftware };
  const context = await browser.newContext();
  await context.route('**/worker-3d.js', async (route) => {
    const response = await route.fetch();
    const body = `(${breakGpu})(${JSON.stringify(info)}, ${like});${await response.text()}`;
    await route.fulfill({ response, body });
  });
  const page = await context.newPage();
  await page.goto(server.url);
  const found = await page.evaluate(async (options) => {
    const { createTriangulator } = await import('/gdel/index.js');
    try {
      const { info } = await createTriangulator({ backend: 'gpu', ...options });
      return { thread: info.thread, software: info.adapter.software };
    } catch ({ code, message }) {
      return { code, message };
    }
  }, options);
  await context.close();
  return found;
}

test('hardware that is wrong is noticed, unless nobody wants to know', async () => {
  const { code, message } = await open({});
  assert.equal(code, 'GPU_WRONG');
  assert.match(message, /grid/);
  assert.deepEqual(await open({ selfTest: false }), { thread: 'worker', software: false });
});

test('software is tested if somebody wants to know', async () => {
  const isSoftware = true;
  assert.deepEqual(await open({}, { isSoftware }), { thread: 'worker', software: true });
  assert.equal((await open({ selfTest: true }, { isSoftware })).code, 'GPU_WRONG');
});
