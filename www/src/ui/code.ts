import type { Edit } from '../model/edits';
import type { Summary } from '../model/model';
import { isGzipName, nameIn, type Source, titleOf } from '../model/source';
import type { Settings } from '../settings';

/** Returns the lines that do with the package what the page has just done, on exactly this input. */
export function codeFor(
  {
    source,
    backend,
    edits,
    filter,
    weights = null,
  }: Pick<Settings, 'source' | 'backend' | 'edits' | 'filter'> & Partial<Pick<Settings, 'weights'>>,
  summary: Pick<Summary, 'onFaces'> | null = null,
): string {
  const flat = source.dimension === 2;
  const triangulate = flat ? 'delaunay2d' : 'delaunay3d';
  // Those of a column or at random are the page's.
  const isWeighed = !weights && edits.some((edit) => edit.do === 'weigh');
  const chosen = [
    ...(backend === 'auto' ? [] : [`backend: '${backend}'`]),
    ...(isWeighed ? ['radii'] : []),
  ];
  const options = chosen.length > 0 ? `, { ${chosen.join(', ')} }` : '';
  const { uses, lines } = pointsOf(source, summary?.onFaces?.taken ?? false);
  return [
    `// npm install gdel-wasm`,
    `import { ${[triangulate, ...uses].join(', ')} }`,
    `  from 'gdel-wasm';`,
    ``,
    ...lines,
    ...(weights ? [`// The page gave them radii: { radii: […] }`] : []),
    ...(edits.length > 0 ? changes(edits, source, isWeighed) : []),
    `const mesh = await ${triangulate}(`,
    `  ${edits.length > 0 ? 'Float64Array.from(changed)' : 'points'}${options});`,
    ``,
    ...(flat ? RESULTS[2] : RESULTS[3]),
    `mesh.stats;      // backend, phases, rounds`,
    ``,
    ...(filter === 'surface' ? SURFACE : [`const vtu = await mesh.toVTU();`]),
  ].join('\n');
}

/** What downloads are called, before the dot. */
export function stemOf(source: Source): string {
  return titleOf(source)
    .replace(/\.[^.]*$/, '')
    .replace(/[^\w-]+/g, '-')
    .toLowerCase();
}

interface Lines {
  /** What of the package they use. */
  uses: readonly string[];
  /** They declare `points`. */
  lines: string[];
}

function pointsOf(source: Source, hasMore: boolean): Lines {
  if (source.kind === 'generator') {
    const { distribution, count, seed } = source;
    const make = source.dimension === 2 ? 'generate2d' : 'generate';
    return {
      uses: [make],
      lines: [
        `const points = await ${make}(`,
        `  '${distribution}', ${count}, { seed: ${seed} });`,
      ],
    };
  }
  const flat = source.dimension === 2;
  const addresses =
    source.kind === 'url'
      ? [{ name: nameIn(source.url), address: source.url }]
      : source.kind === 'file'
        ? source.files.map(({ name }) => ({ name, address: addressOf(name) }))
        : [];
  const isReadable = !hasMore && addresses.every(({ name }) => !/\.glb(\.gz)?$/i.test(name));
  if (addresses.length === 1 && isReadable) return readOne(addresses[0], flat);
  if (addresses.length > 1 && isReadable && !addresses.some(({ name }) => isGzipName(name)))
    return readAll(
      addresses.map(({ address }) => address),
      flat,
    );
  // The package does not read it, or not in a few lines: then its own file of the points.
  const name = `${stemOf(source)}.node`;
  const { uses, lines } = readOne({ name, address: name }, flat);
  return { uses, lines: [`// From Download${flat ? ', in 3D' : ''}: TetGen`, ...lines] };
}

function readOne({ name, address }: { name: string; address: string }, flat: boolean): Lines {
  const lines = [`const file = await fetch(`, `  ${quoted(address)});`];
  if (isGzipName(name)) {
    lines.push(
      `const unzipped = new Response(file.body`,
      `  .pipeThrough(new DecompressionStream('gzip')));`,
    );
  }
  const from = isGzipName(name) ? 'unzipped' : 'file';
  lines.push(
    `const { points${flat ? ': xyz' : ''} } = await readPoints(`,
    `  await ${from}.blob(),`,
    `  { name: ${quoted(name.replace(/\.gz$/i, ''))} });`,
  );
  if (flat) lines.push(FLAT);
  return { uses: ['readPoints'], lines };
}

function readAll(addresses: readonly string[], flat: boolean): Lines {
  return {
    uses: ['readPoints'],
    lines: [
      `const read = async (name) => readPoints(`,
      `  await (await fetch(name)).blob(), { name });`,
      `const parts = await Promise.all([`,
      ...addresses.map((address) => `  ${quoted(address)},`),
      `].map(read));`,
      `const ${flat ? 'xyz' : 'points'} = Float64Array.from(`,
      `  parts.flatMap((part) => [...part.points]));`,
      ...(flat ? [FLAT] : []),
    ],
  };
}

const FLAT = `const points = xyz.filter((_, i) => i % 3 < 2);`;

/** The changes by hand, one a line; without those that name a point that is not there. */
function changes(edits: readonly Edit[], source: Source, isWeighed: boolean): string[] {
  let count = source.kind === 'generator' ? source.count : Infinity;
  const ifWeighed = (line: string) => (isWeighed ? [line] : []);
  return [
    `const changed = [...points];`,
    ...ifWeighed(`const radii = Array(points.length / 2).fill(0);`),
    ...edits.flatMap((edit) => {
      if (edit.do === 'add') {
        count++;
        return [`changed.push(${edit.at.join(', ')});`, ...ifWeighed(`radii.push(0);`)];
      }
      if (edit.point >= count) return [];
      if (edit.do === 'weigh') return ifWeighed(`radii[${edit.point}] = ${edit.radius};`);
      if (edit.do === 'move')
        return [`changed.splice(${2 * edit.point}, 2, ${edit.at.join(', ')});`];
      count--;
      return [
        `changed.splice(${2 * edit.point}, 2);`,
        ...ifWeighed(`radii.splice(${edit.point}, 1);`),
      ];
    }),
  ];
}

/** The address of a file beside the program. */
const addressOf = (name: string) => name.replace(/[^\w.-]/g, encodeURIComponent);

const quoted = (text: string) => `'${text.replace(/[\\']/g, '\\$&')}'`;

const SURFACE = [
  `const surface = await mesh.surface();`,
  `surface.triangles; // 3 vertices each`,
  `surface.vertices;  // their coordinates`,
  `surface.volume;    // also area, genus`,
  `const print = await surface.to3MF();`,
];

const RESULTS = {
  3: [
    `mesh.tetrahedra; // 4 point indices each`,
    `mesh.neighbors;  // 4 each, -1 is outside`,
    `mesh.hull;       // 3 indices per triangle`,
  ],
  2: [
    `mesh.triangles;  // 3 point indices each`,
    `mesh.halfedges;  // 3 each, -1 is outside`,
    `mesh.hull;       // indices in order`,
  ],
};
