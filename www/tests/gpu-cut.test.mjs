// The cut that the GPU finds which draws, in Chromium with WebGPU on SwiftShader: what is seen is
// what the worker finds, and the plane moves without the worker.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import {
  choose,
  colorBy,
  drop,
  generate,
  launch,
  open,
  pictureOf,
  save,
  serve,
  settled,
  shown,
  slide,
  tab,
  text,
  until,
} from './browser.mjs';

let server;
let browser;
before(async () => {
  server = await serve();
  browser = await launch();
});
after(async () => {
  await browser.close();
  await server.close();
});

/** Has the page count what it asks of the GPU, and hold what workers answer while it is asked to. */
function watch(context) {
  return context.addInitScript(() => {
    const counts = { dispatches: 0, draws: 0, readbacks: 0 };
    const wrap = (of, method, before) => {
      const original = of.prototype[method];
      of.prototype[method] = function (...args) {
        before(this, args);
        return original.apply(this, args);
      };
    };
    wrap(GPUComputePassEncoder, 'dispatchWorkgroups', () => counts.dispatches++);
    wrap(GPURenderPassEncoder, 'drawIndirect', (_, [buffer]) => {
      counts.draws++;
      globalThis.drawn = buffer;
    });
    wrap(GPUBuffer, 'mapAsync', () => counts.readbacks++);
    wrap(GPUQueue, 'submit', (queue) => (globalThis.queue = queue));
    wrap(GPUDevice, 'createBuffer', (device) => (globalThis.device = device));
    wrap(Worker, 'addEventListener', (_, args) => {
      const [type, listener] = args;
      if (type !== 'message') return;
      args[1] = (event) =>
        globalThis.held ? globalThis.held.push(() => listener(event)) : listener(event);
    });
    globalThis.counts = counts;
  });
}

/** Leaves the cut to the worker. */
const withoutKernels = (context) =>
  context.addInitScript(() => {
    GPUDevice.prototype.createComputePipelineAsync = () => Promise.reject(new Error('no kernels'));
  });

/** Waits until the page shows a cut that the GPU has found. */
async function onGpu(page) {
  await page.locator('#stage[data-cut="GPU"]').waitFor({ state: 'attached' });
  await page.evaluate(
    () => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))),
  );
}

/** How many triangles the GPU has drawn last, as it says. */
const trianglesDrawn = (page) =>
  page.evaluate(async () => {
    const staging = device.createBuffer({ size: 4, usage: 9 });
    const encoder = device.createCommandEncoder();
    encoder.copyBufferToBuffer(drawn, 0, staging, 0, 4);
    queue.submit([encoder.finish()]);
    await staging.mapAsync(1);
    return new Uint32Array(staging.getMappedRange())[0] / 3;
  });

