// The predicates in WGSL, as Chromium compiles them for SwiftShader, against big integers.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launchChromium, WEBGPU } from './browsers.mjs';
import { assemble, buffers, cases, exactSigns, families } from './predicates.mjs';
import { serve } from './server.mjs';

/** Of each family, dimension and width. */
const CASES = 3000;

let browser, server, page;
before(async () => {
  server = await serve({});
  browser = await launchChromium(WEBGPU);
  page = await browser.newPage();
  await page.goto(server.url);
  await page.evaluate(async () => {
    const adapter = await navigator.gpu.requestAdapter();
    globalThis.device = await adapter.requestDevice();
  });
});
after(async () => {
  await browser.close();
  server.close();
});

/** Compiles the kernel in the page. */
function compile(wgsl) {
  return page.evaluate(async (code) => {
    const module = device.createShaderModule({ code });
    const { messages } = await module.getCompilationInfo();
    const errors = messages
      .filter(({ type }) => type === 'error')
      .map(({ lineNum, message }) => `${lineNum}: ${message}`);
    if (errors.length) throw new Error(errors.join('\n'));
    globalThis.pipeline = await device.createComputePipelineAsync({
      layout: 'auto',
      compute: { module },
    });
  }, wgsl);
}

/** Runs it on as many cases: all their signs, from these buffers. */
function signs(inputs, cases, count) {
  return page.evaluate(
    async ({ inputs, cases, count }) => {
      const { STORAGE, COPY_DST, COPY_SRC, MAP_READ } = GPUBufferUsage;
      const buffers = inputs.map((words) => {
        // Values above 2³¹ wrap around.
        const content = Int32Array.from(words, (word) => word | 0);
        const buffer = device.createBuffer({ size: content.byteLength, usage: STORAGE | COPY_DST });
        device.queue.writeBuffer(buffer, 0, content);
        return buffer;
      });
      const result = device.createBuffer({ size: 4 * count, usage: STORAGE | COPY_SRC });
      const staging = device.createBuffer({ size: 4 * count, usage: MAP_READ | COPY_DST });
      const entries = [...buffers, result].map((buffer, binding) => ({
        binding,
        resource: { buffer },
      }));
      const encoder = device.createCommandEncoder();
      const pass = encoder.beginComputePass();
      pass.setPipeline(pipeline);
      pass.setBindGroup(
        0,
        device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries }),
      );
      pass.dispatchWorkgroups(Math.ceil(cases / 256));
      pass.end();
      encoder.copyBufferToBuffer(result, 0, staging, 0, 4 * count);
      device.queue.submit([encoder.finish()]);
      await staging.mapAsync(GPUMapMode.READ);
      const found = Array.from(new Int32Array(staging.getMappedRange()));
      for (const buffer of [...buffers, result, staging]) buffer.destroy();
      return found;
    },
    { inputs, cases, count },
  );
}

for (const dimension of [3, 2]) {
  for (const width of ['narrow', 'wide']) {
    test(`in dimension ${dimension}, ${width} signs are exact`, { timeout: 900_000 }, async () => {
      await compile(assemble(`tests/shaders/d${dimension}_predicates.wgsl`, { width }));
      for (const family of families) {
        const all = cases(family, dimension, width, CASES);
        const each = dimension === 3 ? 7 : 5;
        const found = await signs(buffers(all, dimension, width), CASES, each * CASES);
        const zeros = { orientation: 0, inSphere: 0 };
        const open = { orientation: 0, inSphere: 0 };
        for (const [i, vertices] of all.entries()) {
          // In 2D there is one filter.
          const [
            orientExact,
            orient,
            inSphere,
            orientFilter,
            inSphereFilter,
            orientRefined = 0,
            inSphereRefined = 0,
          ] = found.slice(each * i, each * i + each);
          const expected = exactSigns(vertices);
          const what = () =>
            `${family}, case ${i}: ${vertices.map(({ position, index }) => `${position} (${index})`).join('; ')}`;
          assert.equal(orientExact, expected.orientation, `orient_exact, ${what()}`);
          assert.ok(
            expected.leaning ? orient === expected.leaning : Math.abs(orient) === 1,
            `orientation, ${what()}`,
          );
          assert.ok(
            orientFilter === 0 || orientFilter === expected.orientation,
            `orient_filter, ${what()}`,
          );
          assert.ok(
            orientRefined === 0 || orientRefined === expected.orientation,
            `orient_refined, ${what()}`,
          );
          assert.ok(
            expected.broken ? inSphere === expected.broken : Math.abs(inSphere) === 1,
            `in-sphere, ${what()}`,
          );
          assert.ok(
            inSphereFilter === 0 || inSphereFilter === expected.inSphere,
            `insphere_filter, ${what()}`,
          );
          assert.ok(
            inSphereRefined === 0 || inSphereRefined === expected.inSphere,
            `insphere_refined, ${what()}`,
          );
          zeros.orientation += expected.orientation === 0;
          open.orientation += orientFilter === 0;
          zeros.inSphere += expected.inSphere === 0;
          open.inSphere += inSphereFilter === 0;
        }
        console.log(
          `${dimension}D ${width} ${family}: of ${CASES}, zeros ${JSON.stringify(zeros)}, open after the filter ${JSON.stringify(open)}`,
        );
        // The families are what they say: degenerate ones have zeros, and ones that are nearly zero.
        if (family === 'uniform')
          assert.ok(open.orientation < CASES / 50 && open.inSphere < CASES / 50);
        if (['corners', 'smallGrid', 'collinear'].includes(family))
          assert.ok(zeros.orientation > CASES / 20 && zeros.inSphere > CASES / 20);
        if (family === 'flat')
          assert.ok(zeros.orientation > CASES / 4 && open.orientation > zeros.orientation);
        if (family === 'cospherical')
          assert.ok(zeros.inSphere > CASES / 4 && open.inSphere > zeros.inSphere);
      }
    });
  }
}
