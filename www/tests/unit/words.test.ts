// What the page says: numbers, times and errors.

import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { filesSource } from '../../src/model/source';
import { complaint, complaintAbout } from '../../src/ui/complaint';
import { count, duration, measured, simplices } from '../../src/ui/dom';
import { phasesOf } from '../../src/ui/phases';

test('one tetrahedron is not “1 tetrahedra”, and thousands are told apart', () => {
  assert.equal(simplices(1, 3), '1 tetrahedron');
  assert.equal(simplices(24_000, 3), '24,000 tetrahedra');
  assert.equal(simplices(1, 2), '1 triangle');
  assert.equal(count(1_234_567), '1,234,567');
  assert.deepEqual([0, 0.01239, 1.2e-9].map(measured), ['0', '0.0124', '1.20e-9']);
  assert.deepEqual([0.26, 83.6, 1240].map(duration), ['0.3 ms', '84 ms', '1.24 s']);
});

test('the phases add up to the time that is said, with the set-up', () => {
  const phases = [
    { name: 'sort', milliseconds: 3 },
    { name: 'insert', milliseconds: 40 },
  ];
  const sum = (milliseconds: number) =>
    phasesOf({ phases, milliseconds }).reduce((sum, phase) => sum + phase.milliseconds, 0);
  assert.equal(sum(50), 50);
  assert.equal(phasesOf({ phases, milliseconds: 50 }).at(-1)!.name, 'set-up');
  // Clocks are coarse.
  assert.equal(sum(42.9), 43);
});

describe('an error', () => {
  const of = (name: string, error: { name?: string; message: string }) =>
    complaint(filesSource([new File([], name)], 3), Object.assign(new Error(), error));

  test('in a file has its name, and starts like a sentence', () => {
    assert.equal(
      of('cat.ply', { message: 'byte 0: the file is empty' }),
      'cat.ply: The file is empty.',
    );
    assert.match(
      of('cat.xyz', { message: 'line 3: no number' }),
      /^cat\.xyz: Line 3: no number\.$/,
    );
  });

  test('of an unknown format says what can be read', () => {
    const error = { name: 'UNKNOWN_FORMAT', message: 'there is no format of that name' };
    assert.match(
      of('a.tar.gz', error),
      /^Can’t read \.tar\.gz\. Supported: PLY, .*, also as \.gz\.$/,
    );
    assert.match(of('README', error), /^Can’t read a file without an extension\. Supported: /);
  });

  test('says what to do', () => {
    const message = 'not enough memory';
    assert.match(of('a.las', { name: 'OUT_OF_DEVICE_MEMORY', message }), /Choose the CPU/);
    assert.match(of('a.las', { name: 'NO_ADAPTER', message }), /Choose the CPU/);
    assert.equal(
      of('a.las', { name: 'ABORTED', message }),
      'Cancelled. Still showing the previous result.',
    );
    const offline = new TypeError('Failed to fetch dynamically imported module: http://a/b.js');
    assert.equal(
      complaintAbout('GLB', offline),
      'GLB could not be loaded. Check your connection and try again.',
    );
  });
});
