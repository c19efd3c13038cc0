// The parts of the page that work without one. They are TypeScript, which Vite loads as it does for
// the page.

import { readdirSync } from 'node:fs';
import { after } from 'node:test';
import { fileURLToPath } from 'node:url';
import { createServer } from 'vite';

const server = await createServer({
  root: fileURLToPath(new URL('../', import.meta.url)),
  appType: 'custom',
  logLevel: 'error',
  optimizeDeps: { noDiscovery: true },
  server: { middlewareMode: true, hmr: false, ws: false, watch: null },
});
const files = readdirSync(new URL('unit/', import.meta.url)).filter((name) =>
  name.endsWith('.test.ts'),
);
for (const file of files) await server.ssrLoadModule(`/tests/unit/${file}`);
// Tests load parts of the package when they first need them.
after(() => server.close());
