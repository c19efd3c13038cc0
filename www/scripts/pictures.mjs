// Makes the pictures of the examples, www/programs/NAME.webp, of the built page: of those that are named, or of all.
//
//   node www/scripts/pictures.mjs [NAME …]

import { readFileSync, writeFileSync } from 'node:fs';
import { launchChromium, WEBGPU_AND_WEBGL } from '../../tests/web/browsers.mjs';
import { serve } from '../tests/browser.mjs';

const programs = new URL('../programs/', import.meta.url);
const catalogue = JSON.parse(readFileSync(new URL('catalogue.json', programs)));
const names = process.argv.slice(2);

/** What there is to see by then where that comes after the code has run. */
const LATER = {
  collider: (frame) => frame.locator('p', { hasText: /, 2\d of 80/ }),
  deck: (frame) => frame.locator('[data-drawn]'),
  moving: (frame) => frame.locator('p', { hasText: /\d\d updates/ }),
  react: (frame) => frame.locator('polygon').nth(23),
  svelte: (frame) => frame.locator('polygon').nth(23),
};

/** Those of which the code is shown: they have words to show. */
const WORDS = ['node', 'worker'];

const server = await serve();
const browser = await launchChromium(WEBGPU_AND_WEBGL);
const viewport = { width: 1440, height: 900 };
const page = await browser.newPage({ viewport, reducedMotion: 'reduce' });
// Software compiles the GPU's code for a while.
page.setDefaultTimeout(120_000);

/** Makes a picture a small WebP: its middle, or all of it. */
function smaller(png, all) {
  return page.evaluate(
    async ([png, all]) => {
      const image = await createImageBitmap(
        await (await fetch(`data:image/png;base64,${png}`)).blob(),
      );
      const [width, height] = [480, 320];
      const scale = Math[all ? 'min' : 'max'](width / image.width, height / image.height);
      const [w, h] = [width / scale, height / scale];
      const canvas = Object.assign(document.createElement('canvas'), { width, height });
      const context = canvas.getContext('2d');
      context.fillStyle = '#fcfbf8';
      context.fillRect(0, 0, width, height);
      context.imageSmoothingQuality = 'high';
      context.drawImage(
        image,
        (image.width - w) / 2,
        (image.height - h) / 2,
        w,
        h,
        0,
        0,
        width,
        height,
      );
      return canvas.toDataURL('image/webp', 0.72).split(',')[1];
    },
    [png.toString('base64'), all],
  );
}

for (const { name } of catalogue) {
  if (names.length > 0 && !names.includes(name)) continue;
  await page.goto(`${server.url}examples/${name}/`);
  const frame = page.frameLocator('iframe');
  if (name !== 'node') await page.locator('main[data-state="done"]').waitFor();
  await LATER[name]?.(frame).waitFor();
  const drawing = frame.locator('svg, canvas, .leaflet-container').first();
  const shown = WORDS.includes(name) ? page.locator('.editor') : drawing;
  const all = name === 'natural';
  const png = await (all ? frame.locator('body') : shown).screenshot();
  const picture = Buffer.from(await smaller(png, all), 'base64');
  writeFileSync(new URL(`${name}.webp`, programs), picture);
  console.log(`www/programs/${name}.webp: ${picture.length} bytes`);
}
await browser.close();
await server.close();
