// Makes the pictures of the examples, www/programs/NAME.webp, of the built page: of those that are named, or of all.
//
//   node www/scripts/pictures.mjs [NAME …]

import { readFileSync, writeFileSync } from 'node:fs';
import { launchChromium, WEBGPU_AND_WEBGL } from '../../tests/web/browsers.mjs';
import { serve } from '../tests/browser.mjs';

const programs = new URL('../programs/', import.meta.url);
const catalogue = JSON.parse(readFileSync(new URL('catalogue.json', programs)));
const names = process.argv.slice(2);

/** How long what moves has moved in its picture, in milliseconds. */
const MOVED = { collider: 6000, moving: 500 };

const server = await serve();
const browser = await launchChromium(WEBGPU_AND_WEBGL);
const viewport = { width: 1440, height: 900 };
const page = await browser.newPage({ viewport, reducedMotion: 'reduce' });
// Software compiles the GPU's code for a while.
page.setDefaultTimeout(120_000);

/** Cuts the middle out of a picture, and makes it a small WebP. */
function smaller(png) {
  return page.evaluate(async (png) => {
    const image = await createImageBitmap(
      await (await fetch(`data:image/png;base64,${png}`)).blob(),
    );
    const [width, height] = [480, 320];
    const scale = Math.max(width / image.width, height / image.height);
    const [w, h] = [width / scale, height / scale];
    const canvas = Object.assign(document.createElement('canvas'), { width, height });
    const context = canvas.getContext('2d');
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
  }, png.toString('base64'));
}

for (const { name, output } of catalogue) {
  if (names.length > 0 && !names.includes(name)) continue;
  await page.goto(`${server.url}examples/${name}/`);
  let shown = page.locator('.editor');
  if (!output) {
    await page.locator('main[data-state="done"]').waitFor();
    const frame = page.frameLocator('iframe');
    const pictures = frame.locator('svg, canvas, .leaflet-container');
    shown =
      (await pictures.count()) === 1 || name === 'contours'
        ? pictures.first()
        : frame.locator('body');
    await page.waitForTimeout(MOVED[name] ?? 0);
  }
  const picture = Buffer.from(await smaller(await shown.screenshot()), 'base64');
  writeFileSync(new URL(`${name}.webp`, programs), picture);
  console.log(`www/programs/${name}.webp: ${picture.length} bytes`);
}
await browser.close();
await server.close();
