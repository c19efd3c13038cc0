import assert from 'node:assert/strict';
import { test } from 'node:test';
import { TableError } from '../../src/model/rows';
import { oklch, palette } from '../../src/treemap/colors';
import { EXAMPLES } from '../../src/treemap/examples';
import { boxIn, labelFor } from '../../src/treemap/label';
import { outlineOf, SHAPES } from '../../src/treemap/shapes';
import { hashOf, stateFrom } from '../../src/treemap/state';
import { nested, numberIn, readTable, rolesOf, rowsOf } from '../../src/treemap/table';

/** The rows of a table with the columns that suit. */
const read = (text: string) => {
  const table = readTable(text);
  return rowsOf(table, rolesOf(table));
};
const plain = (text: string) => read(text).map(({ name, value }) => [name, value]);
const fails = (text: string, message: RegExp) =>
  assert.throws(
    () => read(text),
    (error) => {
      assert.ok(error instanceof TableError, String(error));
      assert.match(error.message, message);
      return true;
    },
  );

test('names and numbers, with a header and without, in either order, with any mark between', () => {
  const expected = [
    ['a', 1],
    ['b', 2.5],
  ];
  assert.deepEqual(plain('a,1\nb,2.5'), expected);
  assert.deepEqual(plain('name,value\na,1\nb,2.5\n'), expected);
  assert.deepEqual(plain('\uFEFFvalue;name\r\n1;a\r\n2,5;b\r\n'), expected);
  assert.deepEqual(plain('a\t1\n\n\nb\t2.5'), expected);
  assert.deepEqual(plain('1\n2'), [
    ['Row 1', 1],
    ['Row 2', 2],
  ]);
  assert.deepEqual(plain('2000,7\n2001,8'), [
    ['2000', 7],
    ['2001', 8],
  ]);
  assert.deepEqual(plain('"a, or ""A""",1\n"two\nlines",2'), [
    ['a, or "A"', 1],
    ['two\nlines', 2],
  ]);
});

test('numbers as people write them', () => {
  for (const [text, number] of Object.entries({
    '1234.5': 1234.5,
    '1,234,567': 1234567,
    '1.234,5': 1234.5,
    '1 234,5': 1234.5,
    '−3': -3,
    '12 %': 12,
    '1e3': 1000,
    "1'000": 1000,
  }))
    assert.equal(numberIn(text), number, text);
  for (const text of ['', 'n/a', '12 kg', '1.2.3', '--1'])
    assert.ok(Number.isNaN(numberIn(text)), text);
});

test('what is wrong is said with its line', () => {
  fails('', /no rows/);
  fails('a,b\nc,d', /No column has numbers/);
  fails('name,value\na,1\nb,-2\nc,3', /Line 3 \(b\): -2 is negative/);
  fails('name,value\na,1\nb,n/a\nc,3', /Line 3 \(b\): “n\/a” under “value” is not a number/);
  fails('name,value\na,1\n\nb,\nc,3', /Line 4 \(b\): there is nothing under “value”/);
  fails('name,value\na,0\nb,0', /All numbers under “value” are 0/);
  fails('name,value\na,Infinity\nb,2', /not a number/);
  fails('name,value\n"a,1', /Line 2: a quotation mark/);
  fails(Array.from({ length: 20_002 }, (_, i) => `${i},1`).join('\n'), /would take too long/);
});

test('the columns that suit are found, and others can be chosen', () => {
  const table = readTable('id,country,continent,area,population\n1,a,x,5,7\n2,b,y,6,8');
  assert.deepEqual(rolesOf(table), { name: 1, value: 3, group: 2 });
  assert.deepEqual(
    rowsOf(table, { name: 0, value: 4, group: -1 }).map(({ name, value, path }) => [
      name,
      value,
      path,
    ]),
    [
      ['1', 7, []],
      ['2', 8, []],
    ],
  );
});

