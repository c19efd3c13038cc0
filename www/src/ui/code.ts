import { addsPoint, applyEdits, type Edit, removedBy } from '../model/edits';
import type { Summary } from '../model/model';
import { type Constrained, constraintsAfter, MOST_ADDED } from '../model/shapes';
import { isGzipName, isShapes, nameIn, type Source, stemOf } from '../model/source';
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
  polygons: Polygons | null = null,
): string {
  if (polygons) return codeForPolygons({ source, backend, edits }, polygons);
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

/** What the page knows about polygons. */
type Polygons = Pick<Constrained, 'start' | 'rings' | 'fill' | 'meshing' | 'refinement'>;

function codeForPolygons(
  { source, backend, edits }: Pick<Settings, 'source' | 'backend' | 'edits'>,
  polygons: Polygons,
): string {
  const { fill, meshing, refinement } = polygons;
  const { uses, lines, points, hasShapes } = pointsAndRings(source, edits, polygons);
  // What suits needs no words.
  const isUsual = meshing.fill === 0 && (hasShapes ? fill !== 'all' : fill === 'evenodd');
  const options = [
    hasShapes ? '...shapes' : 'rings',
    ...(hasShapes && lines.some((line) => line.startsWith('const rings')) ? ['rings'] : []),
    ...(isUsual ? [] : [`fill: '${fill}'`]),
    ...(meshing.split ? [`crossings: 'split'`] : []),
    ...(backend === 'auto' ? [] : [`backend: '${backend}'`]),
  ];
  const asked = [
    `minAngle: ${meshing.minAngle}`,
    ...(meshing.maxArea > 0 ? [`maxArea: ${meshing.maxArea}`] : []),
    ...(refinement?.limited ? [`maxPoints: ${MOST_ADDED}`] : []),
  ];
  const isRefined = meshing.minAngle > 0 || meshing.maxArea > 0;
  return [
    `// npm install gdel-wasm`,
    `import { ${['delaunay2d', ...uses].join(', ')} }`,
    `  from 'gdel-wasm';`,
    ``,
    ...lines,
    `const ${isRefined ? 'coarse' : 'mesh'} = await delaunay2d(`,
    `  ${points}, { ${options.join(', ')} });`,
    ...(isRefined ? [`const mesh = await coarse.refine(`, `  { ${asked.join(', ')} });`] : []),
    ``,
    `mesh.coords;            // x, y, x, y, …`,
    `mesh.insideTriangles(); // 3 points each`,
    `mesh.constraints.edges; // 2 points each`,
    ``,
    `const vtu = await mesh.toVTU();`,
  ].join('\n');
}

/** The lines that declare points and `rings`, or read `shapes`. */
function pointsAndRings(
  source: Source,
  edits: readonly Edit[],
  { start, rings }: Polygons,
): Lines & { points: string; hasShapes: boolean } {
  const changed = edits.filter((edit) => !['join', 'close', 'mesh'].includes(edit.do));
  const hasShapes = namesOf(source).some(isShapes);
  if (source.kind === 'generator' && source.count === 0) {
    const drawn = [...applyEdits(new Float64Array(), edits)];
    const lines = [`const points = [`, ...inRows(drawn, 4), `];`, ...ringLines(rings)];
    return { uses: [], lines, points: 'points', hasShapes };
  }
  const { uses, lines } = hasShapes ? shapesOf(source) : pointsOf(source, false);
  if (changed.length === 0 && edits.every((edit) => edit.do !== 'join'))
    return { uses, lines, points: hasShapes ? 'shapes.points' : 'points', hasShapes };
  if (hasShapes) lines.push(`const { points } = shapes;`);
  lines.push(...changes(changed, source, false));
  const isLess = edits.some((edit) => removedBy(edit).length > 0 || edit.do === 'erase');
  const drawn = constraintsAfter(null, start, edits)?.rings ?? [];
  if (!hasShapes) lines.push(...ringLines(rings));
  else if (isLess) lines.push(`// The page removed polygons, too, or parts.`);
  else if (drawn.length > 0) lines.push(...ringLines(drawn, ['...shapes.rings']));
  return { uses, lines, points: changedPoints(changed), hasShapes };
}

const changedPoints = (edits: readonly Edit[]) =>
  edits.length > 0 ? 'Float64Array.from(changed)' : 'points';

const ringLines = (rings: readonly number[][], before: readonly string[] = []) => [
  `const rings = [`,
  ...before.map((line) => `  ${line},`),
  ...rings.map((ring) => `  [${ring.join(', ')}],`),
  `];`,
];

/** Numbers in lines of so many. */
const inRows = (numbers: readonly number[], each: number): string[] =>
  Array.from(
    { length: Math.ceil(numbers.length / each) },
    (_, i) => `  ${numbers.slice(each * i, each * (i + 1)).join(', ')},`,
  );

/** The names of the files of a source. */
const namesOf = (source: Source): string[] =>
  source.kind === 'file'
    ? source.files.map(({ name }) => name)
    : source.kind === 'url'
      ? [nameIn(source.url)]
      : [];

/** Reads a file of shapes. */
function shapesOf(source: Source): Lines {
  const [name, ...others] = namesOf(source);
  const [lines, from] = fetched(name, source.kind === 'url' ? source.url : addressOf(name));
  return {
    uses: ['readShapes'],
    lines: [
      ...(others.length > 0 ? [`// And so on: the page took all points together.`] : []),
      ...lines,
      `const shapes = await readShapes(`,
      `  await ${from}.blob(),`,
      `  { name: ${quoted(name.replace(/\.gz$/i, ''))} });`,
    ],
  };
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
  const [lines, from] = fetched(name, address);
  lines.push(
    `const { points${flat ? ': xyz' : ''} } = await readPoints(`,
    `  await ${from}.blob(),`,
    `  { name: ${quoted(name.replace(/\.gz$/i, ''))} });`,
  );
  if (flat) lines.push(FLAT);
  return { uses: ['readPoints'], lines };
}

/** The lines that fetch a file, and what they call it. */
function fetched(name: string, address: string): [lines: string[], from: string] {
  const lines = [`const file = await fetch(`, `  ${quoted(address)});`];
  if (!isGzipName(name)) return [lines, 'file'];
  lines.push(
    `const unzipped = new Response(file.body`,
    `  .pipeThrough(new DecompressionStream('gzip')));`,
  );
  return [lines, 'unzipped'];
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

/** The changes of points by hand, one a line; without those that name a point that is not there. */
function changes(edits: readonly Edit[], source: Source, isWeighed: boolean): string[] {
  let count = source.kind === 'generator' ? source.count : Infinity;
  const ifWeighed = (line: string) => (isWeighed ? [line] : []);
  return [
    `const changed = [...points];`,
    ...ifWeighed(`const radii = Array(points.length / 2).fill(0);`),
    ...edits.flatMap((edit) => {
      if (addsPoint(edit)) {
        count++;
        return [`changed.push(${edit.at.join(', ')});`, ...ifWeighed(`radii.push(0);`)];
      }
      if (edit.do === 'weigh' && edit.point < count)
        return ifWeighed(`radii[${edit.point}] = ${edit.radius};`);
      if (edit.do === 'move' && edit.point < count)
        return [`changed.splice(${2 * edit.point}, 2, ${edit.at.join(', ')});`];
      return removedBy(edit).flatMap((point) => {
        if (point >= count) return [];
        count--;
        return [`changed.splice(${2 * point}, 2);`, ...ifWeighed(`radii.splice(${point}, 1);`)];
      });
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
