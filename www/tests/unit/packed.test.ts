import assert from 'node:assert/strict';
import { test } from 'node:test';
import { pack, unpack } from '../../src/model/packed';

test('a small file goes into a link and comes back', async () => {
  const content = Array.from({ length: 500 }, (_, i) => `${i} ${i % 7} ${i % 3}\n`).join('');
  const packed = await pack(new Blob([content]));
  assert.match(packed!, /^[\w-]+$/);
  assert.ok(packed!.length < content.length / 2);
  const file = await unpack(packed!, 'a.xyz');
  assert.equal(file!.name, 'a.xyz');
  assert.equal(await file!.text(), content);
});

test('a large file does not', async () => {
  let state = 1;
  const noise = Uint8Array.from({ length: 30_000 }, () => {
    state = (state * 48271) % 2147483647;
    return state & 255;
  });
  assert.equal(await pack(new Blob([noise])), null);
  assert.equal(await pack(new Blob([new Uint8Array(2_000_000)])), null);
});

test('what makes no sense, or too much, is no file', async () => {
  assert.equal(await unpack('!', 'a.xyz'), null);
  assert.equal(await unpack('AAAA', 'a.xyz'), null);
  const bomb = new Blob([new Uint8Array(1_000_000)]);
  const packed = await pack(bomb);
  assert.ok(packed);
  assert.equal((await unpack(packed, 'a.xyz'))?.size, 1_000_000);
});
