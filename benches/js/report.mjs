// Runs the page report/ in Chromium, and prints its report.
//
//   node benches/js/report.mjs [POINTS,…]

import { fileURLToPath } from 'node:url';
import { launchChromium, WEBGPU } from '../../tests/web/browsers.mjs';
import { serve } from '../../tests/web/server.mjs';

const [points] = process.argv.slice(2);
const server = await serve({
  '/page/': fileURLToPath(new URL('../../www/dist/', import.meta.url)),
});
const browser = await launchChromium(WEBGPU);
try {
  const page = await browser.newPage();
  page.setDefaultTimeout(0);
  await page.goto(`${server.url}/page/report/index.html${points ? `?points=${points}` : ''}`);
  await page.click('#run');
  await page.locator('#block', { hasText: '\nresult: ' }).waitFor();
  console.log(await page.locator('#block').textContent());
} finally {
  await browser.close();
  server.close();
}
