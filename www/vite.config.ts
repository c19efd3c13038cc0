import { readdirSync, readFileSync } from 'node:fs';
import { serwist } from '@serwist/vite';
import { defineConfig } from 'vite';

// The page links to the documents where the package says that they are.
const { repository, version } = JSON.parse(
  readFileSync(new URL('../web/package.json', import.meta.url), 'utf8'),
);
process.env.VITE_VERSION = version;
process.env.VITE_REPOSITORY = repository.url.replace(/^git\+|\.git$/g, '');

/** The pages that Eleventy makes: see site/eleventy.config.mjs. */
const pages = ['api', 'benchmarks', 'examples', 'guide'].flatMap((folder) =>
  readdirSync(new URL(folder, import.meta.url), { recursive: true, encoding: 'utf8' })
    .filter((file) => file.endsWith('.html'))
    .map((file) => `${folder}/${file}`),
);

export default defineConfig({
  // Relative addresses: the page works from any folder of any host.
  base: './',
  worker: { format: 'es' },
  build: {
    target: 'es2023',
    chunkSizeWarningLimit: 900,
    rolldownOptions: {
      input: ['index.html', 'report/index.html', 'treemap/index.html', ...pages],
    },
  },
  server: { fs: { allow: ['..'] } },
  plugins: [
    serwist({
      swSrc: 'src/offline.worker.ts',
      swDest: 'offline.js',
      globDirectory: 'dist',
      globPatterns: ['**/*.{html,js,json,css,wasm,svg,webp,woff2,gz,webmanifest}'],
      // Larger than all else, and kept when they are fetched.
      globIgnores: ['**/dragon*', '**/vendor.*'],
      maximumFileSizeToCacheInBytes: 4e6,
      injectionPoint: 'self.__SW_MANIFEST',
      rollupFormat: 'iife',
    }),
  ],
});
