// The score of a point in a tetrahedron.
//
// Expects: vertices: array<VertexWords>; control.
//!include d3/exact_{width}

fn from_to(v: u32, w: u32) -> vec3f {
    return vec3f(load_high(w) - load_high(v));
}

fn triple(a: vec3f, b: vec3f, c: vec3f) -> f32 {
    return dot(a, cross(b, c));
}

// Returns a power of two that brings the largest of these below 2.
fn scale_of(a: vec3f, b: vec3f, c: vec3f) -> f32 {
    let m = max(max(abs(a), abs(b)), abs(c));
    let largest = max(max(max(m.x, m.y), m.z), 1);
    return bitcast<f32>(0x7f000000 - (bitcast<u32>(largest) & 0x7f800000));
}

fn score_of(tet: vec4u, p: u32) -> u32 {
    let infinite = control.infinite;
    if any(tet == vec4u(infinite)) {
        // The hull grows most by the point that is farthest from the facet.
        let k = place_of(tet, infinite);
        let a = tet[(k + 1) % 4];
        let u = from_to(a, tet[(k + 2) % 4]);
        let v = from_to(a, tet[(k + 3) % 4]);
        let scale = scale_of(u, v, vec3f(0));
        return bitcast<u32>(abs(triple(u * scale, v * scale, from_to(a, p) * scale))) + 1;
    }
    let scale = scale_of(from_to(tet.x, tet.y), from_to(tet.x, tet.z), from_to(tet.x, tet.w));
    let a = from_to(p, tet.x) * scale;
    let b = from_to(p, tet.y) * scale;
    let c = from_to(p, tet.z) * scale;
    let d = from_to(p, tet.w) * scale;
    if control.pick == PICK_CENTROID {
        let off = a + b + c + d;
        return 0x7f800000 - bitcast<u32>(dot(off, off));
    }
    // The in-sphere determinant: for one tetrahedron it grows as the distance from the circumcentre
    // falls.
    let inside = dot(a, a) * triple(b, c, d) - dot(b, b) * triple(c, d, a) + dot(c, c) * triple(d, a, b)
        - dot(d, d) * triple(a, b, c);
    return bitcast<u32>(abs(inside)) + 1;
}
