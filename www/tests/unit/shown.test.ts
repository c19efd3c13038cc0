import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { LiveFrame } from '../../src/model/live';
import type { Model } from '../../src/model/model';
import { Shown } from '../../src/model/shown';

// They are only told apart.
const mesh = {} as Model;
const moving = {} as Model;
const frame = {} as LiveFrame;

test('a frame of the live mode is shown as soon as it is made', async () => {
  const shown = new Shown();
  assert.equal(shown.model, null);
  shown.mesh(mesh);
  assert.equal(await shown.frame(Promise.resolve({ model: moving, frame })), frame);
  assert.equal(shown.model, moving);
});

test('a frame that comes after the live mode has stopped does not replace the mesh', async () => {
  const shown = new Shown();
  let made = (_: { model: Model; frame: LiveFrame }) => {};
  const late = shown.frame(
    new Promise((resolve) => {
      made = resolve;
    }),
  );
  shown.mesh(mesh);
  made({ model: moving, frame });
  assert.equal(await late, frame);
  assert.equal(shown.model, mesh);
});
