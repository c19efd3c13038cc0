import type { Dimension } from './geometry/dimension';
import { unpack } from './model/packed';
import { type Source, titleOf } from './model/source';
import { fileIn, fromHash, type LinkedFile, type Settings, toHash } from './settings';

/** What the address says, and the files that it can only name. */
export class Address {
  private timer = 0;
  /** The files of this visit, which links and the browser's Back can only name. */
  private readonly files = new Map<string, readonly File[]>();

  /** The settings of the page. */
  constructor(private readonly settings: () => Settings) {
    // Before anything is written over the entry of the history that the visitor went to.
    window.addEventListener('popstate', () => clearTimeout(this.timer));
  }

  /** Writes the settings soon: browsers allow only so many changes of the address a second. */
  remember(): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.write(), 300);
  }

  write(): void {
    clearTimeout(this.timer);
    history.replaceState(null, '', `#${toHash(this.settings())}`);
  }

  /** Leaves the present object in the browser's history, so that Back returns to it. */
  leave(): void {
    this.write();
    history.pushState(null, '', location.hash);
  }

  /** Reads what the visitor went to. Files of this visit are in it. */
  async read(): Promise<Settings> {
    clearTimeout(this.timer);
    const settings = fromHash(location.hash);
    const asked = fileIn(location.hash);
    const source = asked && (await this.sourceOf(asked, settings.source.dimension));
    return source ? { ...settings, source } : settings;
  }

  /** Keeps the files of a source for links to it. */
  keep(source: Source): void {
    if (source.kind === 'file') this.files.set(titleOf(source), source.files);
  }

  /** The file that an address names: from the address itself, or from this visit. */
  async sourceOf(
    { name, packed, ...bare }: LinkedFile,
    dimension: Dimension,
  ): Promise<Source | null> {
    const unpacked = packed ? await unpack(packed, name) : null;
    const files = this.files.get(name) ?? (unpacked && [unpacked]);
    return files && { kind: 'file', dimension, files, ...bare, ...(packed ? { packed } : {}) };
  }
}

/** Whether two views are of the same mesh. */
export function haveSamePoints(one: Settings, other: Settings): boolean {
  const pointsOf = ({ source, edits, backend }: Settings) =>
    JSON.stringify([source, source.kind === 'file' && titleOf(source), edits, backend]);
  return pointsOf(one) === pointsOf(other);
}

/** What the address asks for. A file on the web may also be named before the '#': `?url=`. */
export function wholeHash(): string {
  const query = new URLSearchParams(location.search);
  const url = query.get('url');
  // What the visitor went on to is after the '#'.
  if (url === null || /(^#?|&)(points|file|url)=/.test(location.hash)) return location.hash;
  const hash = new URLSearchParams(location.hash.replace(/^#/, ''));
  hash.set('url', url);
  return hash.toString();
}
