// Signs on vertices that may be at infinity, as far as the filter decides them; otherwise 0.
//
// Expects: vertices: array<VertexWords>; control.
//!include d3/exact_{width}
//!include d3/filter

fn finite_sign(v: vec4u, e: u32, of_four: bool) -> i32 {
    return filtered_sign(v, e, of_four);
}
//!include d3/signs_at_infinity
