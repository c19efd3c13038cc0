// What the first view may weigh. How long it takes is measured by benches/js/page.mjs.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { open } from './browser.mjs';
import { site } from './site.mjs';

const dist = fileURLToPath(new URL('../dist/', import.meta.url));

const here = site();

test('the first view takes less than 530 kB', async () => {
  const page = await open(here.browser, here.url);
  const counted = [...page.files].filter((path) => !/bunny|viewer|three/.test(path));
  const kilobytes = (path) =>
    gzipSync(readFileSync(dist + (path === '/' ? 'index.html' : path.slice(1)))).length / 1e3;
  let sum = 0;
  for (const path of counted.sort()) {
    console.log(`${kilobytes(path).toFixed(1).padStart(8)} kB ${path}`);
    sum += kilobytes(path);
  }
  console.log(`${sum.toFixed(1).padStart(8)} kB gzipped, without samples and three.js`);
  // Builds in different folders differ by up to 1 kB.
  assert.ok(sum < 530, `${sum} kB`);
});
