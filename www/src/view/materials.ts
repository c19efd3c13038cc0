import {
  attribute,
  cameraProjectionMatrix,
  Fn,
  float,
  mix,
  modelViewMatrix,
  normalFlat,
  positionGeometry,
  select,
  smoothstep,
  sRGBTransferEOTF,
  storage,
  texture,
  uint,
  uniform,
  varying,
  vec2,
  vec3,
  vec4,
  vertexIndex,
} from 'three/tsl';
import {
  Color,
  DataTexture,
  DoubleSide,
  LinearFilter,
  MeshBasicNodeMaterial,
  type Node,
  RGBAFormat,
  SRGBColorSpace,
  type StorageBufferAttribute,
  UnsignedByteType,
  Vector2,
  Vector3,
} from 'three/webgpu';
import { OUTSIDE } from '../geometry/cut';
import { FACETS } from '../geometry/mesh';
import { type ColorMapName, texels } from './colormap';

/**
 * What all materials share, and the page changes: colours of the theme, the cutting plane, how far
 * the pieces are apart.
 */
export class Look {
  readonly ink = uniform(new Color());
  readonly accent = uniform(new Color());
  readonly edges = uniform(1);
  readonly pointOpacity = uniform(0.35);
  readonly apart = uniform(0);
  readonly pointSize = uniform(1.5);
  readonly planeNormal = uniform(new Vector3(1, 0, 0));
  /** Points below this height along the plane's normal are not drawn: the tetrahedra are there. */
  readonly pointsAbove = uniform(-1e9);
  /** 1 to draw them all the same. */
  readonly pointsEverywhere = uniform(0);
  /** 1 for points in colours of their own, where they have some. */
  readonly ownColors = uniform(1);
  /** 1 to fill the 2D triangles, 0 for only their edges. */
  readonly fill = uniform(1);
  /** Of the Voronoi diagram, which fades where it would cover everything. */
  readonly voronoiOpacity = uniform(1);
  /** Its box: towards the sides it fades as well. */
  readonly voronoiMiddle = uniform(new Vector2());
  readonly voronoiReach = uniform(new Vector2(1, 1));
  /** The canvas in pixels as CSS has them. */
  readonly size = uniform(new Vector2(1, 1));
  readonly map = new DataTexture(texels('viridis'), 256, 1, RGBAFormat, UnsignedByteType);

  constructor() {
    this.map.colorSpace = SRGBColorSpace;
    this.map.minFilter = this.map.magFilter = LinearFilter;
    this.map.needsUpdate = true;
  }

  setMap(map: ColorMapName | 'phases'): void {
    (this.map.image.data as Uint8Array).set(texels(map));
    this.map.needsUpdate = true;
  }
}

/**
 * 1 on the edges of unindexed triangles, one pixel wide; fades out where triangles are too small to
 * have any.
 */
const edgeness = Fn(() => {
  const corner = vertexIndex.mod(3);
  const weights = varying(
    vec3(
      select(corner.equal(0), 1, 0),
      select(corner.equal(1), 1, 0),
      select(corner.equal(2), 1, 0),
    ),
  );
  const width = weights.fwidth();
  const inside = smoothstep(vec3(0), width.mul(1.1), weights);
  const crowded = width.x.max(width.y).max(width.z);
  return float(1)
    .sub(inside.x.min(inside.y).min(inside.z))
    .mul(float(1).sub(smoothstep(0.25, 0.7, crowded)));
});

/** The opacity of the 2D triangles. */
const PALE = 0.55;

// Dark in both themes: light edges would drown the colours.
const EDGE = vec3(0.004, 0.005, 0.008);

const colorOf = (look: Look, value: Node<'float'>) =>
  texture(look.map, vec2(value.mul(255 / 256).add(0.5 / 256), 0.5)).rgb;

/** A colour of the web as the lamp needs it. */
const toLinear = (color: Node<'vec3'>) => sRGBTransferEOTF(color) as Node<'vec3'>;

/** The colour of a value, or where its fourth part says so, that of the skin. */
const painted = (look: Look, value: Node<'float'>, skin: Node<'vec4'>) =>
  mix(colorOf(look, value), toLinear(skin.rgb), skin.a);

/** A colour under a lamp beside the camera, with the edges of the triangles. */
function shaded(look: Look, base: Node<'vec3'>): Node<'vec3'> {
  const lit = normalFlat
    .dot(vec3(0.28, 0.48, 0.83))
    .mul(0.5)
    .add(0.5);
  const color = base.mul(lit.mul(lit).mul(0.9).add(0.2));
  return mix(color, EDGE, edgeness().mul(look.edges).mul(0.5));
}

/** For the boundary of the shown tetrahedra; reads the attributes `value` and `skin`. */
export function surfaceMaterial(look: Look): MeshBasicNodeMaterial {
  const material = new MeshBasicNodeMaterial();
  material.colorNode = shaded(look, corner(look));
  return material;
}

/** Which of its tetrahedron's corners a facet's are: two bits each, in the order of {@link FACETS}. */
const CORNERS = FACETS.reduce((bits, corner, i) => bits | (corner << (2 * i)), 0);

