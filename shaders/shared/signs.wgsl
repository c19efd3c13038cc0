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

fn insphere_finite(tet: vec4u, e: u32) -> i32 {
    var sign = insphere_filter(load_high(tet.x), load_high(tet.y), load_high(tet.z), load_high(tet.w), load_high(e));
    if sign == 0 {
        exact_signs += 1;
        sign = insphere(load_vertex(tet.x), load_vertex(tet.y), load_vertex(tet.z), load_vertex(tet.w), load_vertex(e));
    }
    return sign;
}
//!include shared/signs_at_infinity
