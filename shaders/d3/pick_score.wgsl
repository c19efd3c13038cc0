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

fn square(a: vec3f) -> f32 {
    return dot(a, a);
}

// Returns a power of two that brings the largest of these below 2.
fn scale_of(a: vec3f, b: vec3f, c: vec3f) -> f32 {
    let m = max(max(abs(a), abs(b)), abs(c));
    let largest = max(max(max(m.x, m.y), m.z), 1);
    return bitcast<f32>(0x7f000000 - (bitcast<u32>(largest) & 0x7f800000));
}

//!include common/scores

// Returns the sum of the terms of triple(a, b, c), all taken as positive.
fn permanent(a: vec3f, b: vec3f, c: vec3f) -> f32 {
    let p = abs(b);
    let q = abs(c);
    return dot(abs(a), p.yzx * q.zxy + p.zxy * q.yzx);
}

// Returns the score of point w in the plane of a facet with the corners 0, u and v, by the
// in-circle determinant, by which ties at infinity are broken: the ghost's sphere meets the plane in
// the facet's circle.
fn score_in_plane(u: vec3f, v: vec3f, w: vec3f) -> u32 {
    let x = w - u;
    let y = w - v;
    let normal = cross(u, v);
    let inside = square(w) * dot(normal, cross(x, y)) + square(x) * dot(normal, cross(y, w))
        + square(y) * dot(normal, cross(w, x));
    if inside != 0 {
        return (bitcast<u32>(abs(inside)) >> 1) | 0x40000000;
    }
    return score_by_distance(min(min(square(w), square(x)), square(y)));
}

fn score_of(tet: vec4u, p: u32) -> u32 {
    let infinite = control.infinite;
    if any(tet == vec4u(infinite)) {
        // The hull grows most with the point farthest from the facet.
        let k = place_of(tet, infinite);
        let a = tet[(k + 1) % 4];
        var u = from_to(a, tet[(k + 2) % 4]);
        var v = from_to(a, tet[(k + 3) % 4]);
        let scale = scale_of(u, v, vec3f(0));
        u *= scale;
        v *= scale;
        let w = from_to(a, p) * scale;
        let volume = triple(u, v, w);
        if is_distinct(volume, permanent(u, v, w)) {
            return score_by_volume(volume);
        }
        return score_in_plane(u, v, w);
    }
    let scale = scale_of(from_to(tet.x, tet.y), from_to(tet.x, tet.z), from_to(tet.x, tet.w));
    let a = from_to(p, tet.x) * scale;
    let b = from_to(p, tet.y) * scale;
    let c = from_to(p, tet.z) * scale;
    let d = from_to(p, tet.w) * scale;
    if control.criterion == PICK_CENTROID {
        let off = a + b + c + d;
        return 0x7f800000 - bitcast<u32>(dot(off, off));
    }
    // The in-sphere determinant: for one tetrahedron it grows as the distance from the circumcentre
    // falls. In a flat one it is 0.
    let inside = square(a) * triple(b, c, d) - square(b) * triple(c, d, a) + square(c) * triple(d, a, b)
        - square(d) * triple(a, b, c);
    if inside != 0 {
        return score_by_volume(inside);
    }
    return score_by_distance(min(min(square(a), square(b)), min(square(c), square(d))));
}
