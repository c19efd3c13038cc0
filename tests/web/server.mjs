// A web server for the tests: files by URL prefix, with the headers that a test wants.

import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';

const TYPES = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.mjs': 'text/javascript',
  '.wasm': 'application/wasm',
  '.css': 'text/css',
  '.svg': 'image/svg+xml',
};

/**
 * Serves `folders`, an object from URL prefixes to folders, and an empty page at `/`.
 *
 * @param headers of every answer
 * @param change may change a file's content: (path, content) => content
 */
export async function serve(folders, { headers = {}, change = (_, content) => content } = {}) {
  const server = createServer(async (request, response) => {
    const path = normalize(new URL(request.url, 'http://localhost').pathname);
    const answer = (status, content, type) => {
      response.writeHead(status, { 'content-type': type, ...headers });
      response.end(content);
    };
    if (path === '/') return answer(200, '<!doctype html><title>test</title>', 'text/html');
    if (path === '/favicon.ico') return answer(204, '', 'image/x-icon');
    const prefix = Object.keys(folders).find((prefix) => path.startsWith(prefix));
    try {
      const content = await readFile(join(folders[prefix], path.slice(prefix.length)));
      answer(200, change(path, content), TYPES[extname(path)] ?? 'application/octet-stream');
    } catch {
      answer(404, 'not found', 'text/plain');
    }
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { url: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}
