// Puts the sample scans where the page finds them, www/samples: only their points, as 32-bit
// floats, x y z x y z …, compressed. The page needs no reader for them.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';

const root = new URL('../../', import.meta.url);
const samples = new URL('../samples/', import.meta.url);
mkdirSync(samples, { recursive: true });

/** The vertices of a PLY file whose first element they are, with nothing but three floats each. */
function verticesOf(ply) {
  const header = ply
    .subarray(0, ply.indexOf('end_header\n') + 'end_header\n'.length)
    .toString('latin1');
  const count = Number(/element vertex (\d+)/.exec(header)[1]);
  const body = ply.subarray(header.length);
  if (/format binary_little_endian/.test(header))
    return new Float32Array(new Uint8Array(body.subarray(0, 12 * count)).buffer);
  const lines = body.toString('latin1').split('\n', count);
  return Float32Array.from(lines.flatMap((line) => line.trim().split(' ').map(Number)));
}

function write(name, ply) {
  const vertices = verticesOf(ply);
  writeFileSync(
    new URL(`${name}.f32.gz`, samples),
    gzipSync(new Uint8Array(vertices.buffer), { level: 9 }),
  );
  console.log(`www/samples/${name}.f32.gz: ${vertices.length / 3} points`);
}

write('bunny', readFileSync(new URL('tests/data/bunny.ply', root)));
if (!existsSync(new URL('dragon.f32.gz', samples))) {
  execFileSync('bash', [fileURLToPath(new URL('scripts/fetch-dragon.sh', root))], {
    stdio: 'inherit',
  });
  write('dragon', readFileSync(new URL('.cache/dragon.ply', root)));
}
