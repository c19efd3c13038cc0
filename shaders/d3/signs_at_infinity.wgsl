// Signs on vertices that may be at infinity.
//
// Expects: orient_finite, insphere_finite, control.

// Returns the orientation of four vertices. Infinity lies opposite to the interior point.
fn orient(v: vec4u) -> i32 {
    let sign = orient_finite(v);
    return select(sign, -sign, any(v == vec4u(control.infinite)));
}

// Returns a positive sign if e is inside the circumsphere of a positively oriented tetrahedron. For
// an infinite one that is the half-space beyond its hull facet; infinity is inside none.
fn conflict(tet: vec4u, e: u32) -> i32 {
    let at_infinity = tet == vec4u(control.infinite);
    var sign = -1;
    if any(at_infinity) {
        sign = orient_finite(select(tet, vec4u(e), at_infinity));
    } else if e != control.infinite {
        sign = insphere_finite(tet, e);
    }
    return sign;
}
