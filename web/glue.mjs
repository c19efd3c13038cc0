// Joins the JavaScript that wasm-bindgen writes for each wasm module: most of it is the same for
// all of them, and it keeps its instance in module variables.

import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import * as esbuild from 'esbuild';
import ts from 'typescript';

/** The function that returns the imports of a module. */
const IMPORTS = '__wbg_get_imports';

/** The parameter of the joined glue that says which module an instance is of. */
const MODULE = 'moduleName';

/** The parameter with calls of wgpu that are made in other ways: methods that take the object first. */
const CALLS = 'calls';
const CALLED = /\b(\w+)\.(createComputePipeline|setPipeline|popErrorScope|writeBuffer|submit)\(/;
const QUEUE = /\b(\w+)\.queue\b/;

/** What modules have by the same name, in one or several texts. */
class Variants {
  #byName = new Map();

  add(name, text, module) {
    const variants = this.#byName.get(name) ?? new Map();
    variants.set(text, [...(variants.get(text) ?? []), module]);
    this.#byName.set(name, variants);
  }

  /**
   * Calls `same` for what has one text, and `different` with an expression that chooses by
   * {@link MODULE} for the rest. Modules that do not have it can have any.
   */
  map(same, different) {
    return [...this.#byName].map(([name, variants]) => {
      const [first, ...others] = variants;
      if (others.length === 0) return same(name, first[0]);
      const choices = others.flatMap(([text, modules]) => modules.map((m) => `${m}: ${text}`));
      return different(name, `{ ${choices.join(', ')} }[${MODULE}] ?? (${first[0]})`);
    });
  }
}

/** Returns the statements of a file, without comments, since these differ where the code does not. */
function parse(file) {
  const { code } = esbuild.transformSync(readFileSync(file, 'utf8'), { legalComments: 'none' });
  return ts.createSourceFile(file, code, ts.ScriptTarget.ES2022, true).statements;
}

/** Returns the object with the imports, which is the first thing that their function declares. */
const importsOf = ({ body }) => body.statements[0].declarationList.declarations[0].initializer;

/** What calls a closure, of which there are several in each module. */
const CLOSURE = /\bwasm_bindgen__convert__closures\w+/g;

/**
 * Returns short names for what the modules in `files`, names to paths, import, and a name for the
 * module from which: one that says which names these are, so that JavaScript and WebAssembly of
 * different versions do not fit; and short names for what they export to call closures. The names of
 * wasm-bindgen end in hashes, and there are so many that they take 3 kB of the 3D module and of the
 * JavaScript, compressed.
 */
export function importNames(files) {
  const functions = Object.values(files).flatMap((file) =>
    parse(file).filter(({ name }) => name?.text === IMPORTS),
  );
  const texts = Object.values(files).map((file) => readFileSync(file, 'utf8'));
  const closures = [...new Set(texts.flatMap((text) => text.match(CLOSURE) ?? []))].sort();
  const found = functions.flatMap((declaration) =>
    importsOf(declaration).properties.map(({ name }) => name.getText()),
  );
  const sorted = [...new Set(found)].sort();
  const hash = createHash('sha256').update(sorted.join()).digest('hex').slice(0, 8);
  const shortened = (names, prefix) =>
    new Map(names.map((name, i) => [name, `${prefix}${i.toString(36)}`]));
  return { module: hash, names: shortened(sorted, '_'), exported: shortened(closures, 'c') };
}

/**
 * What wgpu imports to draw, with long lists of names, and to time what it does. Nothing here does either.
 * wgpu only tries what a canvas can do, once it has one; where there is none, it goes on without.
 */
const DRAWS =
  /enum_Gpu(Texture|StorageTexture|Sampler)|\.(getContext|(un)?configure|resolveQuerySet)\(|\.(texture|sampler|storageTexture|externalTexture|querySet|timestampWrites|(beginning|end)OfPassWriteIndex) = /;
const CANVAS = /new OffscreenCanvas/;
/** The limits of a device at which nothing looks: the library takes the defaults of WebGPU for them. */
const LIMIT = /\.(max|min|subgroupM)(?!BufferSize|StorageBufferBindingSize)[A-Z]?\w+;/;
/** Where else than by its names `globalThis` and `self` the global object could be. */
const GLOBAL = /typeof (global|window) ===/;
const REPLACED = `
  function doesNotDraw() { throw new Error('gdel does not draw'); }
  function noCanvas() { return handleError(doesNotDraw, []); }
  function nothing() { return 0; }`;

/** Returns the text with functions as arrows, which are shorter. */
const arrows = (text) =>
  text
    .replace(/, arguments\)/, ', args)')
    .replace(/^function\(\)(?= \{\s*return handleError)/, '(...args) =>')
    .replace(/\bfunction(\([^)]*\))/g, '$1 =>');

/** Returns the text of an import. */
function importText(text) {
  if (DRAWS.test(text)) return 'doesNotDraw';
  if (CANVAS.test(text)) return 'noCanvas';
  if (LIMIT.test(text) || GLOBAL.test(text)) return 'nothing';
  const instance = /= (\w+ instanceof \w+);/.exec(text);
  const whole = instance ? text.replace(/\{.*\}/s, `{ return ${instance[1]}; }`) : text;
  return arrows(whole).replace(CALLED, `${CALLS}.$2($1, `).replace(QUEUE, `${CALLS}.queue($1)`);
}

