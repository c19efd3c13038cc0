import { CacheFirst, ExpirationPlugin, type PrecacheEntry, Serwist } from 'serwist';

declare global {
  interface Window {
    /** The files of the page with their revisions, which the build writes here. */
    __SW_MANIFEST: (PrecacheEntry | string)[];
  }
}

// After the first visit, the page works without a connection. A new version is fetched whole in the
// background, and shown from the next visit on.
new Serwist({
  precacheEntries: self.__SW_MANIFEST,
  precacheOptions: { cleanupOutdatedCaches: true, ignoreURLParametersMatching: [/^url$/] },
  runtimeCaching: [
    {
      matcher: ({ sameOrigin, url }) => sameOrigin && url.pathname.endsWith('.gz'),
      handler: new CacheFirst({ cacheName: 'samples' }),
    },
    {
      // Libraries and files of examples, whose names change with their contents.
      matcher: ({ sameOrigin, url }) => sameOrigin && url.pathname.includes('/assets/'),
      handler: new CacheFirst({
        cacheName: 'examples',
        plugins: [new ExpirationPlugin({ maxEntries: 60 })],
      }),
    },
  ],
}).addEventListeners();
