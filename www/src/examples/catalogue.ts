import { dependencies, devDependencies } from '../../package.json';
import given from '../../programs/packages.json';

/** A library that examples can import, by one of its names. */
interface Package {
  /** The file that has it, in www/vendor. */
  vendor: string;
  /** Other libraries that it imports. */
  uses?: string[];
  /** The path of its style sheet, for bundlers. */
  style?: string;
  /** Where it is on the web. Names in braces stand for versions. */
  cdn: string;
}

const packages: Record<string, Package> = given;
const versions: Record<string, string> = { ...dependencies, ...devDependencies };

const urls = (files: Record<string, unknown>) =>
  Object.fromEntries(
    Object.entries(files).map(([path, url]) => [
      path.slice(path.lastIndexOf('/') + 1),
      url as string,
    ]),
  );
const vendors = urls(
  import.meta.glob('../../vendor/*', { query: '?url&no-inline', import: 'default', eager: true }),
);
const data = urls(
  import.meta.glob('../../programs/data/*', {
    query: '?url&no-inline',
    import: 'default',
    eager: true,
  }),
);

const texts = new Map<string, Promise<string>>();

/** The text of a file, which is fetched once. */
function textAt(url: string): Promise<string> {
  let text = texts.get(url);
  if (!text) {
    text = fetch(url).then((response) => response.text());
    text.catch(() => texts.delete(url));
    texts.set(url, text);
  }
  return text;
}

/** The text of a file of the package that its main file asks for. */
export const partOf = (name: string): Promise<string> => textAt(vendors[`vendor.gdel.${name}.js`]);

/** All of them, by their names. */
export async function allParts(): Promise<Record<string, string>> {
  const names = Object.keys(vendors).flatMap((file) => /gdel\.(\w+-.+)\.js$/.exec(file)?.[1] ?? []);
  return Object.fromEntries(
    await Promise.all(names.map(async (name) => [name, await partOf(name)])),
  );
}

/** The address of an example's file. */
export const addressOf = (name: string): string => new URL(data[name], location.href).href;

/** The libraries that code names: it may also do so in text of which it makes a module. */
export const namedIn = (code: string): string[] =>
  Object.keys(packages).filter((name) =>
    [`'${name}'`, `"${name}"`].some((quoted) => code.includes(quoted)),
  );

/** The same with those that come with them, and that they import. */
export function neededFor(code: string): string[] {
  const all = new Set(namedIn(code));
  for (const name of all) {
    const { vendor, uses = [] } = packages[name];
    const beside = Object.keys(packages).filter((other) => packages[other].vendor === vendor);
    for (const other of [...uses, ...beside]) all.add(other);
  }
  return [...all];
}

/** The texts of libraries: names of one file are names of one module. */
export function modulesOf(names: readonly string[]): Promise<{ names: string[]; text: string }[]> {
  const files = [...new Set(names.map((name) => packages[name].vendor))];
  return Promise.all(
    files.map(async (file) => ({
      names: names.filter((name) => packages[name].vendor === file),
      text: await textAt(vendors[`vendor.${file}.js`]),
    })),
  );
}

/** Where libraries are on the web, by their names. */
export const addressesOf = (names: readonly string[]): Record<string, string> =>
  Object.fromEntries(
    names.map((name) => [
      name,
      packages[name].cdn.replace(/\{([^}]+)\}/g, (_, of: string) => versions[of]),
    ]),
  );

/** The style sheets of libraries: their paths in packages, addresses on the web, and files. */
export const stylesOf = (names: readonly string[]) =>
  names.flatMap((name) => {
    const { style, vendor } = packages[name];
    const cdn = `https://cdn.jsdelivr.net/npm/${style?.replace('/', `@${versions[name]}/`)}`;
    return style ? [{ path: style, cdn, text: () => textAt(vendors[`vendor.${vendor}.css`]) }] : [];
  });
