// Renames what a wasm module imports and exports, in its binary format.

const SECTION_IMPORT = 2;
const SECTION_EXPORT = 7;
const KIND_FUNCTION = 0;

/** Reads a module of WebAssembly's binary format from its byte `at` on. */
class Reader {
  constructor(bytes, at) {
    this.bytes = bytes;
    this.at = at;
  }

  byte() {
    return this.bytes[this.at++];
  }

  /** An unsigned number, of which seven bits are in each byte. */
  number() {
    let number = 0;
    for (let scale = 1; ; scale *= 128) {
      const byte = this.byte();
      number += (byte & 127) * scale;
      if (byte < 128) return number;
    }
  }

  take(length) {
    return this.bytes.subarray(this.at, (this.at += length));
  }
}

/** Returns the bytes of an unsigned number. */
function encoded(number) {
  const bytes = [];
  for (; number >= 128; number = Math.floor(number / 128)) bytes.push((number % 128) + 128);
  return Buffer.from([...bytes, number]);
}

const withLength = (bytes) => Buffer.concat([encoded(bytes.length), bytes]);

/**
 * Returns a wasm module, of which all imports are functions, with the names in `names` for them, from
 * the module `from`, and with those in `exported` for what it exports, where there are any.
 */
export function renameImports(module, { module: from, names, exported }) {
  // The first eight bytes are the format's name and version.
  const reader = new Reader(module, 8);
  const parts = [module.subarray(0, 8)];
  while (reader.at < module.length) {
    const id = reader.byte();
    const content = reader.take(reader.number());
    let renamed = content;
    if (id === SECTION_IMPORT) renamed = renamedImports(content, from, names);
    if (id === SECTION_EXPORT) renamed = renamedExports(content, exported);
    parts.push(Buffer.from([id]), withLength(renamed));
  }
  return Buffer.concat(parts);
}

/** Returns the section of imports: their number, and for each its module, name, kind and type. */
function renamedImports(section, from, names) {
  const reader = new Reader(section, 0);
  const count = reader.number();
  const parts = [encoded(count)];
  for (let i = 0; i < count; i++) {
    reader.take(reader.number());
    const name = names.get(reader.take(reader.number()).toString());
    if (name === undefined || reader.byte() !== KIND_FUNCTION)
      throw new Error(`import ${i} of a wasm module is not a function that the JavaScript has`);
    const type = encoded(reader.number());
    parts.push(
      withLength(Buffer.from(from)),
      withLength(Buffer.from(name)),
      Buffer.from([KIND_FUNCTION]),
      type,
    );
  }
  return Buffer.concat(parts);
}

/** Returns the section of exports: their number, and for each its name, kind and index. */
function renamedExports(section, names) {
  const reader = new Reader(section, 0);
  const count = reader.number();
  const parts = [encoded(count)];
  for (let i = 0; i < count; i++) {
    const name = reader.take(reader.number()).toString();
    parts.push(withLength(Buffer.from(names.get(name) ?? name)));
    parts.push(Buffer.from([reader.byte()]), encoded(reader.number()));
  }
  return Buffer.concat(parts);
}
