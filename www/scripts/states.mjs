// Makes the pictures of the page's states in the documents, docs/page.png and docs/page/*.webp, from
// the built page: `node www/scripts/states.mjs [NAME…]` after `npm run build:demo`. The one of an
// airborne scan needs a file that is not in the repository: `SCAN=file.las`.

import { readFileSync, writeFileSync } from 'node:fs';
import { basename } from 'node:path';
import { fileURLToPath } from 'node:url';
import {
  choose,
  drop,
  launch,
  open,
  openOnPhone,
  serve,
  settled,
  slide,
  text,
} from '../tests/browser.mjs';
import { bracket, terrestrial, xyz } from '../tests/models.mjs';
import { converted } from './converted.mjs';

const VIEWPORT = { width: 1200, height: 750 };
const PHONE = { width: 390, height: 844 };
const { SCAN } = process.env;

const server = await serve();
const browser = await launch({ webgpu: false });
const desk = (hash, options) =>
  open(browser, `${server.url}#${hash}`, { viewport: VIEWPORT, ...options });

/** Opens the page in each state. */
const STATES = {
  cut: () => desk('points=bunny'),
  exploded: async () => {
    const page = await desk('points=bunny');
    await choose(page, 'mode', 'explode');
    await slide(page, 'apart', 0.35);
    return page;
  },
  scan: async () => {
    const page = await desk('points=bunny');
    await drop(page, basename(SCAN), readFileSync(SCAN));
    return page;
  },
  street: async () => {
    const page = await desk('points=bunny');
    const points = terrestrial();
    await drop(page, 'street.pts', `${points.length}\n${xyz(points)}`);
    return page;
  },
  cad: async () => {
    const page = await desk('points=bunny');
    await drop(page, 'bracket.stl', bracket());
    return page;
  },
  voronoi: () =>
    desk('points=ball_2000_1&keep=0.6&apart=0.3&layers=simplices_edges_points_voronoi_skin'),
  plane: () => desk('dim=2'),
  story: async () => {
    const page = await desk('points=knot');
    await page.click('#help');
    return page;
  },
  dark: () => desk('points=gear', { colorScheme: 'dark' }),
  phone: () => openOnPhone(browser, `${server.url}#points=terrain`),
  side: () =>
    openOnPhone(browser, `${server.url}#points=shell`, {
      viewport: { width: PHONE.height, height: PHONE.width },
    }),
};

const file = (path) => fileURLToPath(new URL(`../../docs/${path}`, import.meta.url));
const asked = process.argv.slice(2);
for (const [name, show] of Object.entries(STATES)) {
  if (asked.length > 0 && !asked.includes(name)) continue;
  if (name === 'scan' && !SCAN) continue;
  const page = await show();
  await settled(page);
  // What opens the panel for tests is not what visitors see.
  for (const fold of await page.locator('.fold').all())
    await fold.evaluate((details) => (details.open = false));
  const { width, height } = page.viewportSize();
  const png = await page.screenshot({ animations: 'disabled' });
  writeFileSync(
    file(`page/${name}.webp`),
    await converted(browser, png, width, height, 'image/webp', 0.85),
  );
  if (name === 'cut') writeFileSync(file('page.png'), png);
  console.log(`docs/page/${name}.webp: ${await text(page, 'count')}`);
  await page.context().close();
}
await browser.close();
await server.close();
