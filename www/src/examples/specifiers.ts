import { init, parse } from 'es-module-lexer';

/** The names of the modules that code imports. None where it is no module: then running it says why. */
export async function specifiersOf(code: string): Promise<string[]> {
  await init;
  try {
    const [imports] = parse(code);
    return [...new Set(imports.flatMap(({ n }) => n ?? []))];
  } catch {
    return [];
  }
}
