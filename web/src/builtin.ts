/** The modules of Node that are used where they exist. */
interface BuiltInModules {
  'node:fs/promises': typeof import('node:fs/promises');
  'node:os': typeof import('node:os');
  'node:url': typeof import('node:url');
  'node:worker_threads': typeof import('node:worker_threads');
  'node:zlib': typeof import('node:zlib');
}

/**
 * Returns a module of Node, and undefined where there are none. They are asked for and never
 * imported, since bundlers would follow an import.
 */
export function builtin<Name extends keyof BuiltInModules>(
  name: Name,
): BuiltInModules[Name] | undefined {
  return globalThis.process?.getBuiltinModule?.(name);
}
