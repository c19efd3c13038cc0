import {
  attribute, float, Fn, instancedBufferAttribute, mix, normalFlat, positionGeometry, select, smoothstep, texture, uniform, varying,
  vec2, vec3, vertexIndex,
} from 'three/tsl';
import {
  Color, DataTexture, DoubleSide, type InstancedBufferAttribute, LinearFilter, LineBasicNodeMaterial, MeshBasicNodeMaterial,
  type Node, PointsNodeMaterial, RGBAFormat, SRGBColorSpace, UnsignedByteType, Vector3,
} from 'three/webgpu';
import { texels, type ColorMapName } from './colormap';

/** What all materials share, and the page changes: colours of the theme, the plane, how far the pieces are apart. */
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

/** 1 on the edges of unindexed triangles, one pixel wide; fades out where triangles are too small to have any. */
const edgeness = Fn(() => {
  const corner = vertexIndex.mod(3);
  const weights = varying(
    vec3(select(corner.equal(0), 1, 0), select(corner.equal(1), 1, 0), select(corner.equal(2), 1, 0)),
  );
  const width = weights.fwidth();
  const inside = smoothstep(vec3(0), width.mul(1.1), weights);
  const crowded = width.x.max(width.y).max(width.z);
  return float(1).sub(inside.x.min(inside.y).min(inside.z)).mul(float(1).sub(smoothstep(0.25, 0.7, crowded)));
});

// Dark in both themes: light edges would drown the colours.
const EDGE = vec3(0.004, 0.005, 0.008);

/** The colour of a value under a lamp beside the camera. */
function shaded(look: Look, value: Node<'float'>): Node<'vec3'> {
  const lit = normalFlat.dot(vec3(0.28, 0.48, 0.83)).mul(0.5).add(0.5);
  const base = texture(look.map, vec2(value.mul(255 / 256).add(0.5 / 256), 0.5)).rgb;
  const color = base.mul(lit.mul(lit).mul(0.9).add(0.2));
  return mix(color, EDGE, edgeness().mul(look.edges).mul(0.5));
}

/** For the boundary of the shown tetrahedra; reads the attribute `value`. */
export function surfaceMaterial(look: Look): MeshBasicNodeMaterial {
  const material = new MeshBasicNodeMaterial();
  material.colorNode = shaded(look, varying(attribute<'float'>('value', 'float')));
  return material;
}

/** For whole tetrahedra, one an instance; reads the instances' `a`, `b`, `c`, `d`, `value` and the corner number in x. */
export function piecesMaterial(look: Look): MeshBasicNodeMaterial {
  const material = new MeshBasicNodeMaterial();
  const [a, b, c, d] = ['a', 'b', 'c', 'd'].map((name) => attribute<'vec3'>(name, 'vec3'));
  const corner = positionGeometry.x;
  const own = select(corner.lessThan(0.5), a, select(corner.lessThan(1.5), b, select(corner.lessThan(2.5), c, d)));
  const centroid = a.add(b).add(c).add(d).mul(0.25);
  material.positionNode = own.add(centroid.mul(look.apart)).div(look.apart.add(1));
  material.colorNode = shaded(look, varying(attribute<'float'>('value', 'float')));
  return material;
}

/** For points, as instanced sprites of a size in pixels. */
export function pointsMaterial(look: Look, positions: InstancedBufferAttribute): PointsNodeMaterial {
  const position = instancedBufferAttribute<'vec3'>(positions, 'vec3');
  const material = new PointsNodeMaterial({ sizeAttenuation: false, transparent: true, depthWrite: false });
  material.positionNode = position;
  material.sizeNode = select(
    position.dot(look.planeNormal).greaterThan(look.pointsAbove).or(look.pointsEverywhere.greaterThan(0)),
    look.pointSize,
    float(0),
  );
  material.colorNode = look.ink;
  material.opacityNode = look.pointOpacity;
  return material;
}

/** For the hull: edges only, seen through. */
export function hullMaterial(look: Look): MeshBasicNodeMaterial {
  const material = new MeshBasicNodeMaterial({ transparent: true, depthWrite: false, side: DoubleSide });
  material.colorNode = look.ink;
  material.opacityNode = edgeness().mul(0.22);
  return material;
}

/** For facets to point out: filled with the accent colour, visible through everything. */
export function accentMaterial(look: Look): MeshBasicNodeMaterial {
  const material = new MeshBasicNodeMaterial({ transparent: true, depthTest: false, depthWrite: false, side: DoubleSide });
  material.colorNode = look.accent;
  material.opacityNode = edgeness().mul(0.3).add(0.6);
  return material;
}

/** For the outline of the tetrahedron under the pointer. */
export function outlineMaterial(look: Look): LineBasicNodeMaterial {
  const material = new LineBasicNodeMaterial({ depthTest: false });
  material.colorNode = look.accent;
  return material;
}
