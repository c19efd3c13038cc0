// What later visits are to know of a device, in a database of the browser. It only saves time: where there
// is no database, or it cannot be used, nothing is known.

const STORE = 'devices';

function open(): Promise<IDBDatabase> {
  return new Promise((resolve, reject) => {
    const request = indexedDB.open('gdel', 1);
    request.onupgradeneeded = () => request.result.createObjectStore(STORE);
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}

/** Does something with the store. Returns the result if there is one. */
async function use<T>(
  mode: IDBTransactionMode,
  work: (store: IDBObjectStore) => IDBRequest<T>,
): Promise<T | undefined> {
  try {
    const database = await open();
    return (await new Promise((resolve, reject) => {
      const transaction = database.transaction(STORE, mode);
      const request = work(transaction.objectStore(STORE));
      transaction.oncomplete = () => resolve(request.result);
      transaction.onabort = () => reject(transaction.error);
    }).finally(() => database.close())) as T;
  } catch {
    return undefined;
  }
}

/** Returns what was saved under a name. */
export const load = (name: string): Promise<Uint32Array | undefined> =>
  use('readonly', (store) => store.get(name));

/** Saves words under a name. */
export const save = (name: string, words: Uint32Array): Promise<unknown> =>
  use('readwrite', (store) => store.put(words, name));
