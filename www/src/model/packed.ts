/** A file in a link may be so long, in characters. Longer links do not survive everywhere. */
const LONGEST = 28_000;

/** A larger file cannot become short enough. */
const LARGEST = 1_000_000;

/** A file as text for a link: compressed, in the base-64 alphabet for addresses. Null if too long. */
export async function pack(file: Blob): Promise<string | null> {
  if (file.size > LARGEST) return null;
  const stream = file.stream().pipeThrough(new CompressionStream('deflate-raw'));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  if ((4 / 3) * bytes.length > LONGEST) return null;
  let binary = '';
  for (const byte of bytes) binary += String.fromCharCode(byte);
  return btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
}

/** The file in a link, or null where it makes no sense. */
export async function unpack(text: string, name: string): Promise<File | null> {
  try {
    const binary = atob(text.replaceAll('-', '+').replaceAll('_', '/'));
    const bytes = Uint8Array.from(binary, (character) => character.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw'));
    const limited = await atMost(stream, LARGEST);
    return limited && new File([limited], name);
  } catch {
    return null;
  }
}

/** What a stream holds, unless that is too much: a short link may unpack to gigabytes. */
async function atMost(
  stream: ReadableStream<Uint8Array<ArrayBuffer>>,
  most: number,
): Promise<Blob | null> {
  const parts: Uint8Array<ArrayBuffer>[] = [];
  let size = 0;
  const reader = stream.getReader();
  for (let read = await reader.read(); !read.done; read = await reader.read()) {
    size += read.value.length;
    if (size > most) return null;
    parts.push(read.value);
  }
  return new Blob(parts);
}
