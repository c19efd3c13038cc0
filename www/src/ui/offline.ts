/** Has the browser keep the page, so that it opens without a connection from the next visit on. */
export async function keepOffline(): Promise<void> {
  if (!import.meta.env.PROD) return;
  try {
    await navigator.serviceWorker.register('offline.js');
  } catch {
    // Not over plain HTTP, and not in the sandboxed frames of other pages.
  }
}
