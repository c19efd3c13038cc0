// Puts the sample scans where the page finds them: www/public/samples. Only points: what the page triangulates.
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { gzipSync } from 'node:zlib';

const root = new URL('../../', import.meta.url);
const samples = new URL('../public/samples/', import.meta.url);
mkdirSync(samples, { recursive: true });

copyFileSync(new URL('tests/data/bunny.ply', root), new URL('bunny.ply', samples));

const dragon = new URL('dragon.ply.gz', samples);
if (!existsSync(dragon)) {
  execFileSync('bash', [new URL('scripts/fetch-dragon.sh', root).pathname], { stdio: 'inherit' });
  const ply = readFileSync(new URL('.cache/dragon.ply', root), 'latin1');
  const body = ply.indexOf('end_header\n') + 'end_header\n'.length;
  const count = Number(/element vertex (\d+)/.exec(ply)[1]);
  const coordinates = new Float32Array(3 * count);
  ply.slice(body).split('\n', count).forEach((line, i) => coordinates.set(line.trim().split(' ').map(Number), 3 * i));
  const header = [
    'ply', 'format binary_little_endian 1.0',
    'comment Stanford 3D Scanning Repository, Stanford University Computer Graphics Laboratory',
    `element vertex ${count}`, 'property float x', 'property float y', 'property float z', 'end_header', '',
  ].join('\n');
  writeFileSync(dragon, gzipSync(Buffer.concat([Buffer.from(header), Buffer.from(coordinates.buffer)]), { level: 9 }));
  console.log(`www/public/samples/dragon.ply.gz: ${count} points`);
}
