// Makes the modules that examples import, www/vendor: each library in one file, and those of the package.
// The service worker knows them by how their names begin. A frame in a sandbox makes modules of their texts, which know no addresses: so imports of other libraries stay bare,
// and the package's own files are asked for by name when they are needed.
import { cpSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { rolldown } from 'rolldown';

const vendor = new URL('../vendor/', import.meta.url);
const dist = new URL('../../web/dist/', import.meta.url);
const packages = JSON.parse(readFileSync(new URL('../programs/packages.json', import.meta.url)));

/** What CommonJS exports is known only once it has run. */
const COMMON_JS = ['react', 'react-dom/client'];

/** Where a file has to be another one than bundlers take by default. */
const FILES = { leaflet: 'leaflet/dist/leaflet-src.esm.js' };

rmSync(vendor, { recursive: true, force: true });
mkdirSync(vendor);

function copyPackage() {
  const copy = (from, to) => {
    const text = readFileSync(new URL(from, dist), 'utf8')
      .replace(/import\("\.\/([\w-]+)\.js"\)/g, 'partOf("$1")')
      .replaceAll('"./index.js"', '"gdel-wasm"');
    writeFileSync(new URL(`vendor.${to}`, vendor), text);
  };
  copy('inline.js', 'gdel.js');
  for (const entry of ['treemap', 'tin']) copy(`${entry}.js`, `gdel.${entry}.js`);
  const parts = readdirSync(dist).filter((name) => /^(inline|core)-.*\.js$/.test(name));
  for (const name of parts) copy(name, `gdel.${name}`);
}

/** A module that exports all that a library does. */
async function entryOf(name) {
  const from = JSON.stringify(FILES[name] ?? name);
  if (!COMMON_JS.includes(name)) return `export * from ${from};`;
  // Both of React's have a version, which is the same.
  const all = Object.keys((await import(name)).default);
  const names = name === 'react' ? all : all.filter((exported) => exported !== 'version');
  return `export { ${names.join(', ')} } from ${from};`;
}

async function bundle(file) {
  const names = Object.keys(packages).filter((name) => packages[name].vendor === file);
  const entries = await Promise.all(names.map(entryOf));
  // One that is not CommonJS may have a default export as well.
  const withDefault = ['htm', '@dimforge/rapier3d-compat', 'react'].includes(names[0]);
  const entry = [...entries, ...(withDefault ? [`export { default } from '${names[0]}';`] : [])];
  const build = await rolldown({
    input: 'entry',
    platform: 'browser',
    external: packages[names[0]].uses ?? [],
    transform: { define: { 'process.env.NODE_ENV': '"production"' } },
    treeshake: { moduleSideEffects: true },
    logLevel: 'silent',
    plugins: [
      {
        name: 'entry',
        resolveId: (id) =>
          id === 'entry' ? new URL('../entry.js', import.meta.url).pathname : null,
        load: (id) => (id.endsWith('/www/entry.js') ? entry.join('\n') : null),
      },
    ],
  });
  const { output } = await build.generate({ format: 'es', minify: true, codeSplitting: false });
  writeFileSync(new URL(`vendor.${file}.js`, vendor), output[0].code);
  console.log(`www/vendor/vendor.${file}.js: ${Math.round(output[0].code.length / 1e3)} kB`);
}

copyPackage();
for (const { style, vendor: file } of Object.values(packages))
  if (style)
    cpSync(fileURLToPath(import.meta.resolve(style)), new URL(`vendor.${file}.css`, vendor));
const files = new Set(Object.values(packages).map(({ vendor }) => vendor));
for (const file of files) if (!file.startsWith('gdel')) await bundle(file);
