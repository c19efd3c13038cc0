// Signs on vertices that may be at infinity, as far as the filter decides them; otherwise 0.
//
// Expects: vertices: array<VertexWords>; control.
//!include d3/exact_{width}
//!include d3/filter

fn orient_finite(v: vec4u) -> i32 {
    return orient3d_filter(load_high(v.x), load_high(v.y), load_high(v.z), load_high(v.w));
}

fn insphere_finite(tet: vec4u, e: u32) -> i32 {
    return insphere_filter(load_high(tet.x), load_high(tet.y), load_high(tet.z), load_high(tet.w), load_high(e));
}
//!include d3/signs_at_infinity
