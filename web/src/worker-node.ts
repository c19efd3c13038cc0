// The worker as a thread of Node.

import { parentPort } from 'node:worker_threads';
import { serve } from './worker.js';

if (parentPort) {
  const port = parentPort;
  serve({
    post: (message, transfer) => port.postMessage(message, transfer),
    listen: (handler) => port.on('message', handler),
  });
}