/** The buffers of a `Cut`, as three.js holds them. */
export type CutAttributes = Record<
  'facets' | 'tetrahedra' | 'positions' | 'values' | 'colors',
  StorageBufferAttribute
>;

/** For the facets that a `Cut` lists: each vertex finds its data by its number. */
export function cutMaterial(look: Look, attributes: CutAttributes): MeshBasicNodeMaterial {
  const numbers = (name: keyof CutAttributes) =>
    storage(attributes[name], 'uint', 0).toReadOnly() as ArrayNode<'uint'>;
  const floats = (name: keyof CutAttributes) =>
    storage(attributes[name], 'float', 0).toReadOnly() as ArrayNode<'float'>;
  const listed = numbers('facets').element(vertexIndex.div(3));
  const facet = listed.bitAnd(uint(~OUTSIDE >>> 0));
  const corner = uint(CORNERS)
    .shiftRight(facet.bitAnd(uint(3)).mul(3).add(vertexIndex.mod(3)).mul(2))
    .bitAnd(uint(3));
  const tetrahedron = facet.shiftRight(uint(2));
  const vertex = numbers('tetrahedra').element(tetrahedron.mul(4).add(corner)).toVar();
  const coordinates = floats('positions');
  const x = vertex.mul(3);
  const material = new MeshBasicNodeMaterial();
  material.positionNode = vec3(
    coordinates.element(x),
    coordinates.element(x.add(1)),
    coordinates.element(x.add(2)),
  );
  const color = numbers('colors').element(vertex);
  const counts = select(listed.equal(facet), float(0), float(1));
  const skin = varying(vec4(bytesOf(color), counts));
  const value = varying(floats('values').element(tetrahedron));
  material.colorNode = shaded(look, painted(look, value, skin));
  return material;
}

/** A colour whose red, green and blue are the lower bytes of a number. */
function bytesOf(color: Node<'uint'>): Node<'vec3'> {
  const byte = (k: number) => float(color.shiftRight(uint(8 * k)).bitAnd(uint(255))).div(255);
  return vec3(byte(0), byte(1), byte(2));
}

/** What is in a storage buffer, by number. */
interface ArrayNode<T extends 'uint' | 'float'> {
  element(index: Node<'uint'>): Node<T>;
}

/** The colour of a corner, from its attributes `value` and `skin`. */
const corner = (look: Look) =>
  painted(
    look,
    varying(attribute<'float'>('value', 'float')),
    varying(attribute<'vec4'>('skin', 'vec4')),
  );

/** For the 2D triangles; reads the attributes `value` and `skin`. */
export function flatMaterial(look: Look): MeshBasicNodeMaterial {
  const material = new MeshBasicNodeMaterial({ transparent: true, depthWrite: false });
  const edge = edgeness().mul(look.edges);
  const skin = varying(attribute<'vec4'>('skin', 'vec4'));
  const base = painted(look, varying(attribute<'float'>('value', 'float')), skin);
  material.colorNode = mix(mix(look.ink, base, look.fill), look.ink, edge.mul(0.75));
  // Pale, so that what lies above can be seen: the legend is as pale. Own colours are not.
  material.opacityNode = edge.mul(0.65).max(look.fill.mul(mix(float(PALE), float(1), skin.a)));
  return material;
}

/**
 * For lines so many pixels wide; reads the instances' ends `a` and `b`, and in x and y which end
 * and which side.
 */
export function linesMaterial(
  look: Look,
  color: Node<'color'>,
  width: number,
  opacity: Node<'float'>,
): MeshBasicNodeMaterial {
  const material = new MeshBasicNodeMaterial({
    transparent: true,
    depthTest: false,
    depthWrite: false,
    side: DoubleSide,
  });
  const toClip = (end: string) =>
    cameraProjectionMatrix.mul(modelViewMatrix.mul(vec4(attribute<'vec3'>(end, 'vec3'), 1)));
  const [a, b] = [toClip('a'), toClip('b')];
  const along = b.xy.div(b.w).sub(a.xy.div(a.w)).mul(look.size).normalize();
  const across = vec2(along.y.negate(), along.x).mul(positionGeometry.y.mul(width)).div(look.size);
  const end = mix(a, b, positionGeometry.x);
  material.vertexNode = vec4(end.xy.add(across.mul(end.w)), end.z, end.w);
  material.colorNode = color;
  material.opacityNode = opacity;
  return material;
}

/** For the Voronoi diagram, whose edges go on where nothing is any more. */
export function voronoiMaterial(look: Look): MeshBasicNodeMaterial {
  const place = varying(
    mix(attribute<'vec3'>('a', 'vec3'), attribute<'vec3'>('b', 'vec3'), positionGeometry.x).xy,
  );
  const outwards = place.sub(look.voronoiMiddle).abs().div(look.voronoiReach);
  const fade = float(1).sub(smoothstep(0.7, 1, outwards.x.max(outwards.y)));
  return linesMaterial(look, look.accent, 1.5, look.voronoiOpacity.mul(fade));
}

