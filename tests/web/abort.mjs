// How the tests abort a run. Runs in pages, too.

/**
 * Aborts a run at its first report, or at the first of a phase.
 *
 * @param start starts the run with the options that it is given
 * @returns the code of the run's error, and whether it had failed before the next event was handled: nobody waits for the
 *   engine to stop
 */
export async function abortOf(start, phase) {
  const controller = new AbortController();
  let atOnce;
  const run = start({
    signal: controller.signal,
    onProgress(progress) {
      if (atOnce || (phase && progress.phase !== phase)) return;
      controller.abort();
      atOnce = Promise.race([code, nextEvent()]);
    },
  });
  const code = run.then(
    () => 'finished',
    (error) => error.code,
  );
  return { code: await code, atOnce: (await atOnce) === 'ABORTED' };
}

function nextEvent() {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resolve('later');
    };
    port2.postMessage(null);
  });
}
