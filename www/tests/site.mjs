import { after, before } from 'node:test';
import { launch, serve } from './browser.mjs';

/**
 * Serves the page and starts a browser before the tests of a file or a group, and ends both after
 * them. The properties of the result are there while the tests run, and for what has to be prepared
 * for them: hooks beside each other do not wait for each other.
 */
export function site(options, prepare = () => {}) {
  const all = { url: '', browser: null };
  let server;
  before(async () => {
    server = await serve();
    all.url = server.url;
    all.browser = await launch(options);
    await prepare(all);
  });
  after(async () => {
    await all.browser?.close();
    await server.close();
  });
  return all;
}
