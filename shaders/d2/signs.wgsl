// Signs on vertices that may be at infinity: the filter first, then the exact arithmetic. Never 0.
//
// Expects: vertices: array<VertexWords>; control.
//!include common/pairs
//!include d2/predicates
//!include d2/filter

// The number of predicate evaluations of this invocation that the filter did not decide.
var<private> exact_signs: u32 = 0;

// Loads a vertex with its input index. The interior point, which has infinity's number, counts as
// the last point of the input.
fn vertex(v: u32) -> Vertex {
    var index = v;
    if v != control.infinite {
        index = pairs[v].y;
    }
    return Vertex(load_position(v), index);
}

// Returns the orientation of three finite vertices. The number of infinity stands for the interior
// point.
fn orient_finite(v: vec3u) -> i32 {
    var sign = orient2d_filter(load_high(v.x), load_high(v.y), load_high(v.z));
    if sign == 0 {
        exact_signs += 1;
        sign = orient2d_exact(load_position(v.x), load_position(v.y), load_position(v.z));
        if sign == 0 {
            let infinite = control.infinite;
            sign = perturbed_sign(vertex(v.x), vertex(v.y), vertex(v.z), vertex(infinite), true);
        }
    }
    return sign;
}

// Returns the orientation of three vertices. Infinity lies opposite to the interior point.
fn orient(v: vec3u) -> i32 {
    let sign = orient_finite(v);
    return select(sign, -sign, any(v == vec3u(control.infinite)));
}

// Returns whether e is inside the circumcircle of a positively oriented triangle. For an infinite
// one that is the half-plane beyond its hull edge; infinity is inside none.
fn inside(tri: vec3u, e: u32) -> bool {
    let at_infinity = tri == vec3u(control.infinite);
    var sign = -1;
    if any(at_infinity) {
        sign = orient_finite(select(tri, vec3u(e), at_infinity));
    } else if e != control.infinite {
        sign = incircle_filter(load_high(tri.x), load_high(tri.y), load_high(tri.z), load_high(e));
        if sign == 0 {
            exact_signs += 1;
            sign = perturbed_sign(vertex(tri.x), vertex(tri.y), vertex(tri.z), vertex(e), false);
        }
    }
    return sign > 0;
}
