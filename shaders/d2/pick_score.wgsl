// The score of a point in a triangle.
//
// Expects: vertices: array<VertexWords>; control.
//!include d2/exact_{width}

fn from_to(v: u32, w: u32) -> vec2f {
    return vec2f(load_high(w) - load_high(v));
}

fn cross_of(a: vec2f, b: vec2f) -> f32 {
    return a.x * b.y - a.y * b.x;
}

// Returns a power of two that brings the largest of these below 2.
fn scale_of(a: vec2f, b: vec2f) -> f32 {
    let m = max(abs(a), abs(b));
    let largest = max(max(m.x, m.y), 1);
    return bitcast<f32>(0x7f000000 - (bitcast<u32>(largest) & 0x7f800000));
}

//!include common/scores

fn score_of(tri: vec3u, p: u32) -> u32 {
    let infinite = control.infinite;
    if any(tri == vec3u(infinite)) {
        // The hull grows most by the point that is farthest from the edge.
        let k = place_of(tri, infinite);
        let a = tri[(k + 1) % 3];
        let b = tri[(k + 2) % 3];
        let scale = scale_of(from_to(a, b), vec2f(0));
        let u = from_to(a, b) * scale;
        let v = from_to(a, p) * scale;
        let area = cross_of(u, v);
        if is_distinct(area, abs(u.x * v.y) + abs(u.y * v.x)) {
            return score_by_volume(area);
        }
        return score_by_distance(min(dot(v, v), dot(v - u, v - u)));
    }
    let scale = scale_of(from_to(tri.x, tri.y), from_to(tri.x, tri.z));
    let a = from_to(p, tri.x) * scale;
    let b = from_to(p, tri.y) * scale;
    let c = from_to(p, tri.z) * scale;
    if control.criterion == PICK_CENTROID {
        let off = a + b + c;
        return 0x7f800000 - bitcast<u32>(dot(off, off));
    }
    // The in-circle determinant: for one triangle it grows as the distance from the circumcentre
    // falls. In a flat one it is 0.
    let inside = dot(a, a) * cross_of(b, c) + dot(b, b) * cross_of(c, a) + dot(c, c) * cross_of(a, b);
    if inside != 0 {
        return score_by_volume(inside);
    }
    return score_by_distance(min(min(dot(a, a), dot(b, b)), dot(c, c)));
}
