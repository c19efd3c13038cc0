// Signs on vertices that may be at infinity: the filter first, then the exact arithmetic. Never 0.
//
// Expects: vertices, control.
//!include shared/predicates
//!include shared/filter

// How many signs of this invocation the filter left open.
var<private> exact_signs: u32 = 0;

// The orientation of four finite vertices. The number of infinity stands for the kernel point.
fn orient_finite(v: vec4u) -> i32 {
    var sign = orient3d_filter(load_high(v.x), load_high(v.y), load_high(v.z), load_high(v.w));
    if sign == 0 {
        exact_signs += 1;
        sign = orient3d(load_vertex(v.x), load_vertex(v.y), load_vertex(v.z), load_vertex(v.w));
    }
    return sign;
}

// The orientation of four vertices. Infinity lies opposite to the kernel point.
fn orient(v: vec4u) -> i32 {
    let sign = orient_finite(v);
    return select(sign, -sign, any(v == vec4u(control.infinite)));
}

// Whether e is inside the circumsphere of a positively oriented tetrahedron. For an infinite one that is the half-space
// beyond its hull facet; infinity is inside none.
fn inside(tet: vec4u, e: u32) -> bool {
    let at_infinity = tet == vec4u(control.infinite);
    var sign = -1;
    if any(at_infinity) {
        sign = orient_finite(select(tet, vec4u(e), at_infinity));
    } else if e != control.infinite {
        sign = insphere_filter(load_high(tet.x), load_high(tet.y), load_high(tet.z), load_high(tet.w), load_high(e));
        if sign == 0 {
            exact_signs += 1;
            sign = insphere(load_vertex(tet.x), load_vertex(tet.y), load_vertex(tet.z), load_vertex(tet.w), load_vertex(e));
        }
    }
    return sign > 0;
}