/**
 * For whole tetrahedra, one an instance; reads the instances' `a`, `b`, `c`, `d`, `value`, `skinA`
 * to `skinD`, and the corner number in x.
 */
export function piecesMaterial(look: Look): MeshBasicNodeMaterial {
  const material = new MeshBasicNodeMaterial();
  const [a, b, c, d] = ['a', 'b', 'c', 'd'].map((name) => attribute<'vec3'>(name, 'vec3'));
  const own = oneOf(positionGeometry.x, [a, b, c, d]);
  const centroid = a.add(b).add(c).add(d).mul(0.25);
  material.positionNode = own.add(centroid.mul(look.apart)).div(look.apart.add(1));
  const skins = ['A', 'B', 'C', 'D'].map((end) => attribute<'vec4'>(`skin${end}`, 'vec4'));
  // A facet's number is that of the vertex opposite, which says whether the colours count.
  const counts = oneOf(
    float(vertexIndex.div(3)),
    skins.map((skin) => skin.a),
  );
  const skin = varying(vec4(oneOf(positionGeometry.x, skins).rgb, counts));
  const value = varying(attribute<'float'>('value', 'float'));
  material.colorNode = shaded(look, painted(look, value, skin));
  return material;
}

/** The one of four that a number from 0 to 3 names. */
function oneOf<T extends 'float' | 'vec3' | 'vec4'>(
  number: Node<'float'>,
  [a, b, c, d]: Node<T>[],
): Node<T> {
  return select(
    number.lessThan(0.5),
    a,
    select(number.lessThan(1.5), b, select(number.lessThan(2.5), c, d)),
  ) as Node<T>;
}

/** Where a point is, and its colour if it has one of its own: see {@link pointsMaterial}. */
export interface PointNodes {
  place: Node<'vec3'>;
  color: Node<'vec3'> | null;
}

/** Points in two buffers, of which six vertices in a row read the same one. */
export function storedPoints(
  places: StorageBufferAttribute,
  colors: StorageBufferAttribute | null,
): PointNodes {
  const point = vertexIndex.div(6);
  const coordinates = storage(places, 'float', 0).toReadOnly() as ArrayNode<'float'>;
  const at = (k: number) => coordinates.element(point.mul(3).add(k));
  const bytes = colors && (storage(colors, 'uint', 0).toReadOnly() as ArrayNode<'uint'>);
  return { place: vec3(at(0), at(1), at(2)), color: bytes && bytesOf(bytes.element(point)) };
}

/** Points that are instances of six vertices, with the attributes `place` and `color`. */
export function instancedPoints(hasColors: boolean): PointNodes {
  return {
    place: attribute<'vec3'>('place', 'vec3'),
    color: hasColors ? attribute<'vec4'>('color', 'vec4').rgb : null,
  };
}

/** At which corner of a square each vertex of its two triangles is: 1 for the far side. */
const SQUARE = { x: 0b010110, y: 0b110100 };

/** For points, as squares of a size in pixels. */
export function pointsMaterial(look: Look, { place, color }: PointNodes): MeshBasicNodeMaterial {
  const material = new MeshBasicNodeMaterial({ transparent: true, depthWrite: false });
  const side = (bits: number) =>
    float(uint(bits).shiftRight(vertexIndex.mod(6)).bitAnd(uint(1)))
      .mul(2)
      .sub(1);
  const corner = vec2(side(SQUARE.x), side(SQUARE.y));
  const size = select(
    place
      .dot(look.planeNormal)
      .greaterThan(look.pointsAbove)
      .or(look.pointsEverywhere.greaterThan(0)),
    look.pointSize,
    float(0),
  );
  const middle = cameraProjectionMatrix.mul(modelViewMatrix.mul(vec4(place, 1)));
  const offset = corner.mul(size).div(look.size).mul(middle.w);
  material.vertexNode = vec4(middle.xy.add(offset), middle.z, middle.w);
  material.colorNode = color ? mix(look.ink, toLinear(varying(color)), look.ownColors) : look.ink;
  // Round, where there is room for it.
  const round = float(1).sub(smoothstep(0.76, 1, varying(corner).length()));
  material.opacityNode = look.pointOpacity.mul(
    select(look.pointSize.greaterThan(3), round, float(1)),
  );
  return material;
}

/** For the hull: edges only, seen through. */
export function hullMaterial(look: Look): MeshBasicNodeMaterial {
  const material = new MeshBasicNodeMaterial({
    transparent: true,
    depthWrite: false,
    side: DoubleSide,
  });
  material.colorNode = look.ink;
  material.opacityNode = edgeness().mul(0.22);
  return material;
}

/** For facets to point out: filled with the accent colour, visible through everything. */
export function accentMaterial(look: Look): MeshBasicNodeMaterial {
  const material = new MeshBasicNodeMaterial({
    transparent: true,
    depthTest: false,
    depthWrite: false,
    side: DoubleSide,
  });
  material.colorNode = look.accent;
  material.opacityNode = edgeness().mul(0.3).add(0.6);
  return material;
}
