// Fails where files of a Rust crate import each other in a circle.
//
//   node scripts/circles.mjs
//
// An import is a path of a `use`, or one that begins with `crate::`; it leads to the file in which
// what it names is defined, through re-exports. A module and those inside it belong together: what
// they import of each other does not count. Tests inside a file do not, either.

import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { dirname, join, relative } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = join(dirname(fileURLToPath(import.meta.url)), '..');

function filesIn(folder) {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) return filesIn(path);
    return entry.name.endsWith('.rs') ? [path] : [];
  });
}

/** Returns the code of a file without comments, strings and the tests at its end. */
function codeOf(file) {
  return readFileSync(file, 'utf8')
    .replace(/^\s*\/\/.*$/gm, '')
    .replace(/"(?:[^"\\]|\\.)*"/g, '""')
    .replace(/#\[cfg\(test\)\]\s*mod \w+ \{[\s\S]*$/, '');
}

/** Returns the paths of a tree like `a::{b, c::{self, d as e}}`, each with the name that it gets. */
function paths(tree, before = []) {
  const open = tree.indexOf('{');
  if (open < 0) {
    const [path, as] = tree.trim().split(/\s+as\s+/);
    const parts = [...before, ...path.split('::').map((part) => part.trim())];
    if (parts.length > 1 && parts.at(-1) === 'self') parts.pop();
    return [{ parts, name: as ?? parts.at(-1) }];
  }
  const head = tree
    .slice(0, open)
    .split('::')
    .map((part) => part.trim());
  const inner = tree.slice(open + 1, tree.lastIndexOf('}'));
  const trees = [];
  for (let depth = 0, from = 0, at = 0; at <= inner.length; at++) {
    if (inner[at] === '{') depth++;
    if (inner[at] === '}') depth--;
    if (at === inner.length || (inner[at] === ',' && depth === 0)) {
      if (inner.slice(from, at).trim() !== '') trees.push(inner.slice(from, at));
      from = at + 1;
    }
  }
  return trees.flatMap((each) => paths(each, [...before, ...head.filter((part) => part !== '')]));
}

/** Returns the modules of a crate by their paths, with what each imports and re-exports. */
function modulesOf(source) {
  const modules = new Map();
  for (const file of filesIn(source)) {
    const names = relative(source, file)
      .replace(/\.rs$/, '')
      .split('/')
      .filter((name) => name !== 'mod' && name !== 'lib' && name !== 'main');
    const code = codeOf(file);
    const uses = [...code.matchAll(/\b(pub(?:\([^)]*\))?\s+)?use\s+([^;]+);/g)].flatMap(
      ([, isPublic, tree]) => paths(tree).map((path) => ({ ...path, isPublic: !!isPublic })),
    );
    const others = [...code.matchAll(/\bcrate(?:::\w+)+/g)].map(([path]) => ({
      parts: path.split('::'),
    }));
    modules.set(names.join('::'), { file, names, uses, others });
  }
  return modules;
}

/** Returns the module that a path leads to from another one; null if it leaves the crate. */
function targetOf(modules, from, parts, seen = new Set()) {
  let at;
  const rest = [...parts];
  if (rest[0] === 'crate') at = [];
  else if (rest[0] === 'self') at = [...from.names];
  else if (rest[0] === 'super') {
    at = [...from.names];
    while (rest[0] === 'super') {
      at.pop();
      rest.shift();
    }
    rest.unshift('super');
  } else if (modules.has([...from.names, rest[0]].join('::'))) {
    at = [...from.names];
    rest.unshift('self');
  } else return null;
  rest.shift();
  while (rest.length > 0 && modules.has([...at, rest[0]].join('::'))) at.push(rest.shift());
  const found = modules.get(at.join('::'));
  if (!found) return null;
  const key = `${at.join('::')} ${rest[0]}`;
  if (rest.length === 0 || seen.has(key)) return found;
  seen.add(key);
  const exported = found.uses.filter(({ isPublic }) => isPublic);
  const named = exported.find(({ name }) => name === rest[0]);
  const through = named
    ? targetOf(modules, found, [...named.parts, ...rest.slice(1)], seen)
    : exported
        .filter(({ name }) => name === '*')
        .map(({ parts }) => targetOf(modules, found, [...parts.slice(0, -1), ...rest], seen))
        .find((module) => module && module !== found);
  return through ?? found;
}

const isInside = (inner, outer) => outer.names.every((name, i) => inner.names[i] === name);

/** Returns the groups of modules of which each imports the others, by Tarjan's algorithm. */
function circles(imports) {
  const number = new Map();
  const lowest = new Map();
  const stack = [];
  const found = [];
  const visit = (module) => {
    number.set(module, number.size);
    lowest.set(module, number.get(module));
    stack.push(module);
    for (const other of imports.get(module)) {
      if (!number.has(other)) visit(other);
      if (stack.includes(other))
        lowest.set(module, Math.min(lowest.get(module), lowest.get(other)));
    }
    if (lowest.get(module) !== number.get(module)) return;
    const group = stack.splice(stack.indexOf(module));
    if (group.length > 1) found.push(group);
  };
  for (const module of imports.keys()) if (!number.has(module)) visit(module);
  return found;
}

const sources = [
  'src',
  'web/wasm/src',
  ...readdirSync(join(root, 'crates')).map((name) => `crates/${name}/src`),
];
let count = 0;
for (const source of sources.map((folder) => join(root, folder)).filter(existsSync)) {
  const modules = modulesOf(source);
  const imports = new Map();
  for (const module of modules.values()) {
    const targets = [...module.uses, ...module.others].map(({ parts }) =>
      targetOf(modules, module, parts.at(-1) === '*' ? parts.slice(0, -1) : parts),
    );
    const counted = targets.filter(
      (target) => target && !isInside(target, module) && !isInside(module, target),
    );
    imports.set(module, new Set(counted));
  }
  for (const group of circles(imports)) {
    count++;
    console.error('These files import each other:');
    for (const module of group) {
      const others = [...imports.get(module)].filter((other) => group.includes(other));
      const name = ({ file }) => relative(root, file);
      console.error(`  ${name(module)} imports ${others.map(name).join(', ')}`);
    }
  }
}
if (count > 0) process.exit(1);
