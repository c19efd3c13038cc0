// Drives Safari, by WebDriver: Playwright's WebKit is not Safari, and has no WebGPU. Needs `sudo safaridriver --enable`
// once.

import { spawn } from 'node:child_process';
import { createServer } from 'node:net';

/** Sessions end by themselves now and then (actions/runner-images#14585), so that a few are tried. */
const ATTEMPTS = 3;
const POLL_MILLISECONDS = 250;

const pause = () => new Promise((resolve) => setTimeout(resolve, POLL_MILLISECONDS));

/** The session was lost, which says nothing about the page. */
class SessionLost extends Error {}

/** Returns a port that nobody listens on. */
async function freePort() {
  const server = createServer();
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const { port } = server.address();
  await new Promise((resolve) => server.close(resolve));
  return port;
}

/** Sends a command to the driver, and returns its answer. */
async function send(address, method, body) {
  let answer;
  try {
    const response = await fetch(address, { method, body: body && JSON.stringify(body) });
    answer = await response.json();
  } catch (error) {
    throw new SessionLost(String(error));
  }
  const { value } = answer;
  if (value?.error) throw new SessionLost(`${value.error}: ${value.message}`);
  return value;
}

/** Opens a page and runs a module in it, which sets `globalThis.found`. Returns that. */
async function attempt(url, module) {
  const port = await freePort();
  const driver = spawn('safaridriver', ['--port', `${port}`], { stdio: 'inherit' });
  const failed = new Promise((_, reject) => {
    driver.once('error', reject);
    driver.once('exit', (code) => reject(new SessionLost(`safaridriver has ended with ${code}`)));
  });
  const root = `http://127.0.0.1:${port}`;
  const work = async () => {
    // It takes a moment to listen.
    while (!(await send(`${root}/status`, 'GET').catch(() => ({}))).ready) await pause();
    const capabilities = { alwaysMatch: { browserName: 'safari' } };
    const { sessionId } = await send(`${root}/session`, 'POST', { capabilities });
    const session = `${root}/session/${sessionId}`;
    try {
      await send(`${session}/url`, 'POST', { url });
      const execute = (script, args = []) =>
        send(`${session}/execute/sync`, 'POST', { script, args });
      await execute(
        `const script = document.createElement('script');
        script.type = 'module';
        script.textContent = arguments[0];
        document.head.append(script);`,
        [module],
      );
      let found = null;
      while (found === null) {
        await pause();
        found = await execute('return globalThis.found ?? null;');
      }
      return found;
    } finally {
      await send(session, 'DELETE').catch(() => {});
    }
  };
  try {
    return await Promise.race([work(), failed]);
  } finally {
    driver.kill();
  }
}

/** Runs a module in a page in Safari. Returns what it has set `globalThis.found` to. */
export async function inSafari(url, module) {
  for (let i = 1; ; i++) {
    try {
      return await attempt(url, module);
    } catch (error) {
      if (!(error instanceof SessionLost) || i === ATTEMPTS) throw error;
      console.log(`Safari, attempt ${i}: ${error.message}`);
    }
  }
}