test('groups by a column, by paths, and by parents', () => {
  const names = (text: string) => {
    const of = (items: ReturnType<typeof nested>): unknown[] =>
      items.map(({ name, children }) => (children ? { [name]: of(children) } : name));
    return of(nested(read(text)));
  };
  assert.deepEqual(names('name,group,value\na,x,1\nb,y,1\nc,x,1\nd,,1'), [
    { x: ['a', 'c'] },
    { y: ['b'] },
    'd',
  ]);
  assert.deepEqual(names('name,path,value\na,x/y,1\nb,x,1\nc,x/y,1'), [
    { x: [{ y: ['a', 'c'] }, 'b'] },
  ]);
  assert.deepEqual(names('name,parent,value\nroot,,0\nx,root,0\na,x,1\nb,root,2'), [
    { root: [{ x: ['a'] }, 'b'] },
  ]);
  fails('name,parent,value\nx,y,1\ny,x,1\na,x,1', /within itself/);
});

test('the examples are tables', () => {
  for (const { csv } of Object.values(EXAMPLES)) assert.ok(read(csv).length > 10);
  assert.equal(read(EXAMPLES.many.csv).length, 3000);
  assert.equal(nested(read(EXAMPLES.people.csv)).length, 6);
});

test('shapes have the area that pictures are in, and the orientation of a screen', () => {
  for (const shape of SHAPES)
    for (const isTall of [false, true]) {
      const { corners, width, height } = outlineOf(shape, isTall);
      const area = corners.reduce((sum, [x, y], i) => {
        const [x1, y1] = corners[(i + 1) % corners.length];
        return sum + (y * x1 - x * y1) / 2;
      }, 0);
      assert.ok(Math.abs(area - 1e6) < 1e-3, `${shape} ${area}`);
      assert.ok(
        corners.every(([x, y]) => x > -1e-9 && y > -1e-9 && x < width + 1e-9 && y < height + 1e-9),
      );
    }
});

test('text is within its cell, and as large as it may be', () => {
  const square: [number, number][] = [
    [0, 0],
    [0, 100],
    [100, 100],
    [100, 0],
  ];
  const { at, size } = boxIn(square, [2, 1]);
  assert.ok(Math.abs(size - 25) < 0.5 && Math.abs(at[0] - 50) < 1, `${size} ${at}`);
  const triangle: [number, number][] = [
    [0, 0],
    [0, 90],
    [90, 0],
  ];
  const box = boxIn(triangle, [1, 1]);
  // Its corner is on the long side.
  assert.ok(
    Math.abs(box.size - 22.5) < 0.5 && Math.abs(box.at[0] + box.at[1] - 45) < 2,
    `${box.size}`,
  );
  const options = { smallest: 5, area: 1e6 };
  const widthOf = (text: string) => 0.5 * text.length;
  assert.deepEqual(labelFor(square, 'ab', widthOf, options)?.lines, ['ab']);
  assert.deepEqual(labelFor(square, 'several long words', widthOf, options)?.lines, [
    'several',
    'long words',
  ]);
  assert.equal(labelFor(square, 'x'.repeat(90), widthOf, options), null);
});

test('text on every colour has a contrast of at least 7 to 1', () => {
  const luminance = (hex: string) => {
    const [r, g, b] = [1, 3, 5].map((at) => {
      const x = parseInt(hex.slice(at, at + 2), 16) / 255;
      return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  for (const theme of ['light', 'dark'] as const) {
    const { text, cell } = palette(theme);
    for (let hue = 0; hue < 60; hue++)
      for (const shade of [-1, 0, 1]) {
        const [low, high] = [text, cell(hue, shade)].map(luminance).sort((a, b) => a - b);
        const contrast = (high + 0.05) / (low + 0.05);
        assert.ok(contrast >= 7, `${theme} ${hue} ${shade}: ${contrast}`);
      }
  }
  assert.equal(oklch(1, 0, 0), '#ffffff');
  assert.equal(oklch(0, 0, 0), '#000000');
});

test('a link holds what is shown, and one that makes no sense shows an example', () => {
  const state = {
    example: null,
    shape: 'circle',
    roles: { value: 2, group: -1 },
    file: 'a b.csv',
    data: 'abc',
  } as const;
  assert.deepEqual(stateFrom(`#${hashOf(state)}`), state);
  const start = stateFrom('');
  assert.equal(start.example, 'people');
  assert.equal(hashOf({ ...start, example: 'people' }), 'example=people');
  assert.deepEqual(stateFrom('#example=toString&shape=cube&value=x&name=1e9'), start);
});
