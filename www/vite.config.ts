import { defineConfig } from 'vite';

export default defineConfig({
  // Relative addresses: the page works from any folder of any host.
  base: './',
  worker: { format: 'es' },
  build: { target: 'es2023', chunkSizeWarningLimit: 900 },
  server: { fs: { allow: ['..'] } },
});
