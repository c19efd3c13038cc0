// The points whose stars are wanted, a bit per point.
//
// Expects: control, wanted.

fn is_wanted(v: u32) -> bool {
    return v != control.infinite && ((wanted[v >> 5] >> (v & 31)) & 1) != 0;
}

fn has_wanted(tet: vec4u) -> bool {
    return is_wanted(tet.x) || is_wanted(tet.y) || is_wanted(tet.z) || is_wanted(tet.w);
}