/** What the page saves of what it shows. */
async function saved(page, format) {
  const folder = mkdtempSync(join(tmpdir(), 'gdel-cut-'));
  try {
    await tab(page, 'use');
    const file = readFileSync((await save(page, format, folder))[0]);
    await tab(page, 'view');
    return file;
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** How many triangles the page saves of what it shows: the worker's. */
async function trianglesSaved(page) {
  const file = await saved(page, 'GLB');
  const { meshes, accessors } = JSON.parse(file.toString('utf8', 20, 20 + file.readUInt32LE(12)));
  return accessors[meshes[0].primitives[0].attributes.POSITION].count / 3;
}

/** The drawing as the page draws it now: the browser may show it later. */
const drawing = (page) => saved(page, 'PNG');

/**
 * The share of the pixels in which two pictures may differ: where two triangles are equally far
 * away, the one that is drawn first is seen, and the GPU lists them in no order.
 */
const TIES = 1e-4;

/** The share of the pixels in which two pictures differ. */
const differing = (page, ...pictures) =>
  page.evaluate(
    async (pictures) => {
      const [one, other] = await Promise.all(
        pictures.map(async (picture) => {
          const bytes = Uint8Array.from(atob(picture), (character) => character.charCodeAt(0));
          const image = await createImageBitmap(new Blob([bytes]));
          const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
          context.drawImage(image, 0, 0);
          return new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer);
        }),
      );
      return one.reduce((sum, pixel, i) => sum + Number(pixel !== other[i]), 0) / one.length;
    },
    pictures.map((picture) => picture.toString('base64')),
  );

/** Shows or hides a layer. */
async function layer(page, name, isShown) {
  await tab(page, 'view');
  await page.getByLabel(name, { exact: true }).setChecked(isShown);
  await settled(page);
}

describe('the GPU and the worker', () => {
  /** One page that cuts on the GPU, and one whose worker does. */
  let pages;
  before(async () => {
    pages = await Promise.all([
      open(browser, server.url, {}, watch),
      open(browser, server.url, {}, withoutKernels),
    ]);
    // Their opacity depends on when the fonts have come.
    for (const page of pages) await layer(page, 'Points that are cut away', false);
  });
  after(() => Promise.all(pages.map((page) => page.context().close())));

  /** Does the same on both pages, and expects both to show the same. */
  async function expectTheSame(what, act = () => {}) {
    for (const page of pages) await act(page);
    await onGpu(pages[0]);
    assert.equal(await pages[1].locator('#stage').getAttribute('data-cut'), 'worker');
    const [one, other] = await Promise.all(pages.map(drawing));
    const share = await differing(pages[0], one, other);
    if (share > TIES) await Promise.all(pages.map((page, i) => pictureOf(page, `cut-${i}`)));
    assert.ok(share <= TIES, `${what}: ${share} of the pixels differ`);
    const texts = ['shown', 'legend-title', 'legend-low', 'legend-high', 'alpha-value'];
    for (const id of texts)
      assert.equal(await text(pages[0], id), await text(pages[1], id), `${what}: ${id}`);
    return one;
  }

  test('show the same of the bunny, carved and cut', async () => {
    const pictures = [
      await expectTheSame('at first'),
      await expectTheSame('cut', (page) => slide(page, 'keep', 0.3)),
      await expectTheSame('whole', (page) => slide(page, 'keep', 1)),
      await expectTheSame('cut away', (page) => slide(page, 'keep', 0)),
      await expectTheSame('carved less', async (page) => {
        await slide(page, 'keep', 0.6);
        await choose(page, 'mode', 'solid');
        await slide(page, 'alpha', 0.8);
      }),
      await expectTheSame('not carved', (page) => slide(page, 'alpha', 1)),
      await expectTheSame('by volume', (page) => colorBy(page, 'volume')),
      await expectTheSame('by volume in other colours', async (page) => {
        await page.selectOption('#map', 'magma');
        await settled(page);
      }),
      await expectTheSame('cut towards the viewer', async (page) => {
        await page.click('#face');
        await settled(page);
      }),
    ];
    const different = new Set(pictures.map((picture) => picture.toString('base64')));
    assert.equal(different.size, pictures.length);
    for (const page of pages) assert.deepEqual(page.problems, []);
  });

  test('name the same tetrahedron under the pointer', async () => {
    const tips = [];
    for (const page of pages) {
      const { x, y, width, height } = await page.locator('#canvas').boundingBox();
      await page.mouse.move(x + 0.5 * width, y + 0.55 * height);
      await page.locator('#tip').waitFor();
      tips.push(await text(page, 'tip'));
      await page.mouse.move(1, 1);
    }
    assert.match(tips[0], /tetrahedron.*vertices/);
    assert.equal(tips[0], tips[1]);
  });

  test('count the same triangles', async () => {
    const [page] = pages;
    for (const keep of [0.2, 0.7]) {
      await slide(page, 'keep', keep);
      const count = await trianglesDrawn(page);
      assert.ok(count > 100);
      assert.equal(count, await trianglesSaved(page));
    }
  });

  test('show the same of points with colours, and after other drawings', async () => {
    let state = 1;
    // Lehmer's generator: no four of its points lie in a plane.
    const random = () => (state = (48_271 * state) % 2_147_483_647) / 2_147_483_647;
    const rows = Array.from({ length: 400 }, (_, i) =>
      [random(), random(), random(), i % 256, (3 * i) % 256, 90].join(' '),
    );
    await expectTheSame('in colours', (page) =>
      drop(page, 'colours.xyz', Buffer.from(rows.join('\n'))),
    );
    await expectTheSame('after pieces', async (page) => {
      await choose(page, 'mode', 'explode');
      await slide(page, 'apart', 0.5);
      assert.equal(await page.locator('#stage').getAttribute('data-cut'), 'worker');
      await slide(page, 'apart', 0);
    });
    await expectTheSame('after Voronoi cells', async (page) => {
      await page.check('#voronoi');
      await settled(page);
      assert.equal(await page.locator('#stage').getAttribute('data-cut'), 'worker');
      await page.uncheck('#voronoi');
      await settled(page);
    });
    await expectTheSame('without own colours', (page) =>
      layer(page, 'Outside in the file’s colours', false),
    );
    await expectTheSame('without tetrahedra', (page) => layer(page, 'Tetrahedra', false));
    for (const page of pages) assert.deepEqual(page.problems, []);
  });
});

test('the plane moves in one frame, without the worker and without reading anything', async () => {
  const page = await open(browser, `${server.url}#points=uniform_3000_1`, {}, watch);
  await onGpu(page);
  await settled(page);
  const before = await drawing(page);
  const counts = await page.evaluate(async () => {
    globalThis.held = [];
    Object.assign(counts, { dispatches: 0, draws: 0, readbacks: 0 });
    const slider = document.querySelector('#keep');
    slider.value = '0.25';
    slider.dispatchEvent(new Event('input', { bubbles: true }));
    await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
    return { ...counts };
  });
  assert.deepEqual(counts, { dispatches: 1, draws: 1, readbacks: 0 });
  // The worker has said nothing yet, and the picture is already that of the place where the plane is.
  const count = await trianglesDrawn(page);
  const early = await drawing(page);
  assert.ok(!early.equals(before));
  const { shown: old } = await shown(page);
  await page.evaluate(() => {
    const all = globalThis.held;
    globalThis.held = null;
    for (const tell of all) tell();
  });
  await settled(page);
  assert.ok((await shown(page)).shown < old);
  assert.ok((await drawing(page)).equals(early));
  assert.equal(count, await trianglesSaved(page));
  // What the worker says is no reason to search again.
  assert.equal(await page.evaluate(() => counts.dispatches), 1);
  // Many moves in a row end where the last one is.
  const values = [0.3, 0.9, 0.5, 0.7, 0.25];
  await page.evaluate((values) => {
    const slider = document.querySelector('#keep');
    for (const value of values) {
      slider.value = String(value);
      slider.dispatchEvent(new Event('input', { bubbles: true }));
    }
  }, values);
  await settled(page);
  assert.ok((await drawing(page)).equals(early));
  assert.deepEqual(page.problems, []);
  await page.context().close();
});

test('other points come to the GPU, too, and the memory of the old ones goes', async () => {
  const page = await open(browser, `${server.url}#points=uniform_1000_1`, {}, async (context) => {
    await watch(context);
    await context.addInitScript(() => {
      globalThis.alive = 0;
      const labels = [
        'tetrahedra',
        'neighbors',
        'heights',
        'filtered',
        'values',
        'positions',
        'colors',
      ];
      const { createBuffer } = GPUDevice.prototype;
      GPUDevice.prototype.createBuffer = function (descriptor) {
        const buffer = createBuffer.call(this, descriptor);
        if (labels.includes(descriptor.label)) {
          globalThis.alive++;
          const destroy = buffer.destroy.bind(buffer);
          buffer.destroy = () => {
            globalThis.alive--;
            destroy();
          };
        }
        return buffer;
      };
    });
  });
  await onGpu(page);
  assert.equal(await page.evaluate(() => alive), 7);
  for (const count of [500, 800]) {
    await generate(page, 'ball', count);
    await onGpu(page);
    assert.match(await text(page, 'count'), new RegExp(`^${count} points`));
    assert.equal(await trianglesDrawn(page), await trianglesSaved(page));
    assert.equal(await page.evaluate(() => alive), 7);
  }
  // The live mode draws what it gets, and then the mesh is there again.
  await tab(page, 'points');
  const count = await trianglesDrawn(page);
  await page.click('#live');
  await until(page, () => /moving points/.test(document.querySelector('#count').textContent));
  await page.evaluate(() => (counts.draws = 0));
  await page.click('#live');
  await settled(page);
  await onGpu(page);
  assert.ok(await page.evaluate(() => counts.draws > 0));
  assert.equal(await trianglesDrawn(page), count);
  assert.equal(await page.evaluate(() => alive), 7);
  assert.deepEqual(page.problems, []);
  await page.context().close();
});
