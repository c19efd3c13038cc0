import { EXTENSIONS, type Source, titleOf } from '../model/source';

/** Says what went wrong with a source, and what to do about it. */
export function complaint(source: Source, error: unknown): string {
  const { name, message } = error as Error;
  if (name === 'ABORTED' || name === 'AbortError')
    return 'Cancelled. Still showing the previous result.';
  if (name === 'UNKNOWN_FORMAT') {
    const extension =
      /\.[^./\\]+(?:\.gz)?$/i.exec(titleOf(source))?.[0] ?? 'a file without an extension';
    return `Can’t read ${extension}. Supported: ${EXTENSIONS}, also as .gz.`;
  }
  if (name === 'NO_ADAPTER')
    return 'This browser offers no GPU through WebGPU. Choose the CPU, which gives the same result.';
  if (name === 'OUT_OF_DEVICE_MEMORY' || name === 'BUFFER_TOO_LARGE')
    return `${sentence(message)} Choose the CPU, or fewer points.`;
  if (isOffline(error)) return `${titleOf(source)} could not be loaded. ${CONNECTION}`;
  const what = sentence(message.replace(/^byte 0: /, ''));
  return source.kind === 'file' || source.kind === 'url' ? `${titleOf(source)}: ${what}` : what;
}

const CONNECTION = 'Check your connection and try again.';

/** Says what went wrong where a part of the page was wanted. */
export function complaintAbout(what: string, error: unknown): string {
  return isOffline(error)
    ? `${what} could not be loaded. ${CONNECTION}`
    : `${what}: ${sentence((error as Error).message)}`;
}

/** Whether something could not be fetched: browsers say so in words of their own. */
function isOffline(error: unknown): boolean {
  const { message } = error as Error;
  return /dynamically imported module|Importing a module script failed|failed to fetch|Load failed|NetworkError/i.test(
    message,
  );
}

/** A message of a program as a sentence. */
function sentence(message: string): string {
  const start = message.charAt(0).toUpperCase() + message.slice(1);
  return /[.!?]$/.test(start) ? start : `${start}.`;
}
