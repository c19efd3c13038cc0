// Makes the pictures of the gallery, src/gallery/*.webp, that of links to the page,
// public/preview.jpg, and the icon for home screens, from the built page itself:
// `node www/scripts/gallery.mjs` after `npm run build:demo`. Build again afterwards.

import { writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { launch, open, serve } from '../tests/browser.mjs';
import { converted } from './converted.mjs';

const NAMES = ['bunny', 'terrain', 'sponge', 'gear', 'knot', 'shell', 'gyroid', 'fullerene'];
const file = (path) => fileURLToPath(new URL(`../${path}`, import.meta.url));

const server = await serve();
const browser = await launch({ webgpu: false });
/** A drawing without anything around it, as PNG. */
async function drawing(hash, width, height, omitBackground) {
  const page = await open(browser, `${server.url}#${hash}&embed=1`, {
    viewport: { width, height },
    deviceScaleFactor: 2,
  });
  await page.addStyleTag({
    content: `.dock, #reset, #measure { display: none !important }
      ${omitBackground ? '* { background: transparent !important }' : ''}`,
  });
  await page.evaluate(() => new Promise((done) => setTimeout(done, 1000)));
  const png = await page.screenshot({ omitBackground });
  await page.context().close();
  return png;
}

for (const name of process.argv.length > 2 ? process.argv.slice(2) : NAMES) {
  const png = await drawing(`points=${name}&keep=0.75&layers=simplices_skin`, 240, 180, true);
  const picture = await converted(browser, png, 240, 180, 'image/webp', 0.82);
  writeFileSync(file(`src/gallery/${name}.webp`), picture);
  console.log(`src/gallery/${name}.webp: ${picture.length} bytes`);
}
const preview = await drawing('points=bunny', 1200, 630, false);
writeFileSync(
  file('public/preview.jpg'),
  await converted(browser, preview, 1200, 630, 'image/jpeg', 0.85),
);
const page = await browser.newPage({ viewport: { width: 512, height: 512 } });
await page.goto(`${server.url}icon.svg`);
writeFileSync(file('public/icon-512.png'), await page.screenshot({ omitBackground: true }));
await browser.close();
await server.close();
