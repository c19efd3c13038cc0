import { after, before } from 'node:test';
import { launch, serve } from './browser.mjs';

/**
 * Serves the page and starts a browser before the tests of a file or a group, and ends both after
 * them. The properties of the result are there while the tests run.
 */
export function site(options) {
  const all = { url: '', browser: null };
  let server;
  before(async () => {
    server = await serve();
    all.url = server.url;
    all.browser = await launch(options);
  });
  after(async () => {
    await all.browser?.close();
    await server.close();
  });
  return all;
}
