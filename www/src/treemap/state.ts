import { EXAMPLES } from './examples';
import { SHAPES, type ShapeName } from './shapes';
import type { Roles } from './table';

/** All that a link holds. */
export interface State {
  /** An example, or null for a table of the visitor's. */
  example: string | null;
  shape: ShapeName;
  /** The columns, as far as others were chosen than those that suit. */
  roles: Partial<Roles>;
  /** The name of the visitor's table, and it itself, compressed, if it is short enough. */
  file: string | null;
  data: string | null;
}

const ROLES = ['name', 'value', 'group'] as const;

export function stateFrom(hash: string): State {
  const given = new URLSearchParams(hash.replace(/^#/, ''));
  const file = given.get('file');
  const data = given.get('data');
  const example = given.get('example') ?? '';
  const roles: Partial<Roles> = {};
  for (const role of ROLES) {
    const text = given.get(role);
    if (text !== null && /^-?\d{1,6}$/.test(text)) roles[role] = Number(text);
  }
  return {
    example: data ? null : Object.hasOwn(EXAMPLES, example) ? example : Object.keys(EXAMPLES)[0],
    shape: SHAPES.find((shape) => shape === given.get('shape')) ?? SHAPES[0],
    roles,
    file: data ? (file ?? 'table.csv') : null,
    data,
  };
}

export function hashOf({ example, shape, roles, file, data }: State): string {
  const hash = new URLSearchParams();
  if (example) hash.set('example', example);
  else if (data) {
    hash.set('file', file ?? 'table.csv');
    hash.set('data', data);
  }
  if (shape !== SHAPES[0]) hash.set('shape', shape);
  for (const role of ROLES) if (roles[role] !== undefined) hash.set(role, String(roles[role]));
  return hash.toString();
}