/** An expression for engines that lack what ES 2022 has. */
const FOR_OLD_ENGINES = /typeof FinalizationRegistry === "undefined" \? [^:]*:[^:]*:[^:]*: /;
/**
 * Statements for engines without `encodeInto`, which is as old, and for the declarations of `using`; and one
 * that has a decoder ready before it is needed.
 */
const UNUSED = /^(if \((!\("encodeInto" in|Symbol\.dispose)|cachedTextDecoder\.decode\()/;

/**
 * Shorter texts: for what describes values in messages, what takes modules in several ways, what passes
 * strings without copying them again, and what keeps track of a memory that may be replaced.
 */
const SHORTER = {
  debugString: 'const debugString = String;',
  // The package passes what it gets.
  _assertClass: 'function _assertClass() {}',
  decodeText: 'const decodeText = (bytes) => cachedTextDecoder.decode(bytes);',
  passStringToWasm0: `function passStringToWasm0(text, malloc) {
    const bytes = cachedTextEncoder.encode(text);
    const at = malloc(bytes.length, 1) >>> 0;
    getUint8ArrayMemory0().set(bytes, at);
    WASM_VECTOR_LEN = bytes.length;
    return at;
  }`,
  getDataViewMemory0: `function getDataViewMemory0() {
    if (cachedDataViewMemory0?.buffer !== wasm.memory.buffer)
      cachedDataViewMemory0 = new DataView(wasm.memory.buffer);
    return cachedDataViewMemory0;
  }`,
  initSync: `function initSync({ module }) {
    wasm = new WebAssembly.Instance(module, ${IMPORTS}()).exports;
    wasm.__wbindgen_start();
    return wasm;
  }`,
};

/**
 * Returns the text of an ES module that holds the glue of all modules in `files`, names to paths.
 * Classes and imports that differ between modules are chosen by the free variable
 * {@link MODULE}; imports have the names of {@link importNames}. At its end it assigns all exports to
 * the free variable `glue`.
 */
function join(files) {
  const { module: from, names, exported: closures } = importNames(files);
  const declarations = new Variants();
  const imports = new Variants();
  const exported = new Set(['initSync']);
  for (const [module, file] of Object.entries(files)) {
    for (const statement of parse(file)) {
      // The functions in JavaScript that call these have the same names.
      const whole = statement.getText().replace(CLOSURE, (name) => closures.get(name));
      if (ts.isExportDeclaration(statement) || UNUSED.test(whole)) continue;
      const isExported = whole.startsWith('export ');
      if (isExported) exported.add(statement.name.text);
      const text = whole.replace(/^export /, '').replace(FOR_OLD_ENGINES, '');
      if (statement.name?.text !== IMPORTS) {
        const name = /^function (\w+)/.exec(text)?.[1] ?? statement.name?.text ?? text;
        declarations.add(name, SHORTER[name] ?? text, module);
        continue;
      }
      for (const { name, initializer } of importsOf(statement).properties)
        imports.add(
          names.get(name.getText()),
          importText(initializer.getText().replace(CLOSURE, (name) => closures.get(name))),
          module,
        );
    }
  }
  const property = (name, value) => `${name}: ${value}`;
  const properties = imports.map(property, property);
  return [
    ...declarations.map(
      (_, text) => text,
      (name, choice) => `const ${name} = ${choice};`,
    ),
    REPLACED,
    `function ${IMPORTS}() { return { '${from}': { ${properties.join(', ')} } }; }`,
    `glue = { ${[...exported].join(', ')} };`,
  ].join('\n');
}

// wgpu distinguishes errors by these classes, which are not globals everywhere.
const ERROR_CLASSES = ['GPUValidationError', 'GPUOutOfMemoryError'].map(
  (name) => `const ${name} = { [Symbol.hasInstance]: (e) => e?.constructor?.name === '${name}' };`,
);

// jsdom does not have these, but Node below it does.
const CODERS =
  "const { TextDecoder, TextEncoder } = globalThis.TextDecoder ? globalThis : globalThis.process.getBuiltinModule('node:util');";

/**
 * Resolves the import `glue` to a function, of which each call has an instance of its own: of the
 * module that it is told, with these calls of wgpu, and with the global object that it is passed. The
 * modules' imports have the names of {@link importNames}.
 */
export function gluePlugin(files) {
  return {
    name: 'glue',
    setup(build) {
      build.onResolve({ filter: /^glue$/ }, ({ path }) => ({ path, namespace: 'glue' }));
      build.onLoad({ filter: /.*/, namespace: 'glue' }, async () => {
        // Leaves out what only the asynchronous initialisation needs, and nobody calls that.
        const { outputFiles } = await esbuild.build({
          stdin: { contents: join(files) },
          bundle: true,
          write: false,
          format: 'esm',
          target: 'es2022',
          minify: true,
          define: { 'import.meta.url': '""' },
        });
        const body = [...ERROR_CLASSES, CODERS, 'let glue;', outputFiles[0].text, 'return glue;'];
        // wasm-bindgen looks for the global object under both names, and under this one first.
        const parameters = `${MODULE}, ${CALLS}, globalThis, self = globalThis`;
        const contents = `export default function (${parameters}) { ${body.join('\n')} }`;
        return { contents, loader: 'js' };
      });
    },
  };
}
